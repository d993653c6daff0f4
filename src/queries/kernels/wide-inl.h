// Single-ray traversal of wide nodes (Wald, Benthin and Boulos 2008; Afra 2013), one ray at a time, nearest child
// first. Compiled once per instruction set by the sources that include it; no include guard of the usual kind for that
// reason.
//
// A node visit computes entry and exit distance of all W boxes with one fused operation per plane (see ray_setup.h for
// why that is conservative). Of the children hit one is gone on with at once; the others wait on a stack, sorted by
// entry distance. A waiting child is dropped when a hit nearer than its entry has been found meanwhile. All comparisons
// are inclusive, so that of several triangles at the same t the lowest primitive id is found in whatever order they
// come.
#if defined(BOXWOOD_QUERIES_KERNELS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_WIDE_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_WIDE_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_WIDE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <memory>

#include "boxwood/queries.h"
#include "queries/kernels/ray_setup-inl.h"
#include "queries/kernels/triangle_leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using layouts::Layout;
using layouts::WideNode;

/// Entries a traversal keeps on the machine's stack; a tree that needs more gets them from the heap.
inline constexpr std::size_t kInlineStack = 256;

/// What the box test needs of a ray, spread over the lanes once per ray.
template <int W>
class BoxTest {
 public:
  HWY_INLINE explicit BoxTest(const RaySetup& ray) : tmin_(hn::Set(D(), ray.tmin)) {
    const D d;
    rx_ = hn::Set(d, ray.reciprocal[0]), ry_ = hn::Set(d, ray.reciprocal[1]), rz_ = hn::Set(d, ray.reciprocal[2]);
    entry_x_ = hn::Set(d, ray.entry_add[0]), entry_y_ = hn::Set(d, ray.entry_add[1]);
    entry_z_ = hn::Set(d, ray.entry_add[2]);
    exit_x_ = hn::Set(d, ray.exit_add[0]), exit_y_ = hn::Set(d, ray.exit_add[1]);
    exit_z_ = hn::Set(d, ray.exit_add[2]);
    for (int axis = 0; axis < 3; ++axis) {
      entry_row_[axis] = static_cast<Row>(ray.entry_plane[axis]) * kRow;
      exit_row_[axis] = static_cast<Row>(ray.exit_plane[axis]) * kRow;
    }
  }

  /// Children of a node that the ray meets within [tmin, tmax], as bits, with their entry distances.
  HWY_INLINE std::uint32_t operator()(const WideNode<W>& node, float tmax, float* entry) const {
    const D d;
    const int step = static_cast<int>(hn::Lanes(d));
    const float* const planes = node.planes[0];
    const auto limit = hn::Set(d, tmax);
    std::uint32_t hit = 0;
    for (int i = 0; i < W; i += step) {
      const auto x0 = hn::MulAdd(row(planes, entry_row_[0], i), rx_, entry_x_);
      const auto y0 = hn::MulAdd(row(planes, entry_row_[1], i), ry_, entry_y_);
      const auto z0 = hn::MulAdd(row(planes, entry_row_[2], i), rz_, entry_z_);
      const auto x1 = hn::MulAdd(row(planes, exit_row_[0], i), rx_, exit_x_);
      const auto y1 = hn::MulAdd(row(planes, exit_row_[1], i), ry_, exit_y_);
      const auto z1 = hn::MulAdd(row(planes, exit_row_[2], i), rz_, exit_z_);
      const auto near = hn::Max(hn::Max(x0, y0), hn::Max(z0, tmin_));
      const auto far = hn::Min(hn::Min(x1, y1), hn::Min(z1, limit));
      hn::Store(near, d, entry + i);
      hit |= static_cast<std::uint32_t>(mask_bits(d, hn::Le(near, far))) << i;
    }
    return hit;
  }

 private:
  using D = hn::CappedTag<float, W>;
  using V = hn::Vec<D>;
  /// Where a row takes several vectors its place is in bytes and as wide as an address: then a vector's place in its
  /// row is part of the load, else gcc makes a number of its own for each and keeps them all on the stack.
  static constexpr bool kSeveral = hn::MaxLanes(D()) < W;
  using Row = std::conditional_t<kSeveral, std::size_t, std::uint32_t>;
  static constexpr Row kRow = kSeveral ? W * sizeof(float) : W;
  static HWY_INLINE hn::Vec<D> row(const float* planes, Row row, int first) {
    if constexpr (kSeveral)
      return hn::Load(D(), reinterpret_cast<const float*>(reinterpret_cast<const char*>(planes) + row) + first);
    else
      return hn::Load(D(), planes + row + first);
  }

  V rx_, ry_, rz_, entry_x_, entry_y_, entry_z_, exit_x_, exit_y_, exit_z_, tmin_;
  Row entry_row_[3], exit_row_[3];  // from the first plane
};

/// A waiting child of a closest-hit query: entry distance in the high half, child word in the low half. Distances are
/// not negative, so their bits order like the numbers, and one integer comparison orders entries (equal distances by
/// word).
using StackEntry = std::uint64_t;
HWY_INLINE StackEntry make_entry(float near, std::uint32_t word) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(near)} << 32 | word;
}
HWY_INLINE float entry_distance(StackEntry e) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(e >> 32));
}

