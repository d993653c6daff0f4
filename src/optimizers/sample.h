// Segments that a sample of rays has walked, and boxes tested against them.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/math.h"

namespace boxwood::optimizers {

/// A ray cut at its hit, ready for box tests. Multiplications stay finite, so that none gives NaN.
struct Segment {
  float origin[3], reciprocal[3];
  float tmin, tmax;
  int entry[3];  ///< 0: the lower side is met first, 1: the upper one

  explicit Segment(const Ray& ray) : tmin(ray.tmin), tmax(ray.tmax) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = ray.origin[axis];
      const float d = ray.direction[axis];
      reciprocal[axis] = std::fabs(d) > 1e-18f ? 1 / d : std::copysign(1e18f, d);
      entry[axis] = std::signbit(d);
    }
  }

  bool meets(const Box& box) const {
    float near = tmin, far = tmax;
    for (int axis = 0; axis < 3; ++axis) {
      const float a = (box.lower[axis] - origin[axis]) * reciprocal[axis];
      const float b = (box.upper[axis] - origin[axis]) * reciprocal[axis];
      near = maximum(near, minimum(a, b));
      far = minimum(far, maximum(a, b));
    }
    return near <= far;
  }
};

/// Segments of rays that can hit something; others are left out.
std::vector<Segment> make_segments(std::span<const Ray> rays);

/// How often nodes below a node are visited, of those rays that visit it: measured, with `prior` rays more that go as
/// the surface area says. So a few samples do not overrule the areas, and many do.
class VisitShare {
 public:
  VisitShare(std::uint32_t parent_visits, float parent_area, float prior)
      : inverse_(1 / (float(parent_visits) + prior)),
        prior_per_area_(parent_area > 0 ? prior / parent_area : 0),
        without_area_(parent_area > 0 ? 0 : prior) {}

  float operator()(std::uint32_t visits, float area) const {
    return (float(visits) + prior_per_area_ * area + without_area_) * inverse_;
  }

 private:
  float inverse_, prior_per_area_, without_area_;
};

}  // namespace boxwood::optimizers
