// Sorting by integer keys, the first step of all builders that follow a space-filling curve.
#pragma once

#include <cstdint>

#include "boxwood/base.h"
#include "boxwood/parallel.h"

namespace boxwood {

/// What is sorted: a key and the index it stands for.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
  std::uint32_t other;  ///< carried along: a second index, or nothing
};
static_assert(sizeof(KeyedIndex) == 16);

/// Sorts by the lowest `bits` bits of the keys (1 to 64; all higher ones must be zero). Stable: equal keys keep their
/// order, so the result does not depend on the number of threads. Takes a second array of the same size for the time.
void radix_sort(AlignedBuffer<KeyedIndex>& items, int bits, Executor& executor);

}  // namespace boxwood
