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

#include <bit>
#include <memory>

#include "boxwood/queries.h"
#include "queries/kernels/ray_setup-inl.h"
#include "queries/triangle_test.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using layouts::Layout;
using layouts::TriangleBlock;
using layouts::WideNode;

/// Entries a traversal keeps on the machine's stack; a tree that needs more gets them from the heap.
inline constexpr std::size_t kInlineStack = 256;

/// The best hit so far, with where its triangle stands. u and v are kept times `sum`.
template <class Leaf>
struct Best {
  float t;
  std::uint32_t primitive = layouts::kInvalidPrimitive;
  const typename Leaf::Block* block = nullptr;
  int lane = 0;
  double u = 0, v = 0, sum = 1;

  HWY_INLINE bool takes(float hit_t, float tmin, std::uint32_t id) const {
    return hit_t >= tmin && (hit_t < t || (hit_t == t && id < primitive));
  }
};

/// Lanes whose edge functions u, v, w have one sign. NaN lanes are out.
template <class D, class V>
HWY_INLINE auto same_sign(D d, V u, V v, V w) {
  const auto zero = hn::Zero(d);
  return hn::Or(hn::Ge(hn::Min(hn::Min(u, v), w), zero), hn::Le(hn::Max(hn::Max(u, v), w), zero));
}

/// Hands the lanes of `mask` to `best`, lowest lane first.
template <class Leaf, class D, class V>
HWY_INLINE void offer_lanes(D d, std::uint64_t mask, V t, V u, V v, const typename Leaf::Block& block, int first_lane,
                            const RaySetup& ray, Best<Leaf>& best) {
  alignas(64) float ts[8], us[8], vs[8];
  hn::Store(t, d, ts);
  hn::Store(u, d, us);
  hn::Store(v, d, vs);
  for (; mask; mask &= mask - 1) {
    const int lane = std::countr_zero(mask);
    const std::uint32_t id = Leaf::primitive(block, first_lane + lane);
    if (best.takes(ts[lane], ray.tmin, id)) best = {ts[lane], id, &block, first_lane + lane, us[lane], vs[lane], 1};
  }
}

/// The mask's bits, of up to 16 lanes.
template <class D>
HWY_INLINE std::uint64_t mask_bits(D d, hn::Mask<D> mask) {
  alignas(8) std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  if (hn::Lanes(d) <= 8) return bytes[0] & ((1u << hn::Lanes(d)) - 1);
  std::uint16_t two;  // read at once: put together from bytes it would lengthen each step by some cycles
  std::memcpy(&two, bytes, sizeof two);
  return two;
}

/// A corner in a block of planes: its coordinates are `stride` floats apart.
struct CornerAt {
  const float* x;
  int stride;
  HWY_INLINE float operator[](int axis) const { return x[axis * stride]; }
};

template <class Leaf>
HWY_INLINE Triangle triangle_of(const typename Leaf::Block& block, int lane) {
  const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1), c = Leaf::corner(block, lane, 2);
  return {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}};
}

template <class Leaf>
HWY_INLINE PermutedTriangle permuted(const typename Leaf::Block& block, int lane, const RaySetup& ray) {
  const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1), c = Leaf::corner(block, lane, 2);
  return {{a[ray.kx], b[ray.kx], c[ray.kx]}, {a[ray.ky], b[ray.ky], c[ray.ky]}, {a[ray.kz], b[ray.kz], c[ray.kz]}};
}

/// What consider does with the triangles that vectors don't decide: kept out of line, they are few.
template <class Leaf>
HWY_NOINLINE void consider_with_care(const typename Leaf::Block& block, int lane, bool doubtful, const RaySetup& ray,
                                     Best<Leaf>& best) {
  const PermutedTriangle triangle = permuted<Leaf>(block, lane, ray);
  ShearedTriangle sheared;
  if (doubtful && !robust_test(triangle, ray, sheared)) return;
  const Location at(triangle, ray);
  const std::uint32_t id = Leaf::primitive(block, lane);
  if (best.takes(at.t(), ray.tmin, id)) best = {at.t(), id, &block, lane, at.u_times_sum(), at.v_times_sum(), at.sum()};
}

