#include "math/clip.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

#include "math/rounding.h"

namespace boxwood {
namespace {

/// Four floats that are worked on together (a vector of g++ and clang++).
using Lanes = float __attribute__((vector_size(16)));

}  // namespace

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
  // In single precision; the fourth lane is not used.
  struct Part {
    Lanes lower, upper;
    void clear() { lower = Lanes{} + kInfinity, upper = Lanes{} - kInfinity; }
    void grow(Lanes p) {
      lower = lower < p ? lower : p;
      upper = upper > p ? upper : p;
    }
  };
  constexpr std::size_t kFew = 33;
  alignas(16) std::array<std::byte, kFew * sizeof(Part)> few;  // not initialised: that would cost more than the rest
  std::vector<Part> many(parts.size() > kFew ? parts.size() : 0);
  Part* const boxes = many.empty() ? reinterpret_cast<Part*>(few.data()) : many.data();
  for (std::size_t i = 0; i < parts.size(); ++i) boxes[i].clear();
  const auto a = static_cast<std::size_t>(axis);
  std::array<Lanes, kMostCorners> corners;
  std::array<std::size_t, kMostCorners> first;  // part of each corner
  for (std::size_t i = 0; i < static_cast<std::size_t>(size_); ++i) {
    const Point& p = corners_[i];
    corners[i] = Lanes{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]), 0};
    const float at = corners[i][a];
    first[i] = 0;
    while (first[i] < positions.size() && positions[first[i]] <= at) ++first[i];
    boxes[first[i]].grow(corners[i]);
  }
  for (std::size_t i = 0, last = static_cast<std::size_t>(size_) - 1; i < static_cast<std::size_t>(size_); last = i++) {
    const bool rises = corners[last][a] < corners[i][a];
    const std::size_t from = rises ? last : i, to = rises ? i : last;
    if (first[from] == first[to]) continue;
    const Lanes low = corners[from];
    const float begin = low[a];
    const Lanes slope = (corners[to] - low) * (1 / (corners[to][a] - begin));
    for (std::size_t part = first[from]; part < first[to]; ++part) {
      const Lanes crossing = low + (positions[part] - begin) * slope;
      boxes[part].grow(crossing), boxes[part + 1].grow(crossing);
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Lanes l = boxes[i].lower, u = boxes[i].upper;
    parts[i] = {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
    // What rounding may have moved past the planes.
    if (i > 0) parts[i].lower[axis] = maximum(parts[i].lower[axis], positions[i - 1]);
    if (i < positions.size()) parts[i].upper[axis] = minimum(parts[i].upper[axis], positions[i]);
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

double ConvexPolygon::area() const {
  double sum[3] = {};
  for (std::size_t i = 2; i < static_cast<std::size_t>(size_); ++i) {
    double a[3], b[3];
    for (std::size_t k = 0; k < 3; ++k)
      a[k] = corners_[i - 1][k] - corners_[0][k], b[k] = corners_[i][k] - corners_[0][k];
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

}  // namespace boxwood
