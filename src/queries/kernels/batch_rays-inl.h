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

#if HWY_TARGET != HWY_SCALAR
using FourTag = hn::FixedTag<float, 4>;

/// Rows become columns.
template <class V>
HWY_INLINE void transpose_four(V& a, V& b, V& c, V& e) {
  const FourTag d;
  const auto ab_lower = hn::InterleaveLower(d, a, b), ab_upper = hn::InterleaveUpper(d, a, b);
  const auto ce_lower = hn::InterleaveLower(d, c, e), ce_upper = hn::InterleaveUpper(d, c, e);
  a = hn::ConcatLowerLower(d, ce_lower, ab_lower), b = hn::ConcatUpperUpper(d, ce_lower, ab_lower);
  c = hn::ConcatLowerLower(d, ce_upper, ab_upper), e = hn::ConcatUpperUpper(d, ce_upper, ab_upper);
}
#endif

/// `limit`: the nearest hit's t so far, or tmax; minus infinity for rays that take no part, which no test passes.
/// u and v are kept times `sum` in robust mode, as `float_u` and `float_v` in fast mode. `triangle`: eight times the
/// hit's block, plus its lane.
struct alignas(64) PacketRays {
  static constexpr int kRays = static_cast<int>(kPacketRays);

  float origin[3][kRays], direction[3][kRays], reciprocal[3][kRays], entry_add[3][kRays], exit_add[3][kRays];
  float tmin[kRays], tmax[kRays], t_scale[kRays], limit[kRays];
  float inverse_z[kRays], shear_x[kRays], shear_y[kRays];
  float signature[kRays];  ///< twice the main axis, plus one where the ray runs down it; below zero: takes no part
  std::uint32_t primitive[kRays], triangle[kRays], place[kRays];
  float float_u[kRays], float_v[kRays];
  double u[kRays], v[kRays], sum[kRays];

  /// Where ray `slot` stands behind the tile's first. Slots 16 k to 16 k + 15 are a square of four by four; slots 4 k
  /// to 4 k + 3 are neighbours.
  static HWY_INLINE void fill_places(const Tile& tile, std::uint32_t* place) {
    for (std::uint32_t slot = 0; slot < kPacketRays; slot += 4) {
      std::uint32_t column = slot, row = 0;
      if (tile.rows > 1) {
        column = slot >> 2 & 4;
        row = (slot >> 2 & 3) + (slot >> 3 & 4);
      }
      const std::uint32_t first = static_cast<std::uint32_t>(row * tile.stride) + column;
      for (std::uint32_t i = 0; i < 4; ++i)
        place[slot + i] = column + i < tile.columns && row < tile.rows ? first + i : kNowhere;
    }
  }
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  HWY_INLINE void load(const Ray* rays, const Tile& tile) {
    fill_places(tile, place);
    for (int slot = 0; slot < kRays; slot += 4) {
      const bool are_all_there = place[slot + 3] != kNowhere;
      if (are_all_there && load_four(rays + tile.first + place[slot], slot)) continue;
      for (int i = slot; i < slot + 4; ++i) load_one(rays + tile.first, i);
    }
    // The next tile of a picture, as a number: there may be none.
    const std::uintptr_t next = reinterpret_cast<std::uintptr_t>(rays + tile.first) + tile.columns * sizeof(Ray);
    for (std::size_t row = 0; row < tile.rows; ++row)
      for (std::size_t byte = 0; byte < tile.columns * sizeof(Ray); byte += 64)
        hwy::Prefetch(reinterpret_cast<const char*>(next + row * tile.stride * sizeof(Ray) + byte));
  }

  /// False without vectors of four.
  HWY_INLINE bool load_four([[maybe_unused]] const Ray* rays, [[maybe_unused]] int slot) {
#if HWY_TARGET == HWY_SCALAR
    return false;
#else
    const FourTag d;
    const auto columns = [&](int half, float* x, float* y, float* z, float* t) HWY_ATTR {
      const float* const from = reinterpret_cast<const float*>(rays) + 4 * half;
      auto a = hn::LoadU(d, from), b = hn::LoadU(d, from + 8), c = hn::LoadU(d, from + 16), e = hn::LoadU(d, from + 24);
      transpose_four(a, b, c, e);
      hn::Store(a, d, x + slot);
      hn::Store(b, d, y + slot);
      hn::Store(c, d, z + slot);
      hn::Store(e, d, t + slot);
    };
    columns(0, origin[0], origin[1], origin[2], tmin);
    columns(1, direction[0], direction[1], direction[2], tmax);
    return true;
#endif
  }

