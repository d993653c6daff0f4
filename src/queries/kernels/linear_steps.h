// What every traversal of the `linear` layout does for one ray: the box test, the triangle test, taking a hit. Plain
// scalar code, the same on every instruction set.
#pragma once

#include <cstring>

#include "boxwood/queries.h"
#include "queries/triangle_test.h"

namespace boxwood::queries {

using layouts::Layout;
using layouts::LinearNode;
using layouts::LinearTriangle;

inline bool box_test(const Box& box, const RaySetup& ray, float tmax) {
  float near = ray.tmin, far = tmax;
  for (int axis = 0; axis < 3; ++axis) {
    const bool negative = ray.entry_plane[axis] & 1;
    const float entry = (negative ? box.upper : box.lower)[axis] * ray.reciprocal[axis] + ray.entry_add[axis];
    const float exit = (negative ? box.lower : box.upper)[axis] * ray.reciprocal[axis] + ray.exit_add[axis];
    near = maximum(near, entry);
    far = minimum(far, exit);
  }
  return near <= far;
}

/// The nearest hit so far; t begins as the ray's tmax.
struct Best {
  float t = 0, u = 0, v = 0;
  const LinearTriangle* triangle = nullptr;
};

inline PermutedTriangle permuted(const Triangle& triangle, const RaySetup& ray) {
  float corner[3][3];
  static_assert(sizeof corner == sizeof triangle);
  std::memcpy(corner, &triangle, sizeof corner);
  PermutedTriangle p;
  for (int i = 0; i < 3; ++i) {
    p.x[i] = corner[i][ray.kx];
    p.y[i] = corner[i][ray.ky];
    p.z[i] = corner[i][ray.kz];
  }
  return p;
}

template <bool kRobust>
bool test_triangle(const Triangle& triangle, const RaySetup& ray, TriangleHit& hit) {
  if constexpr (!kRobust) return fast_test(triangle, ray, hit);
  const PermutedTriangle p = permuted(triangle, ray);
  ShearedTriangle sheared;
  if (!robust_test(p, ray, sheared)) return false;
  const Location location(p, ray);
  hit = {location.t(), static_cast<float>(location.u_times_sum() / location.sum()),
         static_cast<float>(location.v_times_sum() / location.sum())};
  return true;
}

/// Tests one triangle and takes its hit when it is the nearest so far; of several at one t the lowest id.
template <bool kRobust>
bool improve(const LinearTriangle& triangle, const RaySetup& ray, Best& best) {
  TriangleHit hit;
  if (!test_triangle<kRobust>(triangle.triangle, ray, hit)) return false;
  const bool nearer =
      hit.t < best.t || (hit.t == best.t && (!best.triangle || triangle.primitive < best.triangle->primitive));
  if (!(hit.t >= ray.tmin && nearer)) return false;
  best = {hit.t, hit.u, hit.v, &triangle};
  return true;
}

inline Hit make_hit(const RaySetup& ray, const Best& best) {
  return best.triangle ? Hit{best.t * ray.t_scale, best.u, best.v, best.triangle->primitive} : Hit{};
}

inline Vec3 normal_of(const Best& best) {
  return best.triangle ? best.triangle->triangle.normal() : Vec3{};
}

}  // namespace boxwood::queries
