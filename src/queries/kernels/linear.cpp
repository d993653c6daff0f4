// Traversal of PBRT's linear nodes (Pharr, Jakob and Humphreys 2016, bib key pbrt): near child first by the sign of
// the direction on the split axis. Ours differs: the box test is conservative (see ray_setup.h) and the stack is never
// too small. Plain scalar code, the same on every instruction set; the reference for the wide kernels.
#include <memory>

#include "queries/kernels/kernels.h"
#include "queries/kernels/linear_steps.h"

namespace boxwood::queries {
namespace {

constexpr std::size_t kInlineStack = 128;

/// With `kTerminate` false a hit neither shortens the ray nor ends its way: every node on the line is visited, as the
/// surface area cost assumes.
template <bool kRobust, bool kAny, bool kCount, bool kTerminate>
bool traverse(const Layout& layout, const RaySetup& ray, std::uint32_t* const stack, Best& best, Counts* counts) {
  const auto* nodes = reinterpret_cast<const LinearNode*>(layout.nodes.data());
  const auto* triangles = reinterpret_cast<const LinearTriangle*>(layout.triangles.data());
  std::uint32_t* top = stack;
  std::uint32_t current = 0;
  for (;;) {
    const LinearNode& node = nodes[current];
    if constexpr (kCount) ++counts->nodes;
    if (box_test(node.bounds, ray, kTerminate ? best.t : ray.tmax)) {
      const std::uint32_t count = node.count_and_axis >> 2;
      if (count == 0) {
        const bool second_first = ray.entry_plane[node.count_and_axis & 3] & 1;
        *top++ = second_first ? current + 1 : node.offset;
        current = second_first ? node.offset : current + 1;
        continue;
      }
      if constexpr (kCount) ++counts->leaves, counts->primitives += count;
      for (const LinearTriangle* t = triangles + node.offset; t != triangles + node.offset + count; ++t)
        if (improve<kRobust>(*t, ray, best) && kAny && kTerminate) return true;
    }
    if (top == stack) return best.triangle != nullptr;
    current = *--top;
  }
}

template <bool kRobust, bool kAny, bool kCount, bool kTerminate = true>
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
      hit = traverse<kRobust, kAny, kCount, kTerminate>(layout, setup, heap ? heap.get() : inline_stack, best,
                                                        kCount ? per_ray + i : nullptr);
    }
    if constexpr (kCount) per_ray[i].hits = hit;
    if constexpr (kAny) {
      occluded[i] = hit;
    } else {
      hits[i] = hit ? make_hit(setup, best) : Hit{};
      if (normals) normals[i] = normal_of(best);
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

template <bool kRobust>
TraversalKernels make_unending_kernels() {
  return {
      [](const Layout& l, const Ray* r, std::size_t n, const TraversalOptions&, Hit* h, Vec3* normals, Counts* c) {
        if (c)
          trace<kRobust, false, true, false>(l, r, n, h, normals, nullptr, c);
        else
          trace<kRobust, false, false, false>(l, r, n, h, normals, nullptr, nullptr);
      },
      [](const Layout& l, const Ray* r, std::size_t n, const TraversalOptions&, std::uint8_t* o, Counts* c) {
        if (c)
          trace<kRobust, true, true, false>(l, r, n, nullptr, nullptr, o, c);
        else
          trace<kRobust, true, false, false>(l, r, n, nullptr, nullptr, o, nullptr);
      },
  };
}

}  // namespace

Kernels linear_kernels(Mode mode) {
  return mode == Mode::robust ? make_kernels<true>() : make_kernels<false>();
}

TraversalKernels unending_kernels(Mode mode) {
  return mode == Mode::robust ? make_unending_kernels<true>() : make_unending_kernels<false>();
}

}  // namespace boxwood::queries