/// Puts two entries in order. Which one is nearer is a bad guess, so without a branch.
HWY_INLINE void order(StackEntry& nearer, StackEntry& farther) {
  const StackEntry change = (nearer ^ farther) & (StackEntry{0} - StackEntry{farther < nearer});
  nearer ^= change, farther ^= change;
}

/// Puts the children of `hit` on the stack, farthest first, but for the nearest, which is returned.
template <int W>
HWY_INLINE std::uint32_t push_children(const WideNode<W>& node, std::uint32_t hit, const float* entry,
                                       StackEntry*& top) {
  const int a = std::countr_zero(hit);
  hit &= hit - 1;
  if (HWY_LIKELY(!hit)) return node.child[a];
  const auto next_entry = [&] {
    const int i = std::countr_zero(hit);
    hit &= hit - 1;
    return make_entry(entry[i], node.child[i]);
  };
  StackEntry first = make_entry(entry[a], node.child[a]), second = next_entry();
  order(first, second);
  if (HWY_LIKELY(!hit)) {
    *top++ = second;
    return static_cast<std::uint32_t>(first);
  }
  StackEntry third = next_entry();
  order(second, third);
  order(first, second);
  StackEntry* const base = top;
  top[0] = third, top[1] = second;
  top += 2;
  if (!hit) return static_cast<std::uint32_t>(first);
  *top++ = first;
  while (hit) {
    const StackEntry e = next_entry();
    StackEntry* place = top++;
    for (; place != base && place[-1] < e; --place) place[0] = place[-1];
    *place = e;
  }
  return static_cast<std::uint32_t>(*--top);
}

/// Tests the blocks of a leaf, two at a time where vectors hold two: how many there are is a bad guess, and but for
/// leaves of one block pairs ask half as often. An odd block at the end is tested beside itself.
template <class Leaf, bool kRobust, bool kAny>
HWY_INLINE void test_leaf(const typename Leaf::Block* block, const typename Leaf::Block* end, const RaySetup& ray,
                          Best<Leaf>& best) {
#if HWY_MAX_BYTES >= 32
  if constexpr (Leaf::kPairs) {
    if (block + 1 == end) return Leaf::template one<kRobust, kAny>(*block, ray, best);
    do {
      Leaf::template two<kRobust, kAny>(*block, *std::min(block + 1, end - 1), ray, best);
      if (kAny && best.block) return;
    } while ((block += 2) < end);
    return;
  }
#endif
  do {
    Leaf::template one<kRobust, kAny>(*block, ray, best);
    if (kAny && best.block) return;
  } while (++block != end);
}

template <class Block>
HWY_INLINE void count_leaf(const Block* block, const Block* end, Counts& counts) {
  ++counts.leaves;
  for (; block != end; ++block)
    for (std::uint32_t id : block->primitive) counts.primitives += id != layouts::kInvalidPrimitive;
}

template <int W, class Leaf, bool kRobust, bool kCount>
HWY_INLINE bool traverse_closest(const Layout& layout, const RaySetup& ray, StackEntry* const stack, StackEntry* top,
                                 std::uint32_t word, Best<Leaf>& best, Counts* counts) {
  using Block = typename Leaf::Block;
  const auto* const nodes = reinterpret_cast<const WideNode<W>*>(layout.nodes.data());
  const auto* const blocks = reinterpret_cast<const Block*>(layout.triangles.data());
  const BoxTest<W> test(ray);
  alignas(64) float entry[W];
  for (;;) {
    std::uint32_t hit = 1;
    while (!(word & layouts::kLeafBit)) {
      const WideNode<W>& node = nodes[word];
      if constexpr (kCount) ++counts->nodes;
      hit = test(node, best.t, entry);
      if (!hit) break;
      word = push_children<W>(node, hit, entry, top);
    }
    if (hit) {
      const Block* const block = blocks + layouts::leaf_first(word);
      const Block* const end = block + layouts::leaf_blocks(word);
      if constexpr (kCount) count_leaf(block, end, *counts);
      test_leaf<Leaf, kRobust, false>(block, end, ray, best);
    }
    do {
      if (top == stack) return best.block != nullptr;
      --top;
    } while (entry_distance(*top) > best.t);
    word = static_cast<std::uint32_t>(*top);
  }
}

