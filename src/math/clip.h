// Clipping of triangles by axis-aligned planes, the way spatial splits need it: what comes out always holds the exact
// part. Sutherland and Hodgman's method (1974) in double precision; boxes made of the corners are rounded outwards past
// the rounding errors of the corners.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "boxwood/math.h"

namespace boxwood {

/// A triangle cut by up to eight planes. Corners are in double precision, in order around the polygon.
class ConvexPolygon {
 public:
  explicit ConvexPolygon(const Triangle& triangle);

  bool is_empty() const { return size_ == 0; }
  /// Keeps the part where coordinate `axis` is at most (`upper`) or at least (not `upper`) `position`, borders
  /// included.
  void clip(int axis, float position, bool upper);
  /// Keeps the part inside the box.
  void clip(const Box& box);
  /// Boxes of the parts between planes on one axis at increasing positions: parts[i] lies below positions[i], the last
  /// one above all. Rounded to nearest, so for estimates only.
  void chop(int axis, std::span<const float> positions, std::span<Box> parts) const;
  /// A box in single precision that holds the exact polygon; empty when there is no corner.
  Box bounds() const;

 private:
  using Point = std::array<double, 3>;
  static constexpr int kMostCorners = 3 + 8;

  std::array<Point, kMostCorners> corners_;
  int size_ = 3;
  /// Bound of the corners' errors, by axis: a few rounding errors of the largest coordinate.
  Point error_;
};

/// The largest box inside both; empty when they are apart.
constexpr Box intersection(const Box& a, const Box& b) {
  const Box both{maximum(a.lower, b.lower), minimum(a.upper, b.upper)};
  return both.is_empty() ? Box{} : both;
}

}  // namespace boxwood
