#include "render/surface_point.h"

#include <limits>

namespace boxwood::render {
namespace {

/// Distance from the surface, relative to the largest coordinate involved: 16 units in the last place. The hit's t is
/// good to a few of them, and so is the rounding of the new origin.
constexpr double kLift = 16 * 0x1p-23;
/// At most this many lifts back along the ray; what a grazing ray does not gain this way is added along the normal.
constexpr double kLongestPullBack = 8;

}  // namespace

Vector facing_normal(const Ray& ray, Vec3 normal) {
  const Vector direction = normalize(Vector(ray.direction));
  const Vector n(normal);
  if (!is_finite(normal) || !(dot(n, n) > 0)) return direction * -1;
  return normalize(n) * (dot(n, direction) > 0 ? -1.0 : 1.0);
}

SurfacePoint lifted_point(const Ray& ray, const Hit& hit, Vec3 normal, double factor) {
  const Vector n = facing_normal(ray, normal);
  const Vector direction = normalize(Vector(ray.direction));
  const Vector origin(ray.origin);
  const Vector point = origin + Vector(ray.direction) * static_cast<double>(hit.t);
  // The rounding of t grows with the corners' distance too; the square root of the doubled area stands in for it.
  const double size = is_finite(normal) ? std::sqrt(length(Vector(normal))) : 0;
  const double largest = std::fmax(size, std::fmax(magnitude(origin), magnitude(point)));
  const double lift = std::fmax(kLift * factor * largest, static_cast<double>(std::numeric_limits<float>::min()));
  // Back along the ray first: that way is known to be free, while the normal may point into a neighbour near an edge.
  const double cosine = -dot(n, direction);
  const double back = std::fmin(lift / std::fmax(cosine, 1e-30), kLongestPullBack * lift);
  const double up = std::fmax(lift - back * cosine, 0.0);
  return {(point - direction * back + n * up).rounded(), n};
}

float default_occlusion_radius(const Box& bounds) {
  return bounds.is_empty() ? 0 : static_cast<float>(length(Vector(bounds.upper) - Vector(bounds.lower)) / 5);
}

}  // namespace boxwood::render