/// Takes a triangle that single precision has found hit, or can't decide on, for the best hit if it is nearer. The class
/// Location of triangle_test.h, with one vector for the three corners.
template <class Leaf>
HWY_INLINE void consider(const typename Leaf::Block& block, int lane, bool doubtful, const RaySetup& ray,
                         Best<Leaf>& best) {
#if HWY_MAX_BYTES < 32
  consider_with_care<Leaf>(block, lane, doubtful, ray, best);
#else
  if (HWY_UNLIKELY(doubtful)) return consider_with_care<Leaf>(block, lane, doubtful, ray, best);
  using Floats = hn::FixedTag<float, 4>;
  using Doubles = hn::FixedTag<double, 4>;
  const Floats d;
  const Doubles dd;
  const hn::Half<Doubles> half;
  const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1), c = Leaf::corner(block, lane, 2);
  const auto relative = [&](int axis) HWY_ATTR {
    const auto ab = hn::InterleaveLower(hn::Set(d, a[axis]), hn::Set(d, b[axis]));
    const auto corners = hn::PromoteTo(dd, hn::ConcatLowerLower(d, hn::Set(d, c[axis]), ab));
    return hn::Sub(corners, hn::Set(dd, static_cast<double>(ray.origin[axis])));
  };
  const auto z = relative(ray.kz);
  const auto x = hn::Sub(relative(ray.kx), hn::Mul(hn::Set(dd, ray.exact_shear_x), z));
  const auto y = hn::Sub(relative(ray.ky), hn::Mul(hn::Set(dd, ray.exact_shear_y), z));
  alignas(32) static constexpr std::int64_t kBefore[4] = {2, 0, 1, 1}, kBehind[4] = {1, 2, 0, 0};
  const auto before = hn::SetTableIndices(dd, kBefore), behind = hn::SetTableIndices(dd, kBehind);
  const auto edges = hn::Sub(hn::Mul(hn::TableLookupLanes(x, before), hn::TableLookupLanes(y, behind)),
                             hn::Mul(hn::TableLookupLanes(y, before), hn::TableLookupLanes(x, behind)));
  const auto sum_of_three = [&](auto v) HWY_ATTR {
    const auto low = hn::LowerHalf(half, v);
    return hn::GetLane(low) + hn::GetLane(hn::Shuffle01(low)) + hn::GetLane(hn::UpperHalf(half, v));
  };
  const auto sign = hn::CopySign(hn::Set(dd, 1.0), hn::Set(dd, sum_of_three(edges)));
  const auto weights = hn::Max(hn::Mul(edges, sign), hn::Zero(dd));
  const double sum = sum_of_three(weights);
  if (HWY_UNLIKELY(!(sum > 0))) return consider_with_care<Leaf>(block, lane, doubtful, ray, best);
  const auto t = static_cast<float>(sum_of_three(hn::Mul(weights, z)) / (sum * ray.direction[ray.kz]));
  const std::uint32_t id = Leaf::primitive(block, lane);
  if (!best.takes(t, ray.tmin, id)) return;
  const auto low = hn::LowerHalf(half, weights);
  best = {t, id, &block, lane, hn::GetLane(hn::Shuffle01(low)), hn::GetLane(hn::UpperHalf(half, weights)), sum};
#endif
}

/// The robust test from the edge functions on: u, v and w of the corners a, b and c, with any sign common to all three,
/// and the corners' distances along the ray's main axis.
template <class Leaf, bool kAny, class D, class V>
HWY_INLINE void robust_lanes(D d, V u, V v, V w, V az, V bz, V cz, const typename Leaf::Block& block, int first_lane,
                             const RaySetup& ray, Best<Leaf>& best) {
  const auto tiny = hn::Le(hn::Min(hn::Min(hn::Abs(u), hn::Abs(v)), hn::Abs(w)), hn::Set(d, kTinyEdgeFunction));
  const std::uint64_t doubtful = mask_bits(d, tiny);
  const std::uint64_t found = mask_bits(d, same_sign(d, u, v, w)) | doubtful;
  if (HWY_LIKELY(!found)) return;
  // A hit is no nearer than the nearest corner, so a triangle that lies behind the best hit as a whole is left out.
  const auto scale = hn::Set(d, ray.inverse_z);
  const auto nearest = hn::Min(hn::Min(hn::Mul(az, scale), hn::Mul(bz, scale)), hn::Mul(cz, scale));
  const auto limit = hn::Set(d, best.t * (1 + 8 * 0x1p-24f));
  std::uint64_t mask = found & mask_bits(d, hn::Le(nearest, limit)) & Leaf::used(d, block, first_lane);
  if (!mask) return;
  if constexpr (kAny) {
    // And one that lies between tmin and tmax as a whole is hit, wherever exactly.
    const auto farthest = hn::Max(hn::Max(hn::Mul(az, scale), hn::Mul(bz, scale)), hn::Mul(cz, scale));
    const auto within = hn::And(hn::Gt(nearest, hn::Set(d, ray.tmin * (1 + 8 * 0x1p-24f))),
                                hn::Lt(farthest, hn::Set(d, ray.tmax * (1 - 8 * 0x1p-24f))));
    if (const std::uint64_t sure = mask & ~doubtful & mask_bits(d, within)) {
      best.block = &block;
      return;
    }
  }
  for (; mask; mask &= mask - 1) {
    const int i = std::countr_zero(mask);
    consider<Leaf>(block, first_lane + i, doubtful >> i & 1, ray, best);
  }
}

