// Traversal of PBRT's linear nodes (Pharr, Jakob and Humphreys 2016, bib key pbrt): near child first by the sign of
// the direction on the split axis. Ours differs: the box test is conservative (see ray_setup.h) and the stack is never
// too small. Plain scalar code, the same on every instruction set; the reference for the wide kernels.
#include <memory>

#include "queries/kernels/kernels.h"
#include "queries/triangle_test.h"

namespace boxwood::queries {
namespace {

using layouts::Layout;
using layouts::LinearNode;
using layouts::LinearTriangle;

constexpr std::size_t kInlineStack = 128;

bool box_test(const Box& box, const RaySetup& ray, float tmax) {
  float near = ray.tmin, far = tmax;
  for (int axis = 0; axis < 3; ++axis) {
    const bool negative = ray.entry_plane[axis] & 1;
    const float entry = (negative ? box.upper : box.lower)[axis] * ray.reciprocal[axis] + ray.entry_add[axis];
    const float exit = (negative ? box.lower : box.upper)[axis] * ray.reciprocal[axis] + ray.exit_add[axis];
    near = maximum(near, entry);
    far = minimum(far, exit);
  }
  return near <= far;
}

struct Best {
  float t, u = 0, v = 0;
  const LinearTriangle* triangle = nullptr;
};

PermutedTriangle permuted(const Triangle& triangle, const RaySetup& ray) {
  float corner[3][3];
  static_assert(sizeof corner == sizeof triangle);
  std::memcpy(corner, &triangle, sizeof corner);
  PermutedTriangle p;
  for (int i = 0; i < 3; ++i) {
    p.x[i] = corner[i][ray.kx];
    p.y[i] = corner[i][ray.ky];
    p.z[i] = corner[i][ray.kz];
  }
  return p;
}

template <bool kRobust>
bool test_triangle(const Triangle& triangle, const RaySetup& ray, TriangleHit& hit) {
  if constexpr (!kRobust) return fast_test(triangle, ray, hit);
  const PermutedTriangle p = permuted(triangle, ray);
  ShearedTriangle sheared;
  if (!robust_test(p, ray, sheared)) return false;
  const Location location(p, ray);
  hit = {location.t(), static_cast<float>(location.u_times_sum() / location.sum()),
         static_cast<float>(location.v_times_sum() / location.sum())};
  return true;
}

template <bool kRobust, bool kAny, bool kCount>
bool traverse(const Layout& layout, const RaySetup& ray, std::uint32_t* const stack, Best& best, Counts* counts) {
  const auto* nodes = reinterpret_cast<const LinearNode*>(layout.nodes.data());
  const auto* triangles = reinterpret_cast<const LinearTriangle*>(layout.triangles.data());
  std::uint32_t* top = stack;
  std::uint32_t current = 0;
  for (;;) {
    const LinearNode& node = nodes[current];
    if constexpr (kCount) ++counts->nodes;
    if (box_test(node.bounds, ray, best.t)) {
      const std::uint32_t count = node.count_and_axis >> 2;
      if (count == 0) {
        const bool second_first = ray.entry_plane[node.count_and_axis & 3] & 1;
        *top++ = second_first ? current + 1 : node.offset;
        current = second_first ? node.offset : current + 1;
        continue;
      }
      if constexpr (kCount) ++counts->leaves, counts->primitives += count;
      for (const LinearTriangle* t = triangles + node.offset; t != triangles + node.offset + count; ++t) {
        TriangleHit hit;
        if (!test_triangle<kRobust>(t->triangle, ray, hit)) continue;
        const bool nearer =
            hit.t < best.t || (hit.t == best.t && (!best.triangle || t->primitive < best.triangle->primitive));
        if (!(hit.t >= ray.tmin && nearer)) continue;
        best = {hit.t, hit.u, hit.v, t};
        if (kAny) return true;
      }
    }
    if (top == stack) return best.triangle != nullptr;
    current = *--top;
  }
}

template <bool kRobust, bool kAny, bool kCount>
void trace(const Layout& layout, const Ray* rays, std::size_t count, Hit* hits, Vec3* normals, std::uint8_t* occluded,
           Counts* per_ray) {
  std::uint32_t inline_stack[kInlineStack];
  std::unique_ptr<std::uint32_t[]> heap;
  if (layout.max_stack > kInlineStack) heap = std::make_unique_for_overwrite<std::uint32_t[]>(layout.max_stack);
  for (std::size_t i = 0; i < count; ++i) {
    RaySetup setup;
    Best best{};
    if constexpr (kCount) per_ray[i] = {.rays = 1};
    bool hit = layout.root != layouts::kNoRoot && set_up(rays[i], layout.bounds, setup);
    if (hit) {
      best.t = setup.tmax;
      hit = traverse<kRobust, kAny, kCount>(layout, setup, heap ? heap.get() : inline_stack, best,
                                            kCount ? per_ray + i : nullptr);
    }
    if constexpr (kCount) per_ray[i].hits = hit;
    if constexpr (kAny) {
      occluded[i] = hit;
    } else {
      hits[i] = hit ? Hit{best.t * setup.t_scale, best.u, best.v, best.triangle->primitive} : Hit{};
      if (normals) normals[i] = hit ? best.triangle->triangle.normal() : Vec3{};
    }
  }
}

template <bool kRobust>
Kernels make_kernels() {
  return {
      [](const Layout& l, const Ray* r, std::size_t n, Hit* h, Vec3* normals) {
        trace<kRobust, false, false>(l, r, n, h, normals, nullptr, nullptr);
      },
      [](const Layout& l, const Ray* r, std::size_t n, std::uint8_t* o) {
        trace<kRobust, true, false>(l, r, n, nullptr, nullptr, o, nullptr);
      },
      [](const Layout& l, const Ray* r, std::size_t n, Hit* h, Counts* c) {
        trace<kRobust, false, true>(l, r, n, h, nullptr, nullptr, c);
      },
      [](const Layout& l, const Ray* r, std::size_t n, std::uint8_t* o, Counts* c) {
        trace<kRobust, true, true>(l, r, n, nullptr, nullptr, o, c);
      },
  };
}

}  // namespace

Kernels linear_kernels(Mode mode) {
  return mode == Mode::robust ? make_kernels<true>() : make_kernels<false>();
}

}  // namespace boxwood::queries
