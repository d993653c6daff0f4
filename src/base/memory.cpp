// Memory of AlignedBuffer. Blocks of half a megabyte and more ask the system for huge pages: a build touches hundreds
// of megabytes once, and one page fault for 2 MiB costs little more than one for 4 KiB (on virtual machines less than a
// hundredth of the 512 that it replaces). Some blocks are kept when they are given back, smaller ones too: unmapping a
// block interrupts the other threads, and mapping it again clears its pages (docs/where-time-goes.md).
#include <algorithm>
#include <bit>
#include <iterator>
#include <mutex>
#include <new>
#include <vector>

#include "boxwood/base.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace boxwood::memory {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr std::size_t kWorthAPage = kHugePage / 4;
/// Smaller blocks come from what the process has anyway.
constexpr std::size_t kWorthKeeping = std::size_t{1} << 13;
constexpr std::size_t kPage = std::size_t{1} << 12;

/// How many bytes of a block are to be huge pages: all but a rest that isn't worth one.
std::size_t huge_part(std::size_t bytes) {
#if defined(__linux__)
  return (bytes + kHugePage - kWorthAPage) / kHugePage * kHugePage;
#else
  return bytes - bytes;
#endif
}

/// What is asked of the system for an array that is worth keeping.
struct Block {
  std::size_t size, alignment, huge;

  /// In coarse steps, so that blocks serve again for arrays of about their size.
  static Block of(std::size_t bytes, std::size_t alignment) {
    const std::size_t huge = huge_part(bytes);
    const std::size_t step = std::max(huge ? kWorthAPage : kPage, std::bit_floor(bytes) / 16);
    return {std::max(huge, (bytes + step - 1) / step * step), huge ? std::max(alignment, kHugePage) : alignment, huge};
  }
  void* from_system() const {
    void* const block = ::operator new(size, std::align_val_t(alignment));
#if defined(__linux__)
    if (huge) madvise(block, huge, MADV_HUGEPAGE);  // advice: where it isn't taken the pages are small
#endif
    return block;
  }
};

bool is_worth_keeping(std::size_t bytes) {
  return bytes >= kWorthKeeping && bytes <= SIZE_MAX / 2;
}

/// Blocks that were given back, the oldest first.
class KeptBlocks {
 public:
  /// A block of just this size and alignment, or null.
  void* take(std::size_t size, std::size_t alignment) {
    const std::lock_guard lock(mutex_);
    for (auto kept = blocks_.rbegin(); kept != blocks_.rend(); ++kept) {
      if (kept->size != size || kept->alignment != alignment) continue;
      void* const block = kept->block;
      bytes_ -= size;
      blocks_.erase(std::next(kept).base());
      return block;
    }
    return nullptr;
  }

  /// Keeps a block if there is room in `most` bytes, which blocks that nobody has wanted for long make. Where there is
  /// none it goes to the system: builds release their arrays in the same order each time, so if new blocks drove out
  /// old ones, a build that takes more than is kept would drive out each block just before it is wanted.
  void keep(void* block, std::size_t size, std::size_t alignment, std::size_t most) noexcept {
    if (size > most) return Kept{block, size, alignment}.give_back();
    std::uint64_t released = 0;
    for (bool displaces = true; displaces;) {
      Kept displaced;
      {
        const std::lock_guard lock(mutex_);
        if (released == 0) released = released_ += size;
        if (blocks_.size() < kMostBlocks && bytes_ + size <= most) {
          blocks_.push_back({block, size, alignment, released});
          bytes_ += size;
          return;
        }
        displaces = released > blocks_.front().released + kStale * most;  // a list without room is not empty
        displaced = displaces ? take_oldest() : Kept{block, size, alignment};
      }
      displaced.give_back();  // without the lock: it can take long
    }
  }

  void give_back_all() noexcept {
    for (;;) {
      Kept oldest;
      {
        const std::lock_guard lock(mutex_);
        if (blocks_.empty()) return;
        oldest = take_oldest();
      }
      oldest.give_back();
    }
  }

 private:
  static constexpr std::size_t kMostBlocks = 1024;
  /// A block that was not taken again while so many times as much as is kept was released need not be kept: a few
  /// builds, or many small ones.
  static constexpr std::uint64_t kStale = 4;
  struct Kept {
    void* block = nullptr;
    std::size_t size = 0, alignment = 1;
    std::uint64_t released = 0;  ///< bytes released up to its own release

    void give_back() const noexcept {
      if (block) ::operator delete(block, std::align_val_t(alignment));
    }
  };
  Kept take_oldest() {
    const Kept oldest = blocks_.front();
    blocks_.erase(blocks_.begin());
    bytes_ -= oldest.size;
    return oldest;
  }

  std::mutex mutex_;
  std::vector<Kept> blocks_ = [] {
    std::vector<Kept> blocks;
    blocks.reserve(kMostBlocks);  // keep() must not throw
    return blocks;
  }();
  std::size_t bytes_ = 0;
  std::uint64_t released_ = 0;  ///< bytes, by all releases
};

/// Lives as long as the process, for buffers that static objects own.
KeptBlocks& kept_blocks() {
  static auto& blocks = *new KeptBlocks;
  return blocks;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BOXWOOD_KEEPS_NO_BLOCKS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BOXWOOD_KEEPS_NO_BLOCKS
#endif
#endif
#ifdef BOXWOOD_KEEPS_NO_BLOCKS
constexpr std::size_t kMostKept = 0;  // a block in use after it was given back must be seen
#else
constexpr std::size_t kMostKept = std::size_t{128} << 20;
#endif

}  // namespace

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (!is_worth_keeping(bytes)) return ::operator new(bytes, std::align_val_t(alignment));
  const Block block = Block::of(bytes, alignment);
  if (void* const kept = kept_blocks().take(block.size, block.alignment)) return kept;
  try {
    return block.from_system();
  } catch (const std::bad_alloc&) {
    give_back_unused();
    return block.from_system();
  }
}

void release(void* block, std::size_t bytes, std::size_t alignment) noexcept {
  if (!is_worth_keeping(bytes)) return ::operator delete(block, std::align_val_t(alignment));
  const Block kept = Block::of(bytes, alignment);
  if (block) kept_blocks().keep(block, kept.size, kept.alignment, kMostKept);
}

void give_back_unused() noexcept {
  kept_blocks().give_back_all();
}

}  // namespace boxwood::memory