template <class D, class V>
HWY_INLINE V dot_without_fusing(D, V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

/// The fast test on triangles given by their first corner and the edges from there to the second and the third.
template <class Leaf, class D, class V>
HWY_INLINE void fast_lanes(D d, V v0x, V v0y, V v0z, V e1x, V e1y, V e1z, V e2x, V e2y, V e2z,
                           const typename Leaf::Block& block, int first_lane, const RaySetup& ray, Best<Leaf>& best) {
  const auto dx = hn::Set(d, ray.direction[0]), dy = hn::Set(d, ray.direction[1]), dz = hn::Set(d, ray.direction[2]);
  const auto px = hn::Sub(hn::Mul(dy, e2z), hn::Mul(dz, e2y));
  const auto py = hn::Sub(hn::Mul(dz, e2x), hn::Mul(dx, e2z));
  const auto pz = hn::Sub(hn::Mul(dx, e2y), hn::Mul(dy, e2x));
  const auto determinant = dot_without_fusing(d, e1x, e1y, e1z, px, py, pz);
  const auto sx = hn::Sub(hn::Set(d, ray.origin[0]), v0x);
  const auto sy = hn::Sub(hn::Set(d, ray.origin[1]), v0y);
  const auto sz = hn::Sub(hn::Set(d, ray.origin[2]), v0z);
  const auto qx = hn::Sub(hn::Mul(sy, e1z), hn::Mul(sz, e1y));
  const auto qy = hn::Sub(hn::Mul(sz, e1x), hn::Mul(sx, e1z));
  const auto qz = hn::Sub(hn::Mul(sx, e1y), hn::Mul(sy, e1x));
  const auto u = dot_without_fusing(d, sx, sy, sz, px, py, pz);
  const auto v = dot_without_fusing(d, dx, dy, dz, qx, qy, qz);
  const auto w = hn::Sub(hn::Sub(determinant, u), v);
  const std::uint64_t inside = mask_bits(d, hn::And(same_sign(d, u, v, w), hn::Ne(determinant, hn::Zero(d))));
  if (HWY_LIKELY(!inside)) return;
  const std::uint64_t mask = inside & Leaf::used(d, block, first_lane);
  if (!mask) return;
  const auto r = hn::Div(hn::Set(d, 1.0f), determinant);
  const auto t = hn::Mul(dot_without_fusing(d, e2x, e2y, e2z, qx, qy, qz), r);
  offer_lanes<Leaf>(d, mask, t, hn::Mul(u, r), hn::Mul(v, r), block, first_lane, ray, best);
}

/// What the traversal asks of a kind of leaf block; the other kind is in wide_quads-inl.h.
struct TriangleLeaf {
  using Block = TriangleBlock;

  static HWY_INLINE std::uint32_t primitive(const Block& block, int lane) { return block.primitive[lane]; }
  /// In the mesh's order.
  static HWY_INLINE CornerAt corner(const Block& block, int lane, int k) { return {block.corner[k][0] + lane, 4}; }
  /// Lanes that hold a triangle, where the tests alone can't be trusted to pass over those that don't.
  template <class D>
  static HWY_INLINE std::uint64_t used(D, const Block&, int) {
    return ~std::uint64_t{0};
  }

  template <class D>
  static HWY_INLINE auto load_relative(D d, const Block& block, int k, int axis, int lane, const RaySetup& ray) {
    return hn::Sub(hn::Load(d, block.corner[k][axis] + lane), hn::Set(d, ray.origin[axis]));
  }

  template <bool kAny>
  static HWY_INLINE void robust(const Block& block, const RaySetup& ray, Best<TriangleLeaf>& best) {
    const hn::CappedTag<float, 4> d;
    const int step = static_cast<int>(hn::Lanes(d));
    const auto shear_x = hn::Set(d, ray.shear_x), shear_y = hn::Set(d, ray.shear_y);
    for (int lane = 0; lane < 4; lane += step) {
      const auto az = load_relative(d, block, 0, ray.kz, lane, ray);
      const auto bz = load_relative(d, block, 1, ray.kz, lane, ray);
      const auto cz = load_relative(d, block, 2, ray.kz, lane, ray);
      const auto ax = hn::Sub(load_relative(d, block, 0, ray.kx, lane, ray), hn::Mul(shear_x, az));
      const auto bx = hn::Sub(load_relative(d, block, 1, ray.kx, lane, ray), hn::Mul(shear_x, bz));
      const auto cx = hn::Sub(load_relative(d, block, 2, ray.kx, lane, ray), hn::Mul(shear_x, cz));
      const auto ay = hn::Sub(load_relative(d, block, 0, ray.ky, lane, ray), hn::Mul(shear_y, az));
      const auto by = hn::Sub(load_relative(d, block, 1, ray.ky, lane, ray), hn::Mul(shear_y, bz));
      const auto cy = hn::Sub(load_relative(d, block, 2, ray.ky, lane, ray), hn::Mul(shear_y, cz));
      const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
      const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
      const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
      robust_lanes<TriangleLeaf, kAny>(d, u, v, w, az, bz, cz, block, lane, ray, best);
      if (kAny && best.block) return;
    }
  }

  template <class D>
  static HWY_INLINE auto edge(D d, const Block& block, int k, int axis, int lane) {
    return hn::Sub(hn::Load(d, block.corner[k][axis] + lane), hn::Load(d, block.corner[0][axis] + lane));
  }

  static HWY_INLINE void fast(const Block& block, const RaySetup& ray, Best<TriangleLeaf>& best) {
    const hn::CappedTag<float, 4> d;
    const int step = static_cast<int>(hn::Lanes(d));
    for (int lane = 0; lane < 4; lane += step) {
      const auto e1x = edge(d, block, 1, 0, lane), e1y = edge(d, block, 1, 1, lane), e1z = edge(d, block, 1, 2, lane);
      const auto e2x = edge(d, block, 2, 0, lane), e2y = edge(d, block, 2, 1, lane), e2z = edge(d, block, 2, 2, lane);
      fast_lanes<TriangleLeaf>(d, hn::Load(d, block.corner[0][0] + lane), hn::Load(d, block.corner[0][1] + lane),
                               hn::Load(d, block.corner[0][2] + lane), e1x, e1y, e1z, e2x, e2y, e2z, block, lane, ray,
                               best);
    }
  }
};

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
      entry_row_[axis] = static_cast<std::uint32_t>(ray.entry_plane[axis] * W);
      exit_row_[axis] = static_cast<std::uint32_t>(ray.exit_plane[axis] * W);
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
      const auto x0 = hn::MulAdd(hn::Load(d, planes + entry_row_[0] + i), rx_, entry_x_);
      const auto y0 = hn::MulAdd(hn::Load(d, planes + entry_row_[1] + i), ry_, entry_y_);
      const auto z0 = hn::MulAdd(hn::Load(d, planes + entry_row_[2] + i), rz_, entry_z_);
      const auto x1 = hn::MulAdd(hn::Load(d, planes + exit_row_[0] + i), rx_, exit_x_);
      const auto y1 = hn::MulAdd(hn::Load(d, planes + exit_row_[1] + i), ry_, exit_y_);
      const auto z1 = hn::MulAdd(hn::Load(d, planes + exit_row_[2] + i), rz_, exit_z_);
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
  V rx_, ry_, rz_, entry_x_, entry_y_, entry_z_, exit_x_, exit_y_, exit_z_, tmin_;
  std::uint32_t entry_row_[3], exit_row_[3];  // floats from the first plane
};

