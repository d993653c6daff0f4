// Bins of space on three axes: references are chopped at the borders of bins, and the best plane between two bins is
// found by the surface area heuristic.
#pragma once

#include <array>
#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/plane_split.h"

namespace boxwood::builders {

inline constexpr int kMostSpatialBins = 256;

/// A plane between two bins, with tight boxes around what lies on its sides.
struct SpatialBinSplit {
  PlaneSplit plane;
  Box left, right;
};

class SpatialBins {
 public:
  /// `count` bins of equal width on each axis of `region`; 2 to kMostSpatialBins.
  SpatialBins(const Box& region, int count);

  void add(const refs::Reference& reference, const refs::Primitives& primitives);
  void add(const SpatialBins& other);
  /// The cheapest plane that adds no more than `spare` references to the `total` ones in the bins. Lengths are
  /// multiplied by `area_scale` before areas are made of them. Ties: the lowest axis, then the lowest position.
  SpatialBinSplit best_split(std::size_t total, std::uint64_t spare, float area_scale) const;

 private:
  struct Bin {
    Box box;
    std::uint32_t begins = 0, ends = 0;  ///< references whose first (last) bin it is
  };

  /// The lower border of a bin.
  float border(int axis, int bin) const { return borders_[axis][static_cast<std::size_t>(bin)]; }
  int bin_at(int axis, float position) const;
  Bin& bin(int axis, int i) { return bins_[static_cast<std::size_t>(axis * count_ + i)]; }
  const Bin& bin(int axis, int i) const { return bins_[static_cast<std::size_t>(axis * count_ + i)]; }
  void add(int axis, const refs::Reference& reference, const refs::Primitives& primitives);
  void find_best(int axis, std::size_t total, std::uint64_t spare, float area_scale, SpatialBinSplit& best) const;

  Box region_;
  int count_;
  float bins_per_length_[3];
  std::array<float, kMostSpatialBins> borders_[3];
  std::vector<Bin> bins_;
};

}  // namespace boxwood::builders
