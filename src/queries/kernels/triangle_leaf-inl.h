// The triangle tests of wide layouts' leaves: a block of four triangles at a time in either mode, and what becomes of
// those that are hit. Compiled once per instruction set by the sources that include it; no include guard of the usual
// kind for that reason.
#if defined(BOXWOOD_QUERIES_KERNELS_TRIANGLE_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_TRIANGLE_LEAF_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_TRIANGLE_LEAF_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_TRIANGLE_LEAF_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "boxwood/queries.h"
#include "queries/triangle_test.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using layouts::TriangleBlock;

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

/// Lanes in which all numbers have one sign. NaN lanes are out.
template <class D, class V>
HWY_INLINE auto same_sign(D d, V u, V v, V w) {
  const auto zero = hn::Zero(d);
  return hn::Or(hn::Ge(hn::Min(hn::Min(u, v), w), zero), hn::Le(hn::Max(hn::Max(u, v), w), zero));
}
template <class D, class V>
HWY_INLINE auto same_sign(D d, V u, V v, V w, V x) {
  const auto zero = hn::Zero(d);
  return hn::Or(hn::Ge(hn::Min(hn::Min(u, v), hn::Min(w, x)), zero),
                hn::Le(hn::Max(hn::Max(u, v), hn::Max(w, x)), zero));
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

/// Where the lanes of a vector stand: in one block, from a lane on.
template <class Block>
struct BlockLanes {
  const Block* own;
  int first_lane;
  HWY_INLINE const Block& block(int) const { return *own; }
  HWY_INLINE int lane(int i) const { return first_lane + i; }
};

/// The same for eight lanes of two blocks of four. The second may be the first once more: a triangle is no better a hit
/// than itself.
template <class Block>
struct PairLanes {
  const Block *low, *high;
  HWY_INLINE const Block& block(int i) const { return i < 4 ? *low : *high; }
  HWY_INLINE int lane(int i) const { return i & 3; }
};

/// Hands the lanes of `mask` to `best`, lowest lane first. Any hit will do for `kAny`: there only best.block is set.
template <class Leaf, bool kAny, class At, class D, class V>
HWY_INLINE void offer_lanes(D d, std::uint64_t mask, V t, V u, V v, const At& at, const RaySetup& ray,
                            Best<Leaf>& best) {
  mask &= mask_bits(d, hn::And(hn::Ge(t, hn::Set(d, ray.tmin)), hn::Le(t, hn::Set(d, best.t))));
  if (!mask) return;
  if constexpr (kAny) {
    best.block = &at.block(0);
    return;
  }
  alignas(64) float ts[8], us[8], vs[8];
  hn::Store(t, d, ts);
  hn::Store(u, d, us);
  hn::Store(v, d, vs);
  for (; mask; mask &= mask - 1) {
    const int i = std::countr_zero(mask);
    const auto& block = at.block(i);
    const std::uint32_t id = Leaf::primitive(block, at.lane(i));
    if (best.takes(ts[i], ray.tmin, id)) best = {ts[i], id, &block, at.lane(i), us[i], vs[i], 1};
  }
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

/// Takes a triangle that single precision has found hit, or can't decide on, for the best hit if it is nearer. The
/// class Location of triangle_test.h, with one vector for the three corners.
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
  // Where all three have one sign there is nothing to clamp, and the sign itself cancels out.
  const std::uint64_t positive = mask_bits(dd, hn::Gt(edges, hn::Zero(dd))) & 7;
  const std::uint64_t negative = mask_bits(dd, hn::Lt(edges, hn::Zero(dd))) & 7;
  if (HWY_UNLIKELY(std::max(positive, negative) != 7))  // one question: which of the two it is is a bad guess
    return consider_with_care<Leaf>(block, lane, doubtful, ray, best);
  const double sum = sum_of_three(edges);
  const auto t = static_cast<float>(sum_of_three(hn::Mul(edges, z)) / (sum * ray.direction[ray.kz])) + 0.0f;
  const std::uint32_t id = Leaf::primitive(block, lane);
  if (!best.takes(t, ray.tmin, id)) return;
  const auto low = hn::LowerHalf(half, edges);
  best = {t, id, &block, lane, hn::GetLane(hn::Shuffle01(low)), hn::GetLane(hn::UpperHalf(half, edges)), sum};
#endif
}

/// The robust test from the edge functions on: u, v and w of the corners a, b and c, with any sign common to all three,
/// and the corners' distances along the ray's main axis.
template <class Leaf, bool kAny, class At, class D, class V>
HWY_INLINE void robust_lanes(D d, V u, V v, V w, V az, V bz, V cz, const At& at, const RaySetup& ray,
                             Best<Leaf>& best) {
  const auto tiny = hn::Le(hn::Min(hn::Min(hn::Abs(u), hn::Abs(v)), hn::Abs(w)), hn::Set(d, kTinyEdgeFunction));
  const std::uint64_t doubtful = mask_bits(d, tiny);
  const std::uint64_t found = mask_bits(d, same_sign(d, u, v, w)) | doubtful;
  if (HWY_LIKELY(!found)) return;
  // A hit is no nearer than the nearest corner, so a triangle that lies behind the best hit as a whole is left out.
  const auto scale = hn::Set(d, ray.inverse_z);
  const auto nearest = hn::Min(hn::Min(hn::Mul(az, scale), hn::Mul(bz, scale)), hn::Mul(cz, scale));
  const auto limit = hn::Set(d, best.t * (1 + 8 * 0x1p-24f));
  std::uint64_t mask = found & mask_bits(d, hn::Le(nearest, limit)) & Leaf::used(d, at);
  if (!mask) return;
  if constexpr (kAny) {
    // And one that lies between tmin and tmax as a whole is hit, wherever exactly.
    const auto farthest = hn::Max(hn::Max(hn::Mul(az, scale), hn::Mul(bz, scale)), hn::Mul(cz, scale));
    const auto within = hn::And(hn::Gt(nearest, hn::Set(d, ray.tmin * (1 + 8 * 0x1p-24f))),
                                hn::Lt(farthest, hn::Set(d, ray.tmax * (1 - 8 * 0x1p-24f))));
    if (const std::uint64_t sure = mask & ~doubtful & mask_bits(d, within)) {
      best.block = &at.block(0);
      return;
    }
  }
  for (; mask; mask &= mask - 1) {
    const int i = std::countr_zero(mask);
    consider<Leaf>(at.block(i), at.lane(i), doubtful >> i & 1, ray, best);
  }
}

template <class D, class V>
HWY_INLINE V dot_without_fusing(D, V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

/// The fast test on triangles given by their first corner and the edges from there to the second and the third. That a
/// hit lies in front of the origin is asked by its sign, before the branch: most rays start on a triangle, whose plane
/// they meet right behind them, and that one would be a bad guess.
template <class Leaf, bool kAny, class At, class D, class V>
HWY_INLINE void fast_lanes(D d, V v0x, V v0y, V v0z, V e1x, V e1y, V e1z, V e2x, V e2y, V e2z, const At& at,
                           const RaySetup& ray, Best<Leaf>& best) {
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
  const auto along = dot_without_fusing(d, e2x, e2y, e2z, qx, qy, qz);
  const std::uint64_t inside = mask_bits(d, hn::And(same_sign(d, u, v, w, along), hn::Ne(determinant, hn::Zero(d))));
  if (HWY_LIKELY(!inside)) return;
  const std::uint64_t mask = inside & Leaf::used(d, at);
  if (!mask) return;
  const auto r = hn::Div(hn::Set(d, 1.0f), determinant);
  const auto t = hn::Mul(along, r);
  offer_lanes<Leaf, kAny>(d, mask, t, hn::Mul(u, r), hn::Mul(v, r), at, ray, best);
}

/// What the traversal asks of a kind of leaf block; the other kind is in wide_quads-inl.h.
struct TriangleLeaf {
  using Block = TriangleBlock;
  /// Two blocks can be tested at once, with `two`.
  static constexpr bool kPairs = HWY_MAX_BYTES >= 32;

  static HWY_INLINE std::uint32_t primitive(const Block& block, int lane) { return block.primitive[lane]; }
  /// In the mesh's order.
  static HWY_INLINE CornerAt corner(const Block& block, int lane, int k) { return {block.corner[k][0] + lane, 4}; }
  /// Lanes that hold a triangle, where the tests alone can't be trusted to pass over those that don't.
  template <class D, class At>
  static HWY_INLINE std::uint64_t used(D, const At&) {
    return ~std::uint64_t{0};
  }

  template <class D>
  static HWY_INLINE auto load(D d, const BlockLanes<Block>& at, int k, int axis) {
    return hn::Load(d, at.own->corner[k][axis] + at.first_lane);
  }
#if HWY_MAX_BYTES >= 32
  template <class D>
  static HWY_INLINE auto load(D d, const PairLanes<Block>& at, int k, int axis) {
    const hn::Half<D> half;
    return hn::Combine(d, hn::Load(half, at.high->corner[k][axis]), hn::Load(half, at.low->corner[k][axis]));
  }
#endif

  template <bool kRobust, bool kAny, class D, class At>
  static HWY_INLINE void test(D d, const At& at, const RaySetup& ray, Best<TriangleLeaf>& best) {
    if constexpr (kRobust) {
      const auto shear_x = hn::Set(d, ray.shear_x), shear_y = hn::Set(d, ray.shear_y);
      const auto relative = [&](int k, int axis)
                                HWY_ATTR { return hn::Sub(load(d, at, k, axis), hn::Set(d, ray.origin[axis])); };
      const auto az = relative(0, ray.kz), bz = relative(1, ray.kz), cz = relative(2, ray.kz);
      const auto ax = hn::Sub(relative(0, ray.kx), hn::Mul(shear_x, az));
      const auto bx = hn::Sub(relative(1, ray.kx), hn::Mul(shear_x, bz));
      const auto cx = hn::Sub(relative(2, ray.kx), hn::Mul(shear_x, cz));
      const auto ay = hn::Sub(relative(0, ray.ky), hn::Mul(shear_y, az));
      const auto by = hn::Sub(relative(1, ray.ky), hn::Mul(shear_y, bz));
      const auto cy = hn::Sub(relative(2, ray.ky), hn::Mul(shear_y, cz));
      const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
      const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
      const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
      robust_lanes<TriangleLeaf, kAny>(d, u, v, w, az, bz, cz, at, ray, best);
    } else {
      const auto row = [&](int k, int axis) HWY_ATTR { return load(d, at, k, axis); };
      const auto x = row(0, 0), y = row(0, 1), z = row(0, 2);
      fast_lanes<TriangleLeaf, kAny>(d, x, y, z, hn::Sub(row(1, 0), x), hn::Sub(row(1, 1), y), hn::Sub(row(1, 2), z),
                                     hn::Sub(row(2, 0), x), hn::Sub(row(2, 1), y), hn::Sub(row(2, 2), z), at, ray,
                                     best);
    }
  }

  template <bool kRobust, bool kAny>
  static HWY_INLINE void one(const Block& block, const RaySetup& ray, Best<TriangleLeaf>& best) {
    const hn::CappedTag<float, 4> d;
    const int step = static_cast<int>(hn::Lanes(d));
    for (int lane = 0; lane < 4; lane += step) {
      test<kRobust, kAny>(d, BlockLanes<Block>{&block, lane}, ray, best);
      if (kAny && best.block) return;
    }
  }
  template <bool kRobust, bool kAny>
  static HWY_INLINE void two(const Block& low, const Block& high, const RaySetup& ray, Best<TriangleLeaf>& best) {
    test<kRobust, kAny>(hn::CappedTag<float, 8>(), PairLanes<Block>{&low, &high}, ray, best);
  }
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
