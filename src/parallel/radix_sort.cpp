// Parallel radix sort from the lowest digit up (Knuth 1998, section 5.2.5; in parallel: Zagha and Blelloch 1991, bib
// key zagha1991). Items are cut into chunks of a fixed size. A pass counts the digits of each chunk, gives each chunk a
// place for each digit (all chunks' zeros first, in chunk order, then the ones, ...) and moves every item to its
// place: no two threads share a counter and the order is the stable one. Passes over a digit that all items share are
// skipped. O(n * bits / kDigitBits), deterministic.
#include "parallel/radix_sort.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
/// A chunk is large against the counters that it takes, yet there are some for every thread of a small machine.
constexpr std::size_t kSmallestChunk = std::size_t{1} << 12, kLargestChunk = std::size_t{1} << 16;

using Counts = std::array<std::uint32_t, kDigits>;

std::size_t digit(std::uint64_t key, int shift) {
  return key >> shift & (kDigits - 1);
}

/// Turns the counts of all chunks into the places of each chunk's first item of each digit. False: all items have the
/// same digit, so that nothing would move.
bool place(LargeVector<Counts>& chunks, std::size_t items) {
  std::uint32_t next = 0;
  for (std::size_t d = 0; d < kDigits; ++d) {
    const std::uint32_t first = next;
    for (Counts& counts : chunks) next += std::exchange(counts[d], next);
    if (next - first == items) return false;
  }
  return true;
}

}  // namespace

void radix_sort(AlignedBuffer<KeyedIndex>& items, int bits, Executor& executor) {
  const std::size_t size = items.size();
  if (size < 2) return;
  AlignedBuffer<KeyedIndex> other(size);
  const std::size_t chunk_size = std::clamp(size / 8, kSmallestChunk, kLargestChunk);
  LargeVector<Counts> chunks((size + chunk_size - 1) / chunk_size);
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    executor.for_chunks(size, chunk_size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Counts counts{};
      for (std::size_t i = begin; i < end; ++i) ++counts[digit(items[i].key, shift)];
      chunks[chunk] = counts;
    });
    if (!place(chunks, size)) continue;
    executor.for_chunks(size, chunk_size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Counts next = chunks[chunk];
      for (std::size_t i = begin; i < end; ++i) other[next[digit(items[i].key, shift)]++] = items[i];
    });
    std::swap(items, other);
  }
}

}  // namespace boxwood