/// A waiting child: entry distance in the high half, child word in the low half. Distances are not negative, so their
/// bits order like the numbers, and one integer comparison orders entries (equal distances by word).
using StackEntry = std::uint64_t;
HWY_INLINE StackEntry make_entry(float near, std::uint32_t word) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(near)} << 32 | word;
}
HWY_INLINE float entry_distance(StackEntry e) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(e >> 32));
}

/// Puts the children of `hit` on the stack, farthest first, and takes the nearest off again.
template <int W, bool kAny>
HWY_INLINE std::uint32_t push_children(const WideNode<W>& node, std::uint32_t hit, const float* entry,
                                       StackEntry*& top) {
  const int a = std::countr_zero(hit);
  hit &= hit - 1;
  if (HWY_LIKELY(!hit)) return node.child[a];
  if constexpr (kAny) {
    // Children stand in the order in which they are worth trying (see layouts/wide.cpp): the last goes deepest.
    while (hit) {
      const int i = 31 - std::countl_zero(hit);
      hit ^= 1u << i;
      *top++ = node.child[i];  // no hit ends the ray but the last, so distances are of no use
    }
    return node.child[a];
  }
  const int b = std::countr_zero(hit);
  hit &= hit - 1;
  StackEntry first = make_entry(entry[a], node.child[a]), second = make_entry(entry[b], node.child[b]);
  if (second < first) std::swap(first, second);
  if (HWY_LIKELY(!hit)) {
    *top++ = second;
    return static_cast<std::uint32_t>(first);
  }
  StackEntry* const base = top;
  *top++ = second;
  *top++ = first;
  for (; hit; hit &= hit - 1) {
    const int i = std::countr_zero(hit);
    const StackEntry e = make_entry(entry[i], node.child[i]);
    StackEntry* place = top++;
    for (; place != base && place[-1] < e; --place) place[0] = place[-1];
    *place = e;
  }
  return static_cast<std::uint32_t>(*--top);
}

