// A vector of doubles, for geometry that is rounded to single precision only at the end.
#pragma once

#include <cmath>

#include "boxwood/math.h"

namespace boxwood::render {

struct Vector {
  double x = 0, y = 0, z = 0;

  constexpr Vector() = default;
  constexpr Vector(double x, double y, double z) : x(x), y(y), z(z) {}
  explicit constexpr Vector(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
  Vec3 rounded() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
};

constexpr Vector operator+(Vector a, Vector b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vector operator-(Vector a, Vector b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vector operator*(Vector a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
constexpr double dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vector a) {
  return std::sqrt(dot(a, a));
}
/// At length one; `a` must not be zero. Squares of any finite floats fit a double, so nothing overflows here.
inline Vector normalize(Vector a) {
  return a * (1 / length(a));
}
/// Largest absolute coordinate.
inline double magnitude(Vector a) {
  return std::fmax(std::fabs(a.x), std::fmax(std::fabs(a.y), std::fabs(a.z)));
}
/// The coordinate axis that is least aligned with `a`.
inline Vector least_aligned_axis(Vector a) {
  const double x = std::fabs(a.x), y = std::fabs(a.y), z = std::fabs(a.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? Vector{0, 1, 0} : Vector{0, 0, 1};
}

}  // namespace boxwood::render
