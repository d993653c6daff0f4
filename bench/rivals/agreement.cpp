#include "agreement.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace boxwood::rivals {
namespace {

struct Point {
  double x, y, z;
};
Point point(Vec3 a) {
  return {a.x, a.y, a.z};
}
Point operator-(Point a, Point b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double dot(Point a, Point b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Distance between a ray's line and the segment from a to b.
double distance_to_edge(const Ray& ray, Point a, Point b) {
  const Point d = point(ray.direction), e = b - a, w = a - point(ray.origin);
  const double dd = dot(d, d), de = dot(d, e), ee = dot(e, e), dw = dot(d, w), ew = dot(e, w);
  const double determinant = dd * ee - de * de;
  const double s = determinant > 0 ? std::clamp((de * dw - dd * ew) / determinant, 0.0, 1.0) : 0.0;
  const double t = (dw + s * de) / dd;
  const Point gap{w.x + s * e.x - t * d.x, w.y + s * e.y - t * d.y, w.z + s * e.z - t * d.z};
  return std::sqrt(dot(gap, gap));
}

/// Does the ray pass so near to a border of the triangle that roundings of its coordinates decide? The limit is the one
/// the box test is widened by (src/queries/ray_setup.h).
bool on_border(const MeshView& mesh, const Ray& ray, std::uint32_t primitive) {
  if (primitive == layouts::kInvalidPrimitive) return false;
  const Triangle t = mesh.triangle(primitive);
  double largest = 0;
  for (Vec3 p : {t.v0, t.v1, t.v2, ray.origin})
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::fabs(double(p[axis])));
  const Point a = point(t.v0), b = point(t.v1), c = point(t.v2);
  const double nearest =
      std::min({distance_to_edge(ray, a, b), distance_to_edge(ray, b, c), distance_to_edge(ray, c, a)});
  return nearest <= 24 * 0x1p-24 * largest;
}

struct Verdict {
  bool ours = false, theirs = false, border = false;
};

void add(Verdicts& total, const Verdict& verdict, std::size_t ray, const std::string& sentence) {
  ++total.judged;
  if (verdict.ours && verdict.theirs)
    ++total.both;
  else if (verdict.ours)
    ++total.ours_right;
  else if (verdict.border)
    ++total.border;
  else if (total.wrong++ == 0)
    total.first_wrong = "ray " + std::to_string(ray) + ": " + sentence;
}

std::string text(double t, std::uint32_t primitive) {
  if (primitive == layouts::kInvalidPrimitive) return "a miss";
  return "triangle " + std::to_string(primitive) + " at t = " + std::to_string(t);
}

/// Brute force over each ray of the list, several at once.
std::vector<queries::ExactHit> exact_hits(const MeshView& mesh, std::span<const Ray> rays,
                                          std::span<const std::size_t> list, Executor& executor) {
  std::vector<queries::ExactHit> exact(list.size());
  executor.for_chunks(list.size(), 1, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) exact[i] = queries::brute_force_closest(mesh, rays[list[i]]);
  });
  return exact;
}

}  // namespace

bool close(double a, double b) {
  return std::fabs(a - b) <= 1e-5 * std::max(std::fabs(a), std::fabs(b));
}

Verdicts compare_closest(const MeshView& mesh, std::span<const Ray> rays, std::span<const Hit> ours,
                         std::span<const Hit> theirs, Executor& executor, std::size_t most_judged) {
  Verdicts total;
  total.rays = rays.size();
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit &a = ours[i], &b = theirs[i];
    total.hits += a.is_hit();
    if (a.is_hit() == b.is_hit() && (!a || a.primitive == b.primitive || close(a.t, b.t))) continue;
    if (++total.differences <= most_judged) list.push_back(i);
  }
  const auto exact = exact_hits(mesh, rays, list, executor);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::size_t i = list[k];
    const queries::ExactHit& truth = exact[k];
    const auto agrees = [&](const Hit& hit) {
      if (!hit || truth.primitive == layouts::kInvalidPrimitive)
        return !hit && truth.primitive == layouts::kInvalidPrimitive;
      return hit.primitive == truth.primitive || close(hit.t, truth.t);
    };
    const bool border = on_border(mesh, rays[i], ours[i].primitive) || on_border(mesh, rays[i], truth.primitive);
    add(total, {agrees(ours[i]), agrees(theirs[i]), border}, i,
        "ours " + text(ours[i].t, ours[i].primitive) + ", theirs " + text(theirs[i].t, theirs[i].primitive) +
            ", exact " + text(truth.t, truth.primitive));
  }
  return total;
}

Verdicts compare_any(const MeshView& mesh, std::span<const Ray> rays, std::span<const std::uint8_t> ours,
                     std::span<const std::uint8_t> theirs, const std::function<Hit(const Ray&)>& our_hit,
                     Executor& executor, std::size_t most_judged) {
  Verdicts total;
  total.rays = rays.size();
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    total.hits += ours[i] != 0;
    if ((ours[i] != 0) == (theirs[i] != 0)) continue;
    if (++total.differences <= most_judged) list.push_back(i);
  }
  const auto exact = exact_hits(mesh, rays, list, executor);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::size_t i = list[k];
    const bool truth = exact[k].primitive != layouts::kInvalidPrimitive;
    const bool border =
        on_border(mesh, rays[i], our_hit(rays[i]).primitive) || on_border(mesh, rays[i], exact[k].primitive);
    add(total, {(ours[i] != 0) == truth, (theirs[i] != 0) == truth, border}, i,
        std::string("ours ") + (ours[i] ? "a hit" : "a miss") + ", theirs " + (theirs[i] ? "a hit" : "a miss") +
            ", exact " + text(exact[k].t, exact[k].primitive));
  }
  return total;
}

}  // namespace boxwood::rivals
