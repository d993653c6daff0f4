// How crowded a scene is where: triangles counted in a coarse grid.
#pragma once

#include <array>
#include <vector>

#include "boxwood/refs.h"

namespace boxwood::refs {

/// Centres of references per cell of a grid over the scene's box, as a table of sums: the count in any box of cells is
/// eight look-ups (Crow 1984). Integers only, so the same for every order of counting.
class Crowding {
 public:
  Crowding(const ReferenceSet& set, Executor& executor);

  /// Share of the scene's triangles in the cells that the box touches, over the share of the scene's volume those cells
  /// have: above 1 where it is more crowded than on average. Within 1/kMost to kMost.
  double around(const Box& box) const;

  static constexpr double kMost = 64;

 private:
  static constexpr int kCells = 32;  ///< on each axis

  int cell(float coordinate, int axis) const;
  static std::size_t place(int x, int y, int z) {
    return (static_cast<std::size_t>(z) * (kCells + 1) + static_cast<std::size_t>(y)) * (kCells + 1) +
           static_cast<std::size_t>(x);
  }

  Box bounds_;
  double count_ = 0;
  std::array<double, 3> scale_{};
  std::vector<std::uint32_t> sums_;  ///< sums_[place(x, y, z)]: centres in the cells below x, y and z
};

}  // namespace boxwood::refs
