// Parallel radix sort from the lowest digit up (Knuth 1998, section 5.2.5; in parallel: Zagha and Blelloch 1991, bib
// key zagha1991). Items are cut into chunks of a fixed size. A pass counts the digits of each chunk, gives each chunk a
// place for each digit (all chunks' zeros first, in chunk order, then the ones, ...) and moves every item to its
// place: no two threads share a counter and the order is the stable one. Passes over a digit that all items share are
// skipped.
//
// Of long keys the highest kLeadingBits are sorted that way. Hardly any items have these in common, as a rule, so few
// have to be put in order by the rest, and they stand side by side. Where more do, all digits are gone through.
// O(n * bits / kDigitBits), deterministic.
#include "parallel/radix_sort.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

constexpr int kDigitBits = 12;
constexpr int kLeadingBits = 3 * kDigitBits;
/// Up to so many items an insertion sort is quickest.
constexpr std::size_t kFewItems = 32;
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
  Counts first{};  // of each digit: its items in the chunks so far, in the end the place of its first one
  for (Counts& counts : chunks)
    for (std::size_t d = 0; d < kDigits; ++d) {
      const std::uint32_t before = first[d];
      first[d] = before + counts[d];
      counts[d] = before;
    }
  std::uint32_t next = 0;
  for (std::uint32_t& of_digit : first) {
    if (of_digit == items) return false;
    next += std::exchange(of_digit, next);
  }
  for (Counts& counts : chunks)
    for (std::size_t d = 0; d < kDigits; ++d) counts[d] += first[d];
  return true;
}

/// Sorts by the bits of the keys from `shift` up to `bits`, by way of `other`.
void sort_digits(AlignedBuffer<KeyedIndex>& items, AlignedBuffer<KeyedIndex>& other, int shift, int bits,
                 LargeVector<Counts>& chunks, std::size_t chunk_size, Executor& executor) {
  const std::size_t size = items.size();
  for (; shift < bits; shift += kDigitBits) {
    executor.for_chunks(size, chunk_size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Counts& counts = chunks[chunk];
      counts.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++counts[digit(items[i].key, shift)];
    });
    if (!place(chunks, size)) continue;
    executor.for_chunks(size, chunk_size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      Counts& next = chunks[chunk];
      for (std::size_t i = begin; i < end; ++i) other[next[digit(items[i].key, shift)]++] = items[i];
    });
    std::swap(items, other);
  }
}

/// Insertion sort, so stable.
void sort_few(std::span<KeyedIndex> items) {
  for (std::size_t i = 1; i < items.size(); ++i) {
    const KeyedIndex item = items[i];
    std::size_t place = i;
    for (; place > 0 && items[place - 1].key > item.key; --place) items[place] = items[place - 1];
    items[place] = item;
  }
}

/// Puts items that have all bits from `shift` on in common, and so stand side by side, in order by the others. False,
/// with such items in any order, where too many have.
bool sort_alike(std::span<KeyedIndex> items, int shift, std::size_t chunk_size, Executor& executor) {
  const auto alike = [&](std::size_t i, std::size_t j) { return items[i].key >> shift == items[j].key >> shift; };
  // Chunks end between unlike items.
  std::vector<std::size_t> ends((items.size() + chunk_size - 1) / chunk_size, items.size());
  for (std::size_t chunk = 0; chunk + 1 < ends.size(); ++chunk) {
    std::size_t end = (chunk + 1) * chunk_size;
    while (end < items.size() && alike(end - 1, end)) ++end;
    if (end - (chunk + 1) * chunk_size > chunk_size) return false;
    ends[chunk] = end;
  }
  std::atomic<std::size_t> in_crowds{0};
  executor.for_chunks(ends.size(), 1, [&](std::size_t chunk, std::size_t, std::size_t) {
    const std::size_t end = ends[chunk];
    for (std::size_t first = chunk == 0 ? 0 : ends[chunk - 1], last; first < end; first = last) {
      // Most are like no other.
      std::uint64_t key = items[first].key >> shift;
      for (last = first + 1; last < end; ++last) {
        const std::uint64_t next = items[last].key >> shift;
        if (next == key) break;
        key = next;
      }
      first = last - 1;
      while (last < end && items[last].key >> shift == key) ++last;
      if (last - first <= kFewItems) {
        sort_few(items.subspan(first, last - first));
      } else {
        if ((in_crowds += last - first) > items.size() / 8) return;
        std::stable_sort(items.begin() + std::ptrdiff_t(first), items.begin() + std::ptrdiff_t(last),
                         [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; });
      }
    }
  });
  return in_crowds <= items.size() / 8;
}

}  // namespace

void radix_sort(AlignedBuffer<KeyedIndex>& items, int bits, Executor& executor) {
  const std::size_t size = items.size();
  if (size < 2) return;
  AlignedBuffer<KeyedIndex> other(size);
  const std::size_t chunk_size = std::clamp(size / (executor.threads() == 1 ? 1 : 4), kSmallestChunk, kLargestChunk);
  LargeVector<Counts> chunks((size + chunk_size - 1) / chunk_size);
  const int rest = std::max(0, bits - kLeadingBits);
  sort_digits(items, other, rest, bits, chunks, chunk_size, executor);
  if (rest == 0 || sort_alike(items.span(), rest, chunk_size, executor)) return;
  sort_digits(items, other, 0, bits, chunks, chunk_size, executor);
}

}  // namespace boxwood
