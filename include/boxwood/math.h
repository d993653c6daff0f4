// Vectors, boxes, rays and triangles. Plain aggregates of 32-bit floats.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace boxwood {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Largest coordinate magnitude a mesh may have. Beyond it a surface area, a product of two lengths, would not fit a
/// 32-bit float; triangles that reach past it are treated like non-finite ones: counted, reported, left out of trees.
inline constexpr float kLargestCoordinate = 1e18f;

struct Vec3 {
  float x = 0, y = 0, z = 0;

  constexpr float& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator-(Vec3 a) {
  return {-a.x, -a.y, -a.z};
}
constexpr Vec3 operator*(Vec3 a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
constexpr Vec3 operator*(float s, Vec3 a) {
  return a * s;
}
constexpr Vec3 operator*(Vec3 a, Vec3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
constexpr Vec3 operator/(Vec3 a, float s) {
  return {a.x / s, a.y / s, a.z / s};
}
constexpr float dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a) {
  return std::sqrt(dot(a, a));
}
/// `a` at length one; the zero vector stays zero.
inline Vec3 normalize(Vec3 a) {
  const float l = length(a);
  return l > 0 ? a / l : a;
}
// The comparison form is what SSE's minps and maxps do, so compilers turn these into single instructions.
constexpr float minimum(float a, float b) {
  return a < b ? a : b;
}
constexpr float maximum(float a, float b) {
  return a > b ? a : b;
}
constexpr Vec3 minimum(Vec3 a, Vec3 b) {
  return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
constexpr Vec3 maximum(Vec3 a, Vec3 b) {
  return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}
inline bool is_finite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Axis-aligned box, closed on all sides. The default is empty: lower = +inf, upper = -inf.
struct Box {
  Vec3 lower{kInfinity, kInfinity, kInfinity};
  Vec3 upper{-kInfinity, -kInfinity, -kInfinity};

  constexpr void grow(Vec3 p) { lower = minimum(lower, p), upper = maximum(upper, p); }
  constexpr void grow(const Box& b) { lower = minimum(lower, b.lower), upper = maximum(upper, b.upper); }
  constexpr bool is_empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
  constexpr Vec3 extent() const { return is_empty() ? Vec3{} : upper - lower; }
  /// Middle of the box, rounded once per axis: 0.5 * lower + 0.5 * upper.
  constexpr Vec3 center() const { return 0.5f * lower + 0.5f * upper; }
  /// Half of the surface area (square units of the mesh), zero when empty. Ratios need no factor of two.
  constexpr float half_area() const {
    const Vec3 e = extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
  constexpr bool contains(const Box& b) const {
    return lower.x <= b.lower.x && lower.y <= b.lower.y && lower.z <= b.lower.z && upper.x >= b.upper.x &&
           upper.y >= b.upper.y && upper.z >= b.upper.z;
  }
  constexpr int widest_axis() const {
    const Vec3 e = extent();
    return e.x >= e.y ? (e.x >= e.z ? 0 : 2) : (e.y >= e.z ? 1 : 2);
  }
  friend constexpr bool operator==(const Box&, const Box&) = default;
};

constexpr Box merge(Box a, const Box& b) {
  a.grow(b);
  return a;
}

struct Triangle {
  Vec3 v0, v1, v2;

  constexpr Box bounds() const { return {minimum(minimum(v0, v1), v2), maximum(maximum(v0, v1), v2)}; }
  /// Geometric normal, not normalised: (v1 - v0) x (v2 - v0). Its length is twice the triangle's area.
  constexpr Vec3 normal() const { return cross(v1 - v0, v2 - v0); }
};

/// A half-open line of sight: the points origin + t * direction for t in [tmin, tmax]. The direction need not have
/// unit length; t is in units of it. Valid: finite origin and direction, direction not zero, 0 <= tmin <= tmax,
/// tmax may be infinite. A ray outside that range hits nothing (a negative tmin counts as zero).
struct Ray {
  Vec3 origin;
  float tmin = 0;
  Vec3 direction;
  float tmax = kInfinity;
};
static_assert(sizeof(Ray) == 32);

/// Where a picture is taken from: positions in units of the mesh, vertical field of view in degrees (0 to 180).
struct View {
  Vec3 eye, look_at, up{0, 1, 0};
  float fov = 45;
};

}  // namespace boxwood
