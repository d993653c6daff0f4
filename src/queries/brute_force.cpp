// The oracle: every triangle, in double precision.
#include "boxwood/queries.h"

namespace boxwood::queries {
namespace {

struct Vec3d {
  double x, y, z;
};
Vec3d widen(Vec3 a) {
  return {a.x, a.y, a.z};
}
Vec3d operator-(Vec3d a, Vec3d b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double dot(Vec3d a, Vec3d b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace

ExactHit exact_intersection(const Triangle& triangle, const Ray& ray) {
  const Vec3d d = widen(ray.direction), v0 = widen(triangle.v0);
  const Vec3d e1 = widen(triangle.v1) - v0, e2 = widen(triangle.v2) - v0, s = widen(ray.origin) - v0;
  const Vec3d p = cross(d, e2), q = cross(s, e1);
  const double determinant = dot(e1, p);
  if (determinant == 0 || !std::isfinite(determinant)) return {};
  const double u = dot(s, p) / determinant, v = dot(d, q) / determinant, t = dot(e2, q) / determinant;
  const double margin = std::min(std::min(u, v), 1 - u - v);
  if (!(margin >= 0)) return {};
  return {t, u, v, layouts::kInvalidPrimitive, margin};
}

ExactHit brute_force_closest(const MeshView& mesh, const Ray& ray) {
  ExactHit best;
  for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
    const Triangle triangle = mesh.triangle(i);
    if (!boxwood::mesh::is_usable(triangle)) continue;
    ExactHit hit = exact_intersection(triangle, ray);
    if (!(hit.t >= std::max(ray.tmin, 0.0f) && hit.t <= ray.tmax && hit.t < best.t)) continue;
    hit.primitive = static_cast<std::uint32_t>(i);
    best = hit;
  }
  return best;
}

}  // namespace boxwood::queries
