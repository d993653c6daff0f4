// For each item the first item equal to it: a lock-free open-addressing hash table with linear probing.
// An item claims an empty slot by compare-and-swap; equal items share one slot and lower its occupant to the least
// index. A slot only ever changes between equal items, so probe chains stay intact and the final occupants, hence the
// answer, do not depend on the order in which threads arrive. Expected O(n); 12 to 24 bytes of table per item.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>

#include "boxwood/base.h"
#include "boxwood/parallel.h"
#include "mesh/chunks.h"

namespace boxwood::mesh {

/// Mixes 64 bits so that each output bit depends on each input bit.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

/// `first[i]` becomes the lowest j with equal(j, i), among items for which takes_part is true; others stay alone
/// (first[i] = i). `first` has room for `count` < 2^31 entries. The callables must be safe to call in parallel.
template <class TakesPart, class HashOf, class Equal>
void find_first_equal(std::size_t count, std::uint32_t* first, Executor& executor, TakesPart takes_part, HashOf hash_of,
                      Equal equal) {
  // An entry is 32 bits of the hash above the item's index: items of different hash are told apart without a look at
  // their data, which would be a cache miss each.
  constexpr std::uint64_t kEmpty = ~std::uint64_t(0);
  constexpr std::size_t kBatch = 16;  // table lines fetched ahead of their use
  const std::size_t capacity = std::bit_ceil(count + count / 2 + 1);
  const std::size_t mask = capacity - 1;
  AlignedBuffer<std::uint64_t> table(capacity);
  executor.for_chunks(capacity, 8 * kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::memset(table.data() + begin, 0xff, (end - begin) * sizeof(std::uint64_t));
  });

  const auto insert = [&](std::uint64_t item, std::uint64_t hash) {
    const std::uint64_t candidate = hash >> 32 << 32 | item;
    for (std::size_t slot = hash & mask;; slot = (slot + 1) & mask) {
      std::atomic_ref<std::uint64_t> entry(table[slot]);
      std::uint64_t occupant = entry.load(std::memory_order_relaxed);
      if (occupant == kEmpty && entry.compare_exchange_strong(occupant, candidate, std::memory_order_relaxed))
        return slot;
      if ((occupant ^ candidate) >> 32 != 0 || !equal(occupant & 0xffffffffu, item)) continue;
      while (candidate < occupant && !entry.compare_exchange_weak(occupant, candidate, std::memory_order_relaxed)) {
      }
      return slot;
    }
  };
  // The slot is kept in `first` until all items are in, then replaced by the slot's final occupant. Slots need more
  // bits than items only beyond 2^32 of them, which `count` < 2^31 rules out.
  executor.for_chunks(count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::uint64_t hashes[kBatch];
    for (std::size_t batch = begin; batch < end; batch += kBatch) {
      const std::size_t batch_end = end - batch < kBatch ? end : batch + kBatch;
      for (std::size_t i = batch; i < batch_end; ++i) {
        if (!takes_part(i)) continue;
        hashes[i - batch] = hash_of(i);
        __builtin_prefetch(&table[hashes[i - batch] & mask], 1);
      }
      for (std::size_t i = batch; i < batch_end; ++i)
        if (takes_part(i)) first[i] = static_cast<std::uint32_t>(insert(i, hashes[i - batch]));
    }
  });
  executor.for_chunks(count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      first[i] = static_cast<std::uint32_t>(takes_part(i) ? table[first[i]] & 0xffffffffu : i);
  });
}

}  // namespace boxwood::mesh
