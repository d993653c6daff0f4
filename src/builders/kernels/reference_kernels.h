// The loops over references and bins that builds spend most of their time in, for the instruction set at hand.
// What they give does not depend on it, to the bit.
#pragma once

#include <vector>

#include "builders/parts/bins.h"
#include "builders/parts/reference_ranges.h"
#include "math/morton.h"
#include "parallel/radix_sort.h"

namespace boxwood::builders {

struct ReferenceKernels {
  const char* name;  ///< Highway's, of the instruction set

  /// Drops references into the bins of their centroids.
  void (*bin)(const BinGrid& grid, const refs::Reference* references, std::size_t count, BinTable& table);

  /// See Bins::best_split.
  BinSplit (*best_split)(const BinGrid& grid, const BinTable& table, float area_scale);

  /// Copies references to the place of their side of a plane, in their order. `left` and `right` are in one buffer.
  /// With `split.has_boxes` the bounds of the sides are left empty.
  ReferenceSides (*part)(const RangeSplit& split, const refs::Reference* source, std::size_t count,
                         refs::Reference* left, refs::Reference* right);

  /// codes[i] become the Morton code of reference `begin` + i's doubled centroid, that number, and 0.
  void (*morton_codes)(const MortonGrid& grid, const refs::Reference* references, std::size_t begin, std::size_t end,
                       KeyedIndex* codes);
};

/// Those for the best instruction set.
const ReferenceKernels& reference_kernels();
/// All that this processor runs, best first.
std::vector<ReferenceKernels> all_reference_kernels();

}  // namespace boxwood::builders
