// The two ray-triangle tests on one triangle. The SIMD kernels do the same operations in the same order, lane by lane,
// and no step is ever fused, so that every layout and instruction set finds the same bits.
//
// `robust`: Woop, Benthin and Wald 2013 (bib key woop2013): vertices are moved into a frame where the ray is the z
// axis; the signs of three edge functions then say which side of each edge the axis passes. An edge shared by two
// triangles is computed from the same two numbers in both, and rounding is symmetric, so the two answers never leave a
// gap. A float edge function can only be wrong by being zero, since rounding keeps the order of the two products; near
// zero all three are computed again in double precision, where the products are exact. Ours differs from the paper:
// that second look starts at 1e-30 instead of at zero, so that products too small for a float are covered too, and
// stays in double to the end. `fast`: Moeller and Trumbore 1997 (bib key moller1997).
#pragma once

#include "boxwood/math.h"
#include "queries/ray_setup.h"

namespace boxwood::queries {

/// Edge functions this small are looked at again in double precision.
inline constexpr float kTinyEdgeFunction = 1e-30f;

struct TriangleHit {
  float t, u, v;
};

/// The double-precision end of the robust test: sheared corners (x, y) and their distances z along the main axis. Does
/// not look at [tmin, tmax]. False: missed, or seen exactly edge-on.
inline bool robust_in_double(const float (&x)[3], const float (&y)[3], const float (&z)[3], float shear_z,
                             TriangleHit& hit) {
  const double u = double(x[2]) * y[1] - double(y[2]) * x[1];
  const double v = double(x[0]) * y[2] - double(y[0]) * x[2];
  const double w = double(x[1]) * y[0] - double(y[1]) * x[0];
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double determinant = u + v + w;
  if (!(determinant != 0)) return false;  // also NaN
  hit.u = static_cast<float>(v / determinant);
  hit.v = static_cast<float>(w / determinant);
  hit.t = static_cast<float>((u * z[0] + v * z[1] + w * z[2]) / determinant * shear_z);
  return hit.t == hit.t;
}

inline bool robust_test(const Triangle& triangle, const RaySetup& ray, TriangleHit& hit) {
  float x[3], y[3], z[3];
  const Vec3 corner[3] = {triangle.v0, triangle.v1, triangle.v2};
  for (int i = 0; i < 3; ++i) {
    z[i] = corner[i][ray.kz] - ray.origin[ray.kz];
    x[i] = (corner[i][ray.kx] - ray.origin[ray.kx]) - ray.shear_x * z[i];
    y[i] = (corner[i][ray.ky] - ray.origin[ray.ky]) - ray.shear_y * z[i];
  }
  const float u = x[2] * y[1] - y[2] * x[1];
  const float v = x[0] * y[2] - y[0] * x[2];
  const float w = x[1] * y[0] - y[1] * x[0];
  if (minimum(minimum(std::fabs(u), std::fabs(v)), std::fabs(w)) <= kTinyEdgeFunction)
    return robust_in_double(x, y, z, ray.shear_z, hit);
  if (!(minimum(minimum(u, v), w) >= 0 || maximum(maximum(u, v), w) <= 0)) return false;
  const float r = 1.0f / (u + v + w);
  const float a = u * r;
  hit.u = v * r;
  hit.v = w * r;
  hit.t = (a * z[0] + hit.u * z[1] + hit.v * z[2]) * ray.shear_z;
  return true;
}

inline bool fast_test(const Triangle& triangle, const RaySetup& ray, TriangleHit& hit) {
  const Vec3 d{ray.direction[0], ray.direction[1], ray.direction[2]};
  const Vec3 e1 = triangle.v1 - triangle.v0, e2 = triangle.v2 - triangle.v0;
  const Vec3 p = cross(d, e2);
  const float determinant = dot(e1, p);
  const Vec3 s = Vec3{ray.origin[0], ray.origin[1], ray.origin[2]} - triangle.v0;
  const Vec3 q = cross(s, e1);
  const float u = dot(s, p), v = dot(d, q);
  const float w = determinant - u - v;
  if (!(minimum(minimum(u, v), w) >= 0 || maximum(maximum(u, v), w) <= 0) || determinant == 0) return false;
  const float r = 1.0f / determinant;
  hit.u = u * r;
  hit.v = v * r;
  hit.t = dot(e2, q) * r;
  return true;
}

}  // namespace boxwood::queries
