// Memory of AlignedBuffer. Blocks of half a megabyte and more ask the system for huge pages: a build touches hundreds
// of megabytes once, and one page fault for 2 MiB costs little more than one for 4 KiB (on virtual machines less than a
// hundredth of the 512 that it replaces).
#include <new>

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
  return bytes > SIZE_MAX - kHugePage ? 0 : (bytes + kHugePage - kWorthAPage) / kHugePage * kHugePage;
#else
  return bytes - bytes;
#endif
}

std::align_val_t alignment_of(std::size_t bytes, std::size_t alignment) {
  return std::align_val_t(huge_part(bytes) != 0 && alignment < kHugePage ? kHugePage : alignment);
}

}  // namespace

void* allocate(std::size_t bytes, std::size_t alignment) {
  const std::size_t huge = huge_part(bytes);
  void* const block = ::operator new(bytes < huge ? huge : bytes, alignment_of(bytes, alignment));
#if defined(__linux__)
  if (huge != 0) madvise(block, huge, MADV_HUGEPAGE);  // advice: where it isn't taken the pages are small
#endif
  return block;
}

void release(void* block, std::size_t bytes, std::size_t alignment) noexcept {
  ::operator delete(block, alignment_of(bytes, alignment));
}

}  // namespace boxwood::memory