template <class Leaf, bool kRobust, bool kAny>
HWY_INLINE void test_leaf(const typename Leaf::Block* block, const typename Leaf::Block* end, const RaySetup& ray,
                          Best<Leaf>& best) {
  do {
    if constexpr (kRobust)
      Leaf::template robust<kAny>(*block, ray, best);
    else
      Leaf::fast(*block, ray, best);
    if (kAny && best.block) return;
  } while (++block != end);
}

template <class Block>
HWY_INLINE void count_leaf(const Block* block, const Block* end, Counts& counts) {
  ++counts.leaves;
  for (; block != end; ++block)
    for (std::uint32_t id : block->primitive) counts.primitives += id != layouts::kInvalidPrimitive;
}

template <int W, class Leaf, bool kRobust, bool kAny, bool kCount>
HWY_INLINE bool traverse(const Layout& layout, const RaySetup& ray, StackEntry* const stack, Best<Leaf>& best,
                         Counts* counts) {
  const auto* const nodes = reinterpret_cast<const WideNode<W>*>(layout.nodes.data());
  using Block = typename Leaf::Block;
  const auto* const blocks = reinterpret_cast<const Block*>(layout.triangles.data());
  const BoxTest<W> test(ray);
  StackEntry* top = stack;
  std::uint32_t word = layout.root;
  alignas(64) float entry[W];
  for (;;) {
    std::uint32_t hit = 1;
    while (!(word & layouts::kLeafBit)) {
      const WideNode<W>& node = nodes[word];
      if constexpr (kCount) ++counts->nodes;
      hit = test(node, best.t, entry);
      if (!hit) break;
      word = push_children<W, kAny>(node, hit, entry, top);
    }
    if (hit) {
      const Block* const block = blocks + layouts::leaf_first(word);
      const Block* const end = block + layouts::leaf_blocks(word);
      if constexpr (kCount) count_leaf(block, end, *counts);
      test_leaf<Leaf, kRobust, kAny>(block, end, ray, best);
      if (kAny && best.block) return true;
    }
    do {
      if (top == stack) return best.block != nullptr;
      --top;
    } while (!kAny && entry_distance(*top) > best.t);
    word = static_cast<std::uint32_t>(*top);
  }
}

/// Runs one ray with a stack that is large enough and reports through `done(best, setup)`.
template <int W, class Leaf, bool kRobust, bool kAny, bool kCount>
HWY_INLINE bool trace(const Layout& layout, const Ray& ray, RaySetup& setup, Best<Leaf>& best, StackEntry* stack,
                      Counts* counts) {
  if constexpr (kCount) counts->rays = 1;
  if (layout.root == layouts::kNoRoot || !set_up_ray<kRobust>(ray, layout.bounds, setup)) return false;
  best.t = setup.tmax;
  const bool hit = traverse<W, Leaf, kRobust, kAny, kCount>(layout, setup, stack, best, counts);
  if constexpr (kCount) counts->hits = hit;
  return hit;
}

/// The stack of one call: on the machine's stack unless the tree is unusually deep.
class Stack {
 public:
  explicit Stack(std::size_t needed) {
    if (needed > kInlineStack) heap_ = std::make_unique_for_overwrite<StackEntry[]>(needed);
  }
  StackEntry* data() { return heap_ ? heap_.get() : inline_; }

 private:
  StackEntry inline_[kInlineStack];
  std::unique_ptr<StackEntry[]> heap_;
};

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
    const bool hit = trace<W, Leaf, kRobust, false, kCount>(layout, rays[i], setup, best, stack.data(),
                                                            kCount ? per_ray + i : nullptr);
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
    occluded[i] = trace<W, Leaf, kRobust, true, kCount>(layout, rays[i], setup, best, stack.data(),
                                                        kCount ? per_ray + i : nullptr);
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
