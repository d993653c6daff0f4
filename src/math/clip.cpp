#include "math/clip.h"

#include <algorithm>
#include <cassert>

#include "math/rounding.h"

namespace boxwood {

ConvexPolygon::ConvexPolygon(const Triangle& triangle) {
  const Vec3* const vertices[] = {&triangle.v0, &triangle.v1, &triangle.v2};
  for (int axis = 0; axis < 3; ++axis) {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = (*vertices[i])[axis];
      corners_[i][static_cast<std::size_t>(axis)] = x;
      largest = std::max(largest, std::fabs(x));
    }
    // Each cut adds less than four roundings to a corner, and there are at most eight cuts.
    error_[static_cast<std::size_t>(axis)] = 32 * std::numeric_limits<double>::epsilon() * largest;
  }
}

void ConvexPolygon::clip(int axis, float position, bool upper) {
  const auto a = static_cast<std::size_t>(axis);
  const double plane = position;
  const auto outside = [&](const Point& p) { return upper ? p[a] > plane : p[a] < plane; };
  const auto begin = corners_.begin(), end = corners_.begin() + size_;
  if (std::none_of(begin, end, outside)) return;
  std::array<Point, kMostCorners> kept;
  int count = 0;
  for (int i = 0; i < size_; ++i) {
    const Point& from = corners_[static_cast<std::size_t>(i)];
    const Point& to = corners_[static_cast<std::size_t>(i + 1 == size_ ? 0 : i + 1)];
    if (!outside(from)) kept[static_cast<std::size_t>(count++)] = from;
    if (outside(from) == outside(to) || from[a] == plane || to[a] == plane) continue;
    // From the lower corner, so that both polygons at an edge get the same point.
    const Point &low = from < to ? from : to, &high = from < to ? to : from;
    const double share = (plane - low[a]) / (high[a] - low[a]);
    Point& cut = kept[static_cast<std::size_t>(count++)];
    for (std::size_t k = 0; k < 3; ++k) cut[k] = low[k] + share * (high[k] - low[k]);
    cut[a] = plane;
    assert(count < kMostCorners);
  }
  std::copy_n(kept.begin(), count, corners_.begin());
  size_ = count;
}

void ConvexPolygon::clip(const Box& box) {
  for (int axis = 0; axis < 3 && size_ > 0; ++axis) {
    clip(axis, box.lower[axis], false);
    clip(axis, box.upper[axis], true);
  }
}

void ConvexPolygon::chop(int axis, std::span<const float> positions, std::span<Box> parts) const {
  const auto a = static_cast<std::size_t>(axis);
  for (Box& part : parts) part = {};
  const auto grow = [&](std::size_t part, const Point& p) {
    parts[part].grow(Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  };
  const auto slab = [&](double x) {
    return static_cast<std::size_t>(std::upper_bound(positions.begin(), positions.end(), x) - positions.begin());
  };
  for (int i = 0; i < size_; ++i) {
    const Point& from = corners_[static_cast<std::size_t>(i)];
    const Point& to = corners_[static_cast<std::size_t>(i + 1 == size_ ? 0 : i + 1)];
    const bool rises = from[a] < to[a];
    const Point &low = rises ? from : to, &high = rises ? to : from;
    std::size_t part = slab(low[a]);
    grow(part, low);
    for (; part < positions.size() && positions[part] < high[a]; ++part) {
      const double share = (positions[part] - low[a]) / (high[a] - low[a]);
      Point crossing;
      for (std::size_t k = 0; k < 3; ++k) crossing[k] = low[k] + share * (high[k] - low[k]);
      crossing[a] = positions[part];
      grow(part, crossing), grow(part + 1, crossing);
    }
    grow(part, high);
  }
}

Box ConvexPolygon::bounds() const {
  Box box;
  if (size_ == 0) return box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    double lower = corners_[0][a], upper = lower;
    for (int i = 1; i < size_; ++i) {
      lower = std::min(lower, corners_[static_cast<std::size_t>(i)][a]);
      upper = std::max(upper, corners_[static_cast<std::size_t>(i)][a]);
    }
    box.lower[axis] = round_down(lower - error_[a]);
    box.upper[axis] = round_up(upper + error_[a]);
  }
  return box;
}

}  // namespace boxwood
