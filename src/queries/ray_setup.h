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
struct RaySetup {
  float origin[3];
  float direction[3];  // scaled
  float reciprocal[3];
  float entry_add[3], exit_add[3];
  int entry_plane[3], exit_plane[3];  // row of WideNode::planes
  float tmin, tmax;                   // of the scaled direction
  float t_scale;                      // t of the user's direction = t_scale * t of the scaled one; a power of two
  int kx, ky, kz;                     // kz: axis of the largest direction component
  float shear_x, shear_y, inverse_z;
};

/// False when nothing can be hit: NaN or infinity in origin or direction, zero direction, empty interval.
inline bool set_up(const Ray& ray, const Box& bounds, RaySetup& s) {
  const Vec3 d = ray.direction;
  const float largest = maximum(maximum(std::fabs(d.x), std::fabs(d.y)), std::fabs(d.z));
  if (!(largest > 0) || !is_finite(d) || !is_finite(ray.origin)) return false;
  int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(largest) >> 23) - 127;
  exponent = exponent < -126 ? -126 : exponent > 126 ? 126 : exponent;
  const float down = std::bit_cast<float>(static_cast<std::uint32_t>(127 - exponent) << 23);  // 2^-exponent
  const float up = std::bit_cast<float>(static_cast<std::uint32_t>(127 + exponent) << 23);    // 2^exponent
  s.t_scale = down;
  s.tmin = ray.tmin > 0 ? ray.tmin * up : 0.0f;
  s.tmax = ray.tmax * up;
  if (!(s.tmin <= s.tmax) || std::isnan(ray.tmin)) return false;
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
  s.kz = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  s.kx = s.kz == 2 ? 0 : s.kz + 1;
  s.ky = s.kx == 2 ? 0 : s.kx + 1;
  const float dz = s.direction[s.kz];
  s.inverse_z = 1.0f / dz;
  s.shear_x = s.direction[s.kx] / dz;
  s.shear_y = s.direction[s.ky] / dz;
  return true;
}

}  // namespace boxwood::queries
