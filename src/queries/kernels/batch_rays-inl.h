// The rays of a packet, planes apart, and their set-up: what set_up in ray_setup.h does, for a vector of rays at a time
// and by the same operations, so that every number that decides a hit has the same bits.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_RAYS_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_RAYS_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_RAYS_INL_H_
#endif

#include "queries/kernels/batch.h"
#include "queries/kernels/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

/// As many rays at a time as the instruction set has lanes, up to 16.
using RayTag = hn::CappedTag<float, 16>;

template <class D>
HWY_INLINE std::uint32_t packet_bits(D d, hn::Mask<D> mask) {
  return static_cast<std::uint32_t>(mask_bits(d, mask));
}

/// `limit`: the nearest hit's t so far, or tmax; minus infinity for rays that take no part, which no test passes.
/// u and v are kept times `sum`. `triangle`: eight times the hit's block, plus its lane.
struct alignas(64) PacketRays {
  static constexpr int kRays = static_cast<int>(kPacketRays);

  float origin[3][kRays], direction[3][kRays], reciprocal[3][kRays], entry_add[3][kRays], exit_add[3][kRays];
  float tmin[kRays], tmax[kRays], t_scale[kRays], limit[kRays];
  float inverse_z[kRays], shear_x[kRays], shear_y[kRays];
  float signature[kRays];  ///< twice the main axis, plus one where the ray runs down it; below zero: takes no part
  std::uint32_t primitive[kRays], triangle[kRays], place[kRays];
  double u[kRays], v[kRays], sum[kRays];

  /// Where ray `slot` stands behind the tile's first. Slots 16 k to 16 k + 15 are a square of four by four.
  static HWY_INLINE void fill_places(const Tile& tile, std::uint32_t* place) {
    for (std::uint32_t slot = 0; slot < kPacketRays; ++slot) {
      std::uint32_t column = slot, row = 0;
      if (tile.rows > 1) {
        column = (slot & 3) + (slot >> 2 & 4);
        row = (slot >> 2 & 3) + (slot >> 3 & 4);
      }
      const bool is_there = column < tile.columns && row < tile.rows;
      place[slot] = is_there ? static_cast<std::uint32_t>(row * tile.stride + column) : kNowhere;
    }
  }
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  HWY_INLINE void load(const Ray* rays, const Tile& tile) {
    fill_places(tile, place);
    for (int slot = 0; slot < kRays; ++slot) {
      if (place[slot] == kNowhere) {
        // The direction zero takes no part.
        for (int axis = 0; axis < 3; ++axis) origin[axis][slot] = direction[axis][slot] = 0;
        tmin[slot] = tmax[slot] = 0;
        continue;
      }
      const Ray& ray = rays[tile.first + place[slot]];
      origin[0][slot] = ray.origin.x, origin[1][slot] = ray.origin.y, origin[2][slot] = ray.origin.z;
      direction[0][slot] = ray.direction.x, direction[1][slot] = ray.direction.y, direction[2][slot] = ray.direction.z;
      tmin[slot] = ray.tmin, tmax[slot] = ray.tmax;
    }
  }

