// Memory of AlignedBuffer. Blocks of half a megabyte and more ask the system for huge pages: a build touches hundreds
// of megabytes once, and one page fault for 2 MiB costs little more than one for 4 KiB (on virtual machines less than a
// hundredth of the 512 that it replaces). Some of them are kept when they are given back: unmapping a block interrupts
// the other threads, and mapping it again clears its pages (docs/performance.md, "What builds spend").
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

/// How many bytes of a block are to be huge pages: all but a rest that isn't worth one.
std::size_t huge_part(std::size_t bytes) {
#if defined(__linux__)
  return bytes > SIZE_MAX / 2 ? 0 : (bytes + kHugePage - kWorthAPage) / kHugePage * kHugePage;
#else
  return bytes - bytes;
#endif
}

/// The size of the block for so many bytes: coarse steps, so that blocks serve again for arrays of about their size.
std::size_t block_size(std::size_t bytes, std::size_t huge) {
  const std::size_t step = std::max(kWorthAPage, std::bit_floor(bytes) / 16);
  return std::max(huge, (bytes + step - 1) / step * step);
}

/// A large block from the system.
void* new_block(std::size_t size, std::size_t huge, std::size_t alignment) {
  void* const block = ::operator new(size, std::align_val_t(alignment));
#if defined(__linux__)
  madvise(block, huge, MADV_HUGEPAGE);  // advice: where it isn't taken the pages are small
#else
  static_cast<void>(huge);
#endif
  return block;
}

/// Large blocks that were given back, the oldest first.
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

  /// Keeps a block, or gives it to the system, so that `most` bytes at most are kept, those of the oldest blocks last.
  void keep(void* block, std::size_t size, std::size_t alignment, std::size_t most) noexcept {
    {
      const std::lock_guard lock(mutex_);
      if (size <= most && blocks_.size() < kMostBlocks) {
        blocks_.push_back({block, size, alignment});
        bytes_ += size;
        block = nullptr;
      }
    }
    if (block) ::operator delete(block, std::align_val_t(alignment));
    shrink_to(most);
  }

  void shrink_to(std::size_t most) noexcept {
    for (;;) {
      Kept oldest;
      {
        const std::lock_guard lock(mutex_);
        if (bytes_ <= most || blocks_.empty()) return;
        oldest = blocks_.front();
        blocks_.erase(blocks_.begin());
        bytes_ -= oldest.size;
      }
      ::operator delete(oldest.block, std::align_val_t(oldest.alignment));  // without the lock: it can take long
    }
  }

 private:
  static constexpr std::size_t kMostBlocks = 128;
  struct Kept {
    void* block;
    std::size_t size, alignment;
  };
  std::mutex mutex_;
  std::vector<Kept> blocks_ = [] {
    std::vector<Kept> blocks;
    blocks.reserve(kMostBlocks);  // keep() must not throw
    return blocks;
  }();
  std::size_t bytes_ = 0;
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
constexpr std::size_t kMostKept = std::size_t{64} << 20;
#endif

}  // namespace

void* allocate(std::size_t bytes, std::size_t alignment) {
  const std::size_t huge = huge_part(bytes);
  if (huge == 0) return ::operator new(bytes, std::align_val_t(alignment));
  const std::size_t size = block_size(bytes, huge), aligned = std::max(alignment, kHugePage);
  if (void* const block = kept_blocks().take(size, aligned)) return block;
  try {
    return new_block(size, huge, aligned);
  } catch (const std::bad_alloc&) {
    give_back_unused();
    return new_block(size, huge, aligned);
  }
}

void release(void* block, std::size_t bytes, std::size_t alignment) noexcept {
  const std::size_t huge = huge_part(bytes);
  if (huge == 0) return ::operator delete(block, std::align_val_t(alignment));
  if (block) kept_blocks().keep(block, block_size(bytes, huge), std::max(alignment, kHugePage), kMostKept);
}

void give_back_unused() noexcept {
  kept_blocks().shrink_to(0);
}

}  // namespace boxwood::memory
