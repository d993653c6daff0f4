// What is computed once per ray: constants of the conservative box test and of the watertight triangle test.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "boxwood/math.h"

namespace boxwood::queries {

/// A ray in the form the kernels want. Its direction is scaled by a power of two so that the largest component is near
/// 1; that is exact, and makes every later step independent of the direction's length.
///
/// Box test. A slab's entry is plane * reciprocal - origin * reciprocal, one fused operation. With h = 2^-24 (half a
/// unit in the last place), M the largest |plane| + |origin| on the axis and P = M * |reciprocal|, its error is at most
/// 5 h P (reciprocal, origin product, pad, plane product where there is no fused operation, sum), and the watertight
/// triangle test may move a vertex by up to 4 h M on the two axes across the ray (three roundings of the shear
/// constant, its product and the translation, one of the difference). `entry_add` is lowered and `exit_add` raised by
/// 12 h P, so a box is never missed by a ray that the triangle test lets hit something inside it. Cost: none, the pad
/// is part of the constant.
///
/// Axis-parallel rays: the reciprocal is limited to 1e37 / max(M, 1). Every product stays finite, so no NaN arises, and
/// a ray that lies exactly in a box's side has an interval of +-12 h * M * 1e37 (at most) there, which constrains
/// nothing.
struct RaySetup {  // [3] is never read: there to be written along by vectors of four
  alignas(16) float origin[4];
  float direction[4];  // scaled
  float reciprocal[4];
  float entry_add[4], exit_add[4];
  int entry_plane[4], exit_plane[4];  // row of WideNode::planes
  float tmin, tmax;                   // of the scaled direction
  float t_scale;                      // t of the user's direction = t_scale * t of the scaled one; a power of two
  int kx, ky, kz;                     // kz: axis of the largest direction component
  float shear_x, shear_y, inverse_z;
  double exact_shear_x, exact_shear_y;  // what shear_x and shear_y are rounded from
};

inline constexpr int kNextAxis[3] = {1, 2, 0};

/// Exponents, as floats have them in bits 23 to 30, that a direction's largest component is taken to have: those for
/// which both the power of two and its inverse are normal numbers.
inline constexpr int kLowestExponent = 1, kHighestExponent = 253;

/// `down` and `up`: the power of two that directions are multiplied by, and its inverse. False when the interval is
/// empty.
inline bool set_interval(const Ray& ray, float down, float up, RaySetup& s) {
  s.t_scale = down;
  s.tmin = ray.tmin > 0 ? ray.tmin * up : 0.0f;
  s.tmax = ray.tmax * up;
  return s.tmin <= s.tmax && !std::isnan(ray.tmin);
}

/// Everything that follows from the main axis and the scaled direction.
inline void set_main_axis(int axis, RaySetup& s) {
  s.kz = axis;
  s.kx = kNextAxis[axis];
  s.ky = kNextAxis[s.kx];
  const float dz = s.direction[s.kz];
  s.inverse_z = 1.0f / dz;
  s.exact_shear_x = static_cast<double>(s.direction[s.kx]) / dz;
  s.exact_shear_y = static_cast<double>(s.direction[s.ky]) / dz;
  s.shear_x = static_cast<float>(s.exact_shear_x);
  s.shear_y = static_cast<float>(s.exact_shear_y);
}

/// False when nothing can be hit: NaN or infinity in origin or direction, zero direction, empty interval.
inline bool set_up(const Ray& ray, const Box& bounds, RaySetup& s) {
  const Vec3 d = ray.direction;
  const float largest = maximum(maximum(std::fabs(d.x), std::fabs(d.y)), std::fabs(d.z));
  if (!(largest > 0) || !is_finite(d) || !is_finite(ray.origin)) return false;
  int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(largest) >> 23);
  exponent = exponent < kLowestExponent ? kLowestExponent : exponent > kHighestExponent ? kHighestExponent : exponent;
  const float down = std::bit_cast<float>((254u - static_cast<std::uint32_t>(exponent)) << 23);
  const float up = std::bit_cast<float>(static_cast<std::uint32_t>(exponent) << 23);
  if (!set_interval(ray, down, up, s)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const float o = s.origin[axis] = ray.origin[axis];
    const float da = s.direction[axis] = d[axis] * down;
    const float reach = maximum(std::fabs(bounds.lower[axis]), std::fabs(bounds.upper[axis])) + std::fabs(o);
    const float limit = 1e37f / maximum(reach, 1.0f);
    const float r = minimum(1.0f / std::fabs(da), limit);
    const float pad = 12 * 0x1p-24f * reach * r;
    const bool negative = std::signbit(da);
    s.reciprocal[axis] = negative ? -r : r;
    const float offset = -o * s.reciprocal[axis];
    s.entry_add[axis] = offset - pad;
    s.exit_add[axis] = offset + pad;
    s.entry_plane[axis] = 2 * axis + negative;
    s.exit_plane[axis] = 2 * axis + !negative;
  }
  const float x = std::fabs(s.direction[0]), y = std::fabs(s.direction[1]), z = std::fabs(s.direction[2]);
  set_main_axis(x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2), s);
  return true;
}

}  // namespace boxwood::queries
