// The two ray-triangle tests on one triangle. The SIMD kernels do the same operations in the same order, lane by lane,
// and no step is ever fused, so that every layout and instruction set finds the same bits.
//
// `robust`: Woop, Benthin and Wald 2013 (bib key woop2013): vertices are moved into a frame where the ray is the z
// axis; the signs of three edge functions then say which side of each edge the axis passes. An edge shared by two
// triangles is computed from the same two numbers in both, and rounding is symmetric, so the two answers never leave a
// gap. A float edge function can only be wrong by being zero, since rounding keeps the order of the two products; near
// zero the signs are taken again in double precision, where the products are exact. Ours differs from the paper in two
// points. The second look starts at 1e-30 instead of at zero, so that products too small for a float are covered. And
// the float signs only decide whether there is a hit; where it is (t, u, v) is computed in double precision from the
// mesh's own corners. The paper's t can be off by some 1e-6 of the triangle's size when the ray grazes it, enough for a
// triangle behind the origin to be taken for one in front, and then the answer depends on which boxes happened to be
// opened. `fast`: Moeller and Trumbore 1997 (bib key moller1997); t and the determinant must have one sign, or t be
// zero.
#pragma once

#include "boxwood/math.h"
#include "queries/ray_setup.h"

namespace boxwood::queries {

/// Edge functions this small are looked at again in double precision.
inline constexpr float kTinyEdgeFunction = 1e-30f;

struct TriangleHit {
  float t, u, v;
};

/// A triangle's corners with the axes in the ray's order (kx, ky, kz), as they are in the mesh.
struct PermutedTriangle {
  float x[3], y[3], z[3];
};

/// Corners in the ray's frame, in single precision: the ray is the line x = y = 0. What decides between hit and miss.
struct ShearedTriangle {
  float x[3], y[3];
};

/// Edge functions in double precision, where the products of two floats are exact.
struct EdgeFunctions {
  double u = 0, v = 0, w = 0;

  EdgeFunctions() = default;
  EdgeFunctions(const auto& x, const auto& y)
      : u(double(x[2]) * y[1] - double(y[2]) * x[1]),
        v(double(x[0]) * y[2] - double(y[0]) * x[2]),
        w(double(x[1]) * y[0] - double(y[1]) * x[0]) {}

  bool inside() const { return !((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) && u + v + w != 0; }
  /// Makes the three weights convex up to their sum, whatever side rounding left them on, and gives the sum.
  double clamp() {
    const double sign = std::copysign(1.0, u + v + w);  // either winding is as likely, so a branch would be a bad guess
    u *= sign, v *= sign, w *= sign;
    u = u > 0 ? u : 0, v = v > 0 ? v : 0, w = w > 0 ? w : 0;
    return u + v + w;
  }
};

/// Single-precision look at one triangle: is it hit? The rest is Location's.
inline bool robust_test(const PermutedTriangle& triangle, const RaySetup& ray, ShearedTriangle& sheared) {
  auto& [x, y] = sheared;
  for (int i = 0; i < 3; ++i) {
    const float z = triangle.z[i] - ray.origin[ray.kz];
    x[i] = (triangle.x[i] - ray.origin[ray.kx]) - ray.shear_x * z;
    y[i] = (triangle.y[i] - ray.origin[ray.ky]) - ray.shear_y * z;
  }
  const float u = x[2] * y[1] - y[2] * x[1];
  const float v = x[0] * y[2] - y[0] * x[2];
  const float w = x[1] * y[0] - y[1] * x[0];
  if (minimum(minimum(std::fabs(u), std::fabs(v)), std::fabs(w)) <= kTinyEdgeFunction)
    return EdgeFunctions(x, y).inside();
  return minimum(minimum(u, v), w) >= 0 || maximum(maximum(u, v), w) <= 0;
}

/// Where the ray meets a triangle that the robust test has found hit, in double precision from the mesh's own corners.
/// The weights are convex, so t lies between the corners' distances and the point in the triangle's box even when the
/// triangle is seen edge-on.
class Location {
 public:
  [[gnu::always_inline]] Location(const PermutedTriangle& triangle, const RaySetup& ray) {
    const double dz = ray.direction[ray.kz];
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
      z[i] = double(triangle.z[i]) - ray.origin[ray.kz];
      x[i] = (double(triangle.x[i]) - ray.origin[ray.kx]) - ray.exact_shear_x * z[i];
      y[i] = (double(triangle.y[i]) - ray.origin[ray.ky]) - ray.exact_shear_y * z[i];
    }
    weights_ = EdgeFunctions(x, y);
    sum_ = weights_.clamp();
    if (!(sum_ > 0)) {
      // Exactly edge-on; the rounded frame in which it was found hit still says where.
      ShearedTriangle sheared;
      (void)robust_test(triangle, ray, sheared);
      weights_ = EdgeFunctions(sheared.x, sheared.y);
      sum_ = weights_.clamp();
    }
    t_ = (weights_.u * z[0] + weights_.v * z[1] + weights_.w * z[2]) / (sum_ * dz);
  }
  /// Never -0: which zero it is would depend on the triangle's winding and on the instruction set.
  float t() const { return static_cast<float>(t_) + 0.0f; }
  /// u and v, times sum(): the division can wait until the hit has turned out to be the nearest.
  double u_times_sum() const { return weights_.v; }
  double v_times_sum() const { return weights_.w; }
  double sum() const { return sum_; }

 private:
  EdgeFunctions weights_;
  double sum_, t_;
};

inline bool fast_test(const Triangle& triangle, const RaySetup& ray, TriangleHit& hit) {
  const Vec3 d{ray.direction[0], ray.direction[1], ray.direction[2]};
  const Vec3 e1 = triangle.v1 - triangle.v0, e2 = triangle.v2 - triangle.v0;
  const Vec3 p = cross(d, e2);
  const float determinant = dot(e1, p);
  const Vec3 s = Vec3{ray.origin[0], ray.origin[1], ray.origin[2]} - triangle.v0;
  const Vec3 q = cross(s, e1);
  const float u = dot(s, p), v = dot(d, q);
  const float w = determinant - u - v;
  const float along = dot(e2, q);  // t times the determinant
  if (!(minimum(minimum(u, v), minimum(w, along)) >= 0 || maximum(maximum(u, v), maximum(w, along)) <= 0) ||
      determinant == 0)
    return false;
  const float r = 1.0f / determinant;
  hit.u = u * r;
  hit.v = v * r;
  hit.t = along * r;
  return true;
}

}  // namespace boxwood::queries