/// Children stand in the order in which they are worth trying (see layouts/wide.cpp), and no hit ends the ray but the
/// last, so distances are of no use: a node's hits stay the bits they are, and what waits on the stack is a node with
/// the children of it that are left.
template <int W, class Leaf, bool kRobust, bool kCount>
HWY_INLINE bool traverse_any(const Layout& layout, const RaySetup& ray, StackEntry* const stack, StackEntry* top,
                             std::uint32_t word, Best<Leaf>& best, Counts* counts) {
  using Block = typename Leaf::Block;
  const auto* const nodes = reinterpret_cast<const WideNode<W>*>(layout.nodes.data());
  const auto* const blocks = reinterpret_cast<const Block*>(layout.triangles.data());
  const BoxTest<W> test(ray);
  std::uint32_t node = 0, left = 0;  // `left`: children of `node` still to be tried
  alignas(64) float entry[W];
  for (;;) {
    if (word & layouts::kLeafBit) {
      const Block* const block = blocks + layouts::leaf_first(word);
      const Block* const end = block + layouts::leaf_blocks(word);
      if constexpr (kCount) count_leaf(block, end, *counts);
      test_leaf<Leaf, kRobust, true>(block, end, ray, best);
      if (best.block) return true;
    } else {
      if constexpr (kCount) ++counts->nodes;
      if (const std::uint32_t hit = test(nodes[word], best.t, entry)) {
        *top = StackEntry{node} << 32 | left;
        top += left != 0;
        node = word;
        left = hit;
      }
    }
    if (!left) {
      if (top == stack) return false;
      --top;
      node = static_cast<std::uint32_t>(*top >> 32);
      left = static_cast<std::uint32_t>(*top);
    }
    word = nodes[node].child[std::countr_zero(left)];
    left &= left - 1;
  }
}

/// The stack of one call: on the machine's stack unless the tree is unusually deep.
class Stack {
 public:
  explicit Stack(std::size_t needed) {
    if (needed > kInlineStack) heap_ = std::make_unique_for_overwrite<StackEntry[]>(needed);
  }
  StackEntry* entries() { return heap_ ? heap_.get() : inline_; }

 private:
  StackEntry inline_[kInlineStack];
  std::unique_ptr<StackEntry[]> heap_;
};

/// Runs one ray with a stack that is large enough and reports through `done(best, setup)`.
template <int W, class Leaf, bool kRobust, bool kAny, bool kCount>
HWY_INLINE bool trace(const Layout& layout, const Ray& ray, RaySetup& setup, Best<Leaf>& best, Stack& stack,
                      Counts* counts) {
  if constexpr (kCount) counts->rays = 1;
  if (layout.root == layouts::kNoRoot || !set_up_ray<kRobust>(ray, layout.bounds, setup)) return false;
  best.t = setup.tmax;
  StackEntry* const entries = stack.entries();
  bool hit;
  if constexpr (kAny)
    hit = traverse_any<W, Leaf, kRobust, kCount>(layout, setup, entries, entries, layout.root, best, counts);
  else
    hit = traverse_closest<W, Leaf, kRobust, kCount>(layout, setup, entries, entries, layout.root, best, counts);
  if constexpr (kCount) counts->hits = hit;
  return hit;
}

template <class Leaf>
HWY_INLINE Hit make_hit(const RaySetup& ray, const Best<Leaf>& best) {
  return {best.t * ray.t_scale, static_cast<float>(best.u / best.sum), static_cast<float>(best.v / best.sum),
          best.primitive};
}

template <int W, class Leaf, bool kRobust, bool kCount>
void closest(const Layout& layout, const Ray* rays, std::size_t count, Hit* hits, Vec3* normals, Counts* per_ray) {
  Stack stack(layout.max_stack + W);
  for (std::size_t i = 0; i < count; ++i) {
    RaySetup setup;
    Best<Leaf> best;
    if constexpr (kCount) per_ray[i] = {};
    const bool hit =
        trace<W, Leaf, kRobust, false, kCount>(layout, rays[i], setup, best, stack, kCount ? per_ray + i : nullptr);
    hits[i] = hit ? make_hit(setup, best) : Hit{};
    if (!normals) continue;
    normals[i] = {};
    if (!hit) continue;
    normals[i] = triangle_of<Leaf>(*best.block, best.lane).normal();
  }
}

template <int W, class Leaf, bool kRobust, bool kCount>
void any(const Layout& layout, const Ray* rays, std::size_t count, std::uint8_t* occluded, Counts* per_ray) {
  Stack stack(layout.max_stack + W);
  for (std::size_t i = 0; i < count; ++i) {
    RaySetup setup;
    Best<Leaf> best;
    if constexpr (kCount) per_ray[i] = {};
    occluded[i] =
        trace<W, Leaf, kRobust, true, kCount>(layout, rays[i], setup, best, stack, kCount ? per_ray + i : nullptr);
  }
}

template <int W, class Leaf, bool kRobust>
Kernels make_kernels() {
  return {
      [](const Layout& l, const Ray* r, std::size_t n, Hit* h, Vec3* normals) {
        closest<W, Leaf, kRobust, false>(l, r, n, h, normals, nullptr);
      },
      [](const Layout& l, const Ray* r, std::size_t n, std::uint8_t* o) {
        any<W, Leaf, kRobust, false>(l, r, n, o, nullptr);
      },
      [](const Layout& l, const Ray* r, std::size_t n, Hit* h, Counts* c) {
        closest<W, Leaf, kRobust, true>(l, r, n, h, nullptr, c);
      },
      [](const Layout& l, const Ray* r, std::size_t n, std::uint8_t* o, Counts* c) {
        any<W, Leaf, kRobust, true>(l, r, n, o, c);
      },
  };
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
