// Morton codes (Morton 1966, bib key morton1966): points on a grid, numbered along a Z-shaped curve by interleaving the
// bits of their cell's three coordinates, x highest. Points that share the first bits of their codes share a cell of a
// coarser grid.
#pragma once

#include <cstdint>

#include "boxwood/math.h"

namespace boxwood {

/// Where bits stay when they are spread to every third place, by 32, 16, 8, 4 and 2 places one after the other.
inline constexpr std::uint64_t kSpreadMasks[] = {0x001f00000000ffff, 0x001f0000ff0000ff, 0x100f00f00f00f00f,
                                                 0x10c30c30c30c30c3, 0x1249249249249249};

/// Bits of `v` (its lowest 21) spread out to every third place.
constexpr std::uint64_t spread_bits(std::uint32_t v) {
  std::uint64_t x = v & 0x1fffff;
  int places = 32;
  for (const std::uint64_t mask : kSpreadMasks) {
    x = (x | x << places) & mask;
    places /= 2;
  }
  return x;
}

constexpr std::uint64_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
}

/// The grid of 2^bits_per_axis cells a side over a box, 1 to 21 bits. Points outside the box count to the nearest cell.
class MortonGrid {
 public:
  MortonGrid(const Box& bounds, int bits_per_axis) : last_cell_(double((1u << bits_per_axis) - 1)) {
    // In doubles: the extent may be anything from the smallest float to nearly the largest.
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = double(bounds.upper[axis]) - double(bounds.lower[axis]);
      lower_[axis] = double(bounds.lower[axis]);
      scale_[axis] = extent > 0 ? double(1u << bits_per_axis) / extent : 0.0;
    }
  }
  std::uint64_t code(Vec3 p) const { return morton_code(cell(p, 0), cell(p, 1), cell(p, 2)); }
  /// A point's cell on an axis is (p - lower) * scale, rounded down, and at most the last.
  double lower(int axis) const { return lower_[axis]; }
  double scale(int axis) const { return scale_[axis]; }
  double last_cell() const { return last_cell_; }

 private:
  std::uint32_t cell(Vec3 p, int axis) const {
    const double position = (double(p[axis]) - lower_[axis]) * scale_[axis];
    const double inside = position > 0 ? (position < last_cell_ ? position : last_cell_) : 0.0;
    return std::uint32_t(inside);
  }
  double last_cell_;
  double lower_[3], scale_[3];
};

}  // namespace boxwood
