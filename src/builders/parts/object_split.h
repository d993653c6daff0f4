// Splits of whole references for builders that otherwise cut them: binned by centroid, for ranges of any size.
#pragma once

#include <memory>

#include "builders/parts/bins.h"
#include "builders/parts/build_range.h"
#include "builders/parts/sift.h"

namespace boxwood::builders {

/// A split between two bins of centroids.
struct ObjectSplit {
  BinSplit bins;  ///< with the boxes of both sides
  float origin = 0, scale = 0;

  bool exists() const { return bins.axis >= 0; }
  bool is_left(const refs::Reference& reference) const {
    return (reference.centroid2(bins.axis) - origin) * scale < static_cast<float>(bins.bin);
  }
  Sides sides(const refs::Reference& reference) const {
    return is_left(reference) ? Sides::only_left(reference) : Sides::only_right(reference);
  }
};

/// The cheapest split between `bins` bins per axis, fewer when there are few references. None where centroids coincide.
ObjectSplit best_object_split(std::span<const refs::Reference> references, int bins, float area_scale,
                              Executor& executor);

/// Fills in references, bounds and spare of both sides and frees those of the range.
inline void sift_objects(SplittingRange& range, const ObjectSplit& split, Executor& executor, SplittingRange& left,
                         SplittingRange& right) {
  const std::size_t left_count = split.bins.left_count, right_count = range.size() - left_count;
  const auto sides = [&](const refs::Reference& reference) { return split.sides(reference); };
  sift(range, left_count, right_count, executor, sides, left, right);
}

}  // namespace boxwood::builders
