// Leaf blocks of quads for the traversal of wide-inl.h. A quad is two triangles that share an edge (Aman and Fenney
// 2023, bib key aman2023, as EBBVH takes it up, bib key ebbvh): corners b and c are the shared edge's, and each
// triangle has a corner a of its own. The edge's corners are moved into the ray's frame once and its edge function is
// computed once; both triangles use it with the sign it has, since the test asks only whether three signs are equal.
// With vectors of eight both triangles of four quads are tested in one go, with vectors of four one after the other.
//
// The answers are those of wide8 to the last bit: single precision decides about a hit by signs, which the order of a
// triangle's corners can't change, and where a hit is comes from the corners in the mesh's order. The fast test does
// depend on that order, so there the corners are brought into it first.
#if defined(BOXWOOD_QUERIES_KERNELS_WIDE_QUADS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_WIDE_QUADS_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_WIDE_QUADS_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_WIDE_QUADS_INL_H_
#endif

#include "queries/kernels/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

/// Lanes 0 to 3 are the first triangles of a block's quads, lanes 4 to 7 the second ones.
struct QuadLeaf {
  using Block = layouts::QuadBlock;
  static constexpr bool kPairs = false;  // eight lanes are full with one

  static HWY_INLINE std::uint32_t primitive(const Block& block, int lane) {
    return block.primitive[lane] & layouts::kQuadIdMask;
  }
  static HWY_INLINE CornerAt corner(const Block& block, int lane, int k) {
    const int place = layouts::quad_corner_place(block.primitive[lane], k);
    if (place == 0) return {block.apex[0] + lane, 8};
    return {block.edge[place - 1][0] + (lane & 3), 4};
  }
  /// A lone triangle's second half is NaN in its own corner only, and what a minimum of a number and NaN is differs
  /// between instruction sets.
  template <class D>
  static HWY_INLINE std::uint64_t used(D, const BlockLanes<Block>& at) {
    const hn::RebindToUnsigned<D> du;
    return mask_bits(du,
                     hn::Ne(hn::Load(du, at.own->primitive + at.first_lane), hn::Set(du, layouts::kInvalidPrimitive)));
  }

  template <bool kRobust, bool kAny>
  static HWY_INLINE void one(const Block& block, const RaySetup& ray, Best<QuadLeaf>& best) {
    if constexpr (kRobust)
      robust<kAny>(block, ray, best);
    else
      fast<kAny>(block, ray, best);
  }

  template <bool kAny>
  static HWY_INLINE void robust(const Block& block, const RaySetup& ray, Best<QuadLeaf>& best) {
    const hn::CappedTag<float, 8> d;
    const int step = static_cast<int>(hn::Lanes(d));
    const auto shear_x = hn::Set(d, ray.shear_x), shear_y = hn::Set(d, ray.shear_y);
    const auto ox = hn::Set(d, ray.origin[ray.kx]), oy = hn::Set(d, ray.origin[ray.ky]),
               oz = hn::Set(d, ray.origin[ray.kz]);
    for (int quad = 0; quad < 4; quad += step) {
      const auto bz = hn::Sub(hn::LoadDup128(d, block.edge[0][ray.kz] + quad), oz);
      const auto cz = hn::Sub(hn::LoadDup128(d, block.edge[1][ray.kz] + quad), oz);
      const auto bx = hn::Sub(hn::Sub(hn::LoadDup128(d, block.edge[0][ray.kx] + quad), ox), hn::Mul(shear_x, bz));
      const auto cx = hn::Sub(hn::Sub(hn::LoadDup128(d, block.edge[1][ray.kx] + quad), ox), hn::Mul(shear_x, cz));
      const auto by = hn::Sub(hn::Sub(hn::LoadDup128(d, block.edge[0][ray.ky] + quad), oy), hn::Mul(shear_y, bz));
      const auto cy = hn::Sub(hn::Sub(hn::LoadDup128(d, block.edge[1][ray.ky] + quad), oy), hn::Mul(shear_y, cz));
      const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
      for (int lane = quad; lane < 8; lane += step < 4 ? 4 : step) {
        const auto az = hn::Sub(hn::Load(d, block.apex[ray.kz] + lane), oz);
        const auto ax = hn::Sub(hn::Sub(hn::Load(d, block.apex[ray.kx] + lane), ox), hn::Mul(shear_x, az));
        const auto ay = hn::Sub(hn::Sub(hn::Load(d, block.apex[ray.ky] + lane), oy), hn::Mul(shear_y, az));
        const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
        const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
        robust_lanes<QuadLeaf, kAny>(d, u, v, w, az, bz, cz, BlockLanes<Block>{&block, lane}, ray, best);
        if (kAny && best.block) return;
      }
    }
  }

  template <bool kAny>
  static HWY_INLINE void fast(const Block& block, const RaySetup& ray, Best<QuadLeaf>& best) {
    const hn::CappedTag<float, 8> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const int step = static_cast<int>(hn::Lanes(d));
    for (int lane = 0; lane < 8; lane += step) {
      const auto words = hn::Load(du, block.primitive + lane);
      const auto turned_once = hn::RebindMask(d, hn::TestBit(words, hn::Set(du, layouts::kQuadTurnBit)));
      const auto turned_twice = hn::RebindMask(d, hn::TestBit(words, hn::Set(du, 2 * layouts::kQuadTurnBit)));
      const auto flipped = hn::RebindMask(d, hn::TestBit(words, hn::Set(du, layouts::kQuadFlipBit)));
      // The corners in the mesh's order: the edge from the first corner to the one after next, or that one itself.
      const auto corners = [&](int axis, auto& v0, auto& e1, auto& e2) HWY_ATTR {
        const auto a = hn::Load(d, block.apex[axis] + lane);
        const auto first = hn::LoadDup128(d, block.edge[0][axis] + (lane & 3));
        const auto second = hn::LoadDup128(d, block.edge[1][axis] + (lane & 3));
        const auto b = hn::IfThenElse(flipped, second, first), c = hn::IfThenElse(flipped, first, second);
        v0 = hn::IfThenElse(turned_once, b, hn::IfThenElse(turned_twice, c, a));
        e1 = hn::Sub(hn::IfThenElse(turned_once, c, hn::IfThenElse(turned_twice, a, b)), v0);
        e2 = hn::Sub(hn::IfThenElse(turned_once, a, hn::IfThenElse(turned_twice, b, c)), v0);
      };
      auto v0x = hn::Zero(d), v0y = v0x, v0z = v0x, e1x = v0x, e1y = v0x, e1z = v0x, e2x = v0x, e2y = v0x, e2z = v0x;
      corners(0, v0x, e1x, e2x);
      corners(1, v0y, e1y, e2y);
      corners(2, v0z, e1z, e2z);
      fast_lanes<QuadLeaf, kAny>(d, v0x, v0y, v0z, e1x, e1y, e1z, e2x, e2y, e2z, BlockLanes<Block>{&block, lane}, ray,
                                 best);
    }
  }
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