  /// Scales the directions, finds the main axes and who takes part.
  HWY_INLINE void prepare() {
    const RayTag d;
    const hn::RebindToSigned<RayTag> di;
    const auto zero = hn::Zero(d), infinity = hn::Set(d, kInfinity);
    for (int i = 0; i < kRays; i += static_cast<int>(hn::Lanes(d))) {
      auto dx = hn::Load(d, direction[0] + i), dy = hn::Load(d, direction[1] + i), dz = hn::Load(d, direction[2] + i);
      const auto x = hn::Abs(dx), y = hn::Abs(dy), z = hn::Abs(dz);
      const auto largest = hn::Max(hn::Max(x, y), z);
      auto valid = hn::And(hn::And(hn::Lt(x, infinity), hn::Lt(y, infinity)), hn::Lt(z, infinity));
      for (int axis = 0; axis < 3; ++axis)
        valid = hn::And(valid, hn::Lt(hn::Abs(hn::Load(d, origin[axis] + i)), infinity));
      valid = hn::And(valid, hn::Gt(largest, zero));
      const auto biased = hn::ShiftRight<23>(hn::BitCast(di, largest));
      const auto exponent = hn::Min(hn::Max(hn::Sub(biased, hn::Set(di, 127)), hn::Set(di, -126)), hn::Set(di, 126));
      const auto down = hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127), exponent)));
      const auto up = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(hn::Set(di, 127), exponent)));
      const auto from = hn::Load(d, tmin + i);
      const auto start = hn::IfThenElseZero(hn::Gt(from, zero), hn::Mul(from, up));
      const auto end = hn::Mul(hn::Load(d, tmax + i), up);
      valid = hn::And(valid, hn::And(hn::Le(start, end), hn::Eq(from, from)));
      dx = hn::Mul(dx, down), dy = hn::Mul(dy, down), dz = hn::Mul(dz, down);
      const auto sx = hn::Abs(dx), sy = hn::Abs(dy), sz = hn::Abs(dz);
      const auto x_first = hn::And(hn::Ge(sx, sy), hn::Ge(sx, sz));
      const auto main = hn::IfThenElse(
          x_first, zero, hn::IfThenElse(hn::And(hn::Lt(sx, sy), hn::Ge(sy, sz)), hn::Set(d, 2.0f), hn::Set(d, 4.0f)));
      const auto on_main = hn::IfThenElse(x_first, dx, hn::IfThenElse(hn::Eq(main, hn::Set(d, 2.0f)), dy, dz));
      const auto sign = hn::IfThenElseZero(hn::Lt(on_main, zero), hn::Set(d, 1.0f));
      hn::Store(hn::IfThenElse(valid, hn::Add(main, sign), hn::Set(d, -1.0f)), d, signature + i);
      hn::Store(hn::IfThenElseZero(valid, dx), d, direction[0] + i);
      hn::Store(hn::IfThenElseZero(valid, dy), d, direction[1] + i);
      hn::Store(hn::IfThenElseZero(valid, dz), d, direction[2] + i);
      for (int axis = 0; axis < 3; ++axis)
        hn::Store(hn::IfThenElseZero(valid, hn::Load(d, origin[axis] + i)), d, origin[axis] + i);
      hn::Store(hn::IfThenElseZero(valid, start), d, tmin + i);
      hn::Store(hn::IfThenElseZero(valid, end), d, tmax + i);
      hn::Store(down, d, t_scale + i);
      hn::Store(hn::Set(d, -kInfinity), d, limit + i);
    }
  }

  /// The constants of the box tests.
  HWY_INLINE void prepare_boxes(const Box& bounds) {
    const RayTag d;
    for (int axis = 0; axis < 3; ++axis) {
      const auto extent = hn::Set(d, maximum(std::fabs(bounds.lower[axis]), std::fabs(bounds.upper[axis])));
      for (int i = 0; i < kRays; i += static_cast<int>(hn::Lanes(d))) {
        const auto o = hn::Load(d, origin[axis] + i), da = hn::Load(d, direction[axis] + i);
        const auto reach = hn::Add(extent, hn::Abs(o));
        const auto bound = hn::Div(hn::Set(d, 1e37f), hn::Max(reach, hn::Set(d, 1.0f)));
        const auto r = hn::Min(hn::Div(hn::Set(d, 1.0f), hn::Abs(da)), bound);
        const auto pad = hn::Mul(hn::Mul(hn::Set(d, 12 * 0x1p-24f), reach), r);
        const auto signed_r = hn::CopySign(r, da);
        const auto offset = hn::Neg(hn::Mul(o, signed_r));
        hn::Store(signed_r, d, reciprocal[axis] + i);
        hn::Store(hn::Sub(offset, pad), d, entry_add[axis] + i);
        hn::Store(hn::Add(offset, pad), d, exit_add[axis] + i);
      }
    }
  }

  /// The constants of the triangle tests, for rays of one main axis.
  HWY_INLINE void prepare_triangles(int kx, int ky, int kz) {
    const RayTag d;
    for (int i = 0; i < kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto dz = hn::Load(d, direction[kz] + i);
      hn::Store(hn::Div(hn::Set(d, 1.0f), dz), d, inverse_z + i);
      // The same as the quotient in double precision, rounded.
      hn::Store(hn::Div(hn::Load(d, direction[kx] + i), dz), d, shear_x + i);
      hn::Store(hn::Div(hn::Load(d, direction[ky] + i), dz), d, shear_y + i);
    }
  }

  /// What the scalar triangle tests of triangle_test.h read of a ray.
  HWY_INLINE RaySetup setup_of(int slot, int kx, int ky, int kz) const {
    RaySetup s{};
    for (int axis = 0; axis < 3; ++axis) s.origin[axis] = origin[axis][slot], s.direction[axis] = direction[axis][slot];
    s.tmin = tmin[slot], s.tmax = tmax[slot], s.t_scale = t_scale[slot];
    s.kx = kx, s.ky = ky, s.kz = kz;
    s.shear_x = shear_x[slot], s.shear_y = shear_y[slot], s.inverse_z = inverse_z[slot];
    return s;
  }
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
