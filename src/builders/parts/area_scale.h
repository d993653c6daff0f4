// Areas that fit a float for meshes of any size.
#pragma once

#include <algorithm>
#include <cmath>

#include "boxwood/math.h"

namespace boxwood::builders {

/// A power of two that brings the longest side of the scene's box near one. Lengths times it lose no bits, and areas
/// made of them neither overflow nor vanish where those of a mesh of 1e18 or 1e-30 units would.
inline float area_scale(const Box& scene) {
  const float longest = scene.extent()[scene.widest_axis()];
  if (!(longest > 0)) return 1;
  int exponent = 0;
  std::frexp(longest, &exponent);
  return std::ldexp(1.0f, -std::max(exponent, -126));
}

/// Half the area of a box with its sides multiplied by `scale`.
inline float scaled_half_area(const Box& box, float scale) {
  const Vec3 e = box.extent() * scale;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

}  // namespace boxwood::builders
