// Binning of centroids on three axes at once, and the best split between bins by the surface area heuristic.
#pragma once

#include <cstdint>

#include "boxwood/refs.h"
#include "builders/parts/box4.h"

namespace boxwood::builders {

inline constexpr int kMostBins = 256;

/// Which bin a (doubled) centroid falls into: floor((centroid2 - origin) * scale) on each axis.
struct BinGrid {
  Float4 origin, scale;
  int count = 0;  ///< bins per axis
  bool usable[3] =
      {};  ///< axes on which the centroids spread far enough to tell them apart; on others all are in bin 0

  /// `axis` < 0: all axes, else only that one.
  static BinGrid over(const Box4& centroids2, int bins, int axis);
  bool any_usable() const { return usable[0] || usable[1] || usable[2]; }
};

/// A split between two bins of one axis.
struct BinSplit {
  int axis = -1;           ///< -1: none
  int bin = 0;             ///< the first bin on the right
  float cost = kInfinity;  ///< area * count of both sides, added; areas of boxes scaled by `area_scale`
  std::uint32_t left_count = 0;
  Box4 left, right;
};

/// Boxes and numbers of references per bin and axis, uninitialised.
struct BinTable {
  /// By axis. The fourth places are not used: with them a bin's address is a shift away from its number.
  struct Boxes {
    alignas(32) float axis[4][8];  ///< lower x, y, z, any; upper x, y, z, any: negated, so that a minimum grows both
  };
  struct Counts {
    alignas(16) std::uint32_t axis[4];
  };

  int count;
  Boxes boxes[kMostBins];
  Counts counts[kMostBins];
};

class Bins {
 public:
  explicit Bins(int count) { clear(count); }

  void clear(int count);
  void add(const BinGrid& grid, const refs::Reference* references, std::size_t count);
  void add(const Bins& other);
  /// Lengths are multiplied by `area_scale` before areas are made of them. Ties: the lowest axis, then the lowest bin.
  BinSplit best_split(const BinGrid& grid, float area_scale) const;
  std::uint32_t count_below(int axis, int bin) const;

 private:
  BinTable table_;
};

}  // namespace boxwood::builders
