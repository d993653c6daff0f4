// A camera that sees a whole box. In double, because boxes may be up to 1e18 wide.
#include <algorithm>
#include <cmath>

#include "boxwood/mesh.h"

namespace boxwood::mesh {

View view_from_bounds(const Box& bounds) {
  constexpr double kFov = 40, kMargin = 1.08;
  if (bounds.is_empty() || !is_finite(bounds.lower) || !is_finite(bounds.upper))
    return {.eye = {0, 1, 4}, .look_at = {0, 0, 0}, .up = {0, 1, 0}, .fov = kFov};

  // The longer horizontal side lies across; the camera stands a little aside so that boxes show three faces.
  const Vec3 extent = bounds.extent();
  const bool x_across = extent.x >= extent.z;
  const double aside = 0.3, above = 0.35, scale = 1 / std::hypot(aside, above, 1.0);
  const double side[3] = {x_across ? 1.0 : 0.0, 0, x_across ? 0.0 : -1.0};
  const double front[3] = {x_across ? 0.0 : 1.0, 0, x_across ? 1.0 : 0.0};
  double toward[3], right[3], up[3];
  for (int a = 0; a < 3; ++a) toward[a] = (front[a] + aside * side[a] + (a == 1 ? above : 0)) * scale;
  const double flat = std::hypot(toward[0], toward[2]);
  right[0] = toward[2] / flat, right[1] = 0, right[2] = -toward[0] / flat;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    up[a] = toward[b] * right[c] - toward[c] * right[b];
  }

  // The nearest distance from which each corner lies in a square picture.
  const double tangent = std::tan(0.5 * kFov * 3.14159265358979323846 / 180);
  double distance = 0, largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double x = 0, y = 0, z = 0;
    for (int a = 0; a < 3; ++a) {
      const double half = 0.5 * (double(bounds.upper[a]) - bounds.lower[a]) * (corner >> a & 1 ? 1 : -1);
      x += half * right[a], y += half * up[a], z += half * toward[a];
      largest = std::max(largest, std::fabs(double(bounds.center()[a])));
    }
    distance = std::max(distance, kMargin * std::max(std::fabs(x), std::fabs(y)) / tangent + z);
  }
  // A point has no size: stay far enough away that eye and target differ as floats.
  distance = std::max({distance, 1e-4 * largest, 1e-30});
  View view{.eye = {}, .look_at = bounds.center(), .up = {0, 1, 0}, .fov = kFov};
  for (int a = 0; a < 3; ++a) view.eye[a] = static_cast<float>(bounds.center()[a] + distance * toward[a]);
  return view;
}

}  // namespace boxwood::mesh