  HWY_INLINE void load_one(const Ray* rays, int slot) {
    if (place[slot] == kNowhere) {
      // The direction zero takes no part.
      for (int axis = 0; axis < 3; ++axis) origin[axis][slot] = direction[axis][slot] = 0;
      tmin[slot] = tmax[slot] = 0;
      return;
    }
    const Ray& ray = rays[place[slot]];
    origin[0][slot] = ray.origin.x, origin[1][slot] = ray.origin.y, origin[2][slot] = ray.origin.z;
    direction[0][slot] = ray.direction.x, direction[1][slot] = ray.direction.y, direction[2][slot] = ray.direction.z;
    tmin[slot] = ray.tmin, tmax[slot] = ray.tmax;
  }

  /// Bit s + 1 for each signature s.
  HWY_INLINE std::uint32_t signatures_present() const {
    std::uint32_t present = 0;
    const RayTag d;
    for (int s = -1; s < 6; ++s) {
      auto some = hn::Eq(hn::Load(d, signature), hn::Set(d, static_cast<float>(s)));
      for (int i = static_cast<int>(hn::Lanes(d)); i < kRays; i += static_cast<int>(hn::Lanes(d)))
        some = hn::Or(some, hn::Eq(hn::Load(d, signature + i), hn::Set(d, static_cast<float>(s))));
      present |= std::uint32_t{!hn::AllFalse(d, some)} << (s + 1);
    }
    return present;
  }

  /// So that rays that hit nothing can be divided too.
  HWY_INLINE void clear_locations() {
    for (int i = 0; i < kRays; ++i) u[i] = v[i] = 0, sum[i] = 1;
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
    const auto one = hn::Set(d, 1.0f), most = hn::Set(d, 1e37f);
    for (int axis = 0; axis < 3; ++axis) {
      const auto extent = hn::Set(d, maximum(std::fabs(bounds.lower[axis]), std::fabs(bounds.upper[axis])));
      auto farthest = one;
      for (int i = 0; i < kRays; i += static_cast<int>(hn::Lanes(d)))
        farthest = hn::Max(farthest, hn::Add(extent, hn::Abs(hn::Load(d, origin[axis] + i))));
      // What the reciprocal is limited to is no less than this for any ray, and hardly any reciprocal is above it.
      const auto lowest_bound = hn::Set(d, 1e37f / hn::GetLane(hn::MaxOfLanes(d, farthest)));
      for (int i = 0; i < kRays; i += static_cast<int>(hn::Lanes(d))) {
        const auto o = hn::Load(d, origin[axis] + i), da = hn::Load(d, direction[axis] + i);
        const auto reach = hn::Add(extent, hn::Abs(o));
        auto r = hn::Div(one, hn::Abs(da));
        if (HWY_UNLIKELY(!hn::AllTrue(d, hn::Le(r, lowest_bound)))) r = hn::Min(r, hn::Div(most, hn::Max(reach, one)));
        const auto pad = hn::Mul(hn::Mul(hn::Set(d, 12 * 0x1p-24f), reach), r);
        const auto signed_r = hn::CopySign(r, da);
        const auto offset = hn::Neg(hn::Mul(o, signed_r));
        hn::Store(signed_r, d, reciprocal[axis] + i);
        hn::Store(hn::Sub(offset, pad), d, entry_add[axis] + i);
        hn::Store(hn::Add(offset, pad), d, exit_add[axis] + i);
      }
    }
  }

  /// The shear of the beam, and in robust mode of the triangle tests, for rays of one main axis.
  template <bool kRobust>
  HWY_INLINE void prepare_triangles(int kx, int ky, int kz) {
    const RayTag d;
    for (int i = 0; i < kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto dz = hn::Load(d, direction[kz] + i);
      const auto dx = hn::Load(d, direction[kx] + i), dy = hn::Load(d, direction[ky] + i);
      const auto inverse = hn::Div(hn::Set(d, 1.0f), dz);
      if constexpr (kRobust) {
        hn::Store(inverse, d, inverse_z + i);
        // The same as the quotient in double precision, rounded.
        hn::Store(hn::Div(dx, dz), d, shear_x + i);
        hn::Store(hn::Div(dy, dz), d, shear_y + i);
      } else {
        hn::Store(hn::Mul(dx, inverse), d, shear_x + i);
        hn::Store(hn::Mul(dy, inverse), d, shear_y + i);
      }
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

  /// And what a traversal of single rays reads.
  template <bool kRobust>
  HWY_INLINE void set_up_alone(int slot, int kz, RaySetup& s) const {
    for (int axis = 0; axis < 3; ++axis) {
      s.origin[axis] = origin[axis][slot], s.direction[axis] = direction[axis][slot];
      s.reciprocal[axis] = reciprocal[axis][slot];
      s.entry_add[axis] = entry_add[axis][slot], s.exit_add[axis] = exit_add[axis][slot];
      const int negative = std::signbit(s.direction[axis]);
      s.entry_plane[axis] = 2 * axis + negative, s.exit_plane[axis] = 2 * axis + !negative;
    }
    s.tmin = tmin[slot], s.tmax = tmax[slot], s.t_scale = t_scale[slot];
    if constexpr (kRobust) set_main_axis(kz, s);
  }
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
