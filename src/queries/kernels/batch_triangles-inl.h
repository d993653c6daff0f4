// Triangle tests of a packet: one triangle against a vector of rays at a time, by the operations of single rays.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_TRIANGLES_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_TRIANGLES_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_TRIANGLES_INL_H_
#endif

#include "queries/kernels/batch_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

/// Vectors of rays that meet a leaf's box.
struct Meeting {
  int first_ray[PacketRays::kRays / hn::MaxLanes(RayTag())];
  hn::Mask<RayTag> active[PacketRays::kRays / hn::MaxLanes(RayTag())];
  int count = 0;
};

template <class Leaf, bool kRobust, bool kAny>
class PacketTriangles {
 public:
  using Block = typename Leaf::Block;
  using V = hn::Vec<RayTag>;
  using Mask = hn::Mask<RayTag>;
  static constexpr int kLanes = sizeof(Block::primitive) / sizeof(std::uint32_t);

  /// `blocks`: the layout's first.
  PacketTriangles(const Block* blocks, PacketRays& rays) : blocks_(blocks), rays_(rays) {}

  /// The rays whose limit is not below zero share this main axis.
  HWY_INLINE void begin(int kx, int ky, int kz) {
    kx_ = kx, ky_ = ky, kz_ = kz;
    find_one_origin();
  }

  /// True when a limit has come down.
  HWY_INLINE bool test(const Block& block, const Meeting& meeting) {
    bool shorter = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (block.primitive[lane] == layouts::kInvalidPrimitive) continue;
      if constexpr (kRobust)
        shorter |= robust(block, lane, meeting);
      else
        shorter |= fast(block, lane, meeting);
    }
    return shorter;
  }

  /// What a single ray has found. False when that is nothing new.
  HWY_INLINE bool take(int slot, const Best<Leaf>& best) {
    if (!best.block) return false;
    if constexpr (kAny) {
      rays_.limit[slot] = -kInfinity, rays_.primitive[slot] = 0;
      return true;
    }
    rays_.limit[slot] = best.t, rays_.primitive[slot] = best.primitive;
    rays_.triangle[slot] = static_cast<std::uint32_t>(best.block - blocks_) * 8 + static_cast<std::uint32_t>(best.lane);
    if constexpr (kRobust)
      rays_.u[slot] = best.u, rays_.v[slot] = best.v, rays_.sum[slot] = best.sum;
    else
      rays_.float_u[slot] = static_cast<float>(best.u), rays_.float_v[slot] = static_cast<float>(best.v);
    return true;
  }

 private:
  /// Camera rays share it, to the last bit; the triangle tests do part of their work once for all rays then.
  HWY_INLINE void find_one_origin() {
    const RayTag d;
    const hn::RebindToSigned<RayTag> di;
    is_one_origin_ = true;
    int first = 0;
    while (first < PacketRays::kRays - 1 && !(rays_.limit[first] >= 0)) ++first;
    for (int axis = 0; axis < 3; ++axis) {
      one_origin_[axis] = rays_.origin[axis][first];
      const auto one = hn::BitCast(di, hn::Set(d, one_origin_[axis]));
      for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
        const auto differs = hn::Ne(hn::BitCast(di, hn::Load(d, rays_.origin[axis] + i)), one);
        const auto active = hn::Ge(hn::Load(d, rays_.limit + i), hn::Zero(d));
        is_one_origin_ &= hn::AllFalse(d, hn::And(active, hn::RebindMask(d, differs)));
      }
    }
  }

  /// Origins on one axis; where all rays have the same one, of no ray in particular.
  HWY_INLINE V origin(int axis, int i) const {
    const RayTag d;
    return is_one_origin_ ? hn::Set(d, one_origin_[axis]) : hn::Load(d, rays_.origin[axis] + i);
  }

  HWY_INLINE bool robust(const Block& block, int lane, const Meeting& meeting) {
    const RayTag d;
    const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1), c = Leaf::corner(block, lane, 2);
    V az, bz, cz, a_x, b_x, c_x, a_y, b_y, c_y;  // from the origin, not sheared yet
    const auto relative = [&](int i) HWY_ATTR {
      const auto ox = origin(kx_, i), oy = origin(ky_, i), oz = origin(kz_, i);
      az = hn::Sub(hn::Set(d, a[kz_]), oz), bz = hn::Sub(hn::Set(d, b[kz_]), oz), cz = hn::Sub(hn::Set(d, c[kz_]), oz);
      a_x = hn::Sub(hn::Set(d, a[kx_]), ox), b_x = hn::Sub(hn::Set(d, b[kx_]), ox);
      c_x = hn::Sub(hn::Set(d, c[kx_]), ox);
      a_y = hn::Sub(hn::Set(d, a[ky_]), oy), b_y = hn::Sub(hn::Set(d, b[ky_]), oy);
      c_y = hn::Sub(hn::Set(d, c[ky_]), oy);
    };
    relative(meeting.first_ray[0]);
    bool shorter = false;
    for (int k = 0; k < meeting.count; ++k) {
      const int i = meeting.first_ray[k];
      const auto active = meeting.active[k];
      if (k > 0 && !is_one_origin_) relative(i);
      const auto shear_x = hn::Load(d, rays_.shear_x + i), shear_y = hn::Load(d, rays_.shear_y + i);
      const auto scale = hn::Load(d, rays_.inverse_z + i);
      const auto ax = hn::Sub(a_x, hn::Mul(shear_x, az)), bx = hn::Sub(b_x, hn::Mul(shear_x, bz)),
                 cx = hn::Sub(c_x, hn::Mul(shear_x, cz));
      const auto ay = hn::Sub(a_y, hn::Mul(shear_y, az)), by = hn::Sub(b_y, hn::Mul(shear_y, bz)),
                 cy = hn::Sub(c_y, hn::Mul(shear_y, cz));
      const auto u = hn::Sub(hn::Mul(cx, by), hn::Mul(cy, bx));
      const auto v = hn::Sub(hn::Mul(ax, cy), hn::Mul(ay, cx));
      const auto w = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
      const auto tiny = hn::Le(hn::Min(hn::Min(hn::Abs(u), hn::Abs(v)), hn::Abs(w)), hn::Set(d, kTinyEdgeFunction));
      const auto limit = hn::Load(d, rays_.limit + i);
      const auto nearest = hn::Min(hn::Min(hn::Mul(az, scale), hn::Mul(bz, scale)), hn::Mul(cz, scale));
      const auto found = hn::And(hn::And(active, hn::Or(same_sign(d, u, v, w), tiny)),
                                 hn::Le(nearest, hn::Mul(limit, hn::Set(d, 1 + 8 * 0x1p-24f))));
      std::uint32_t bits = packet_bits(d, found);
      if (HWY_LIKELY(!bits)) continue;
      if (HWY_UNLIKELY(!hn::AllFalse(d, tiny))) bits = settle(block, lane, i, bits, packet_bits(d, tiny));
      if constexpr (kAny) {
        const auto farthest = hn::Max(hn::Max(hn::Mul(az, scale), hn::Mul(bz, scale)), hn::Mul(cz, scale));
        const auto start = hn::Load(d, rays_.tmin + i), stop = hn::Load(d, rays_.tmax + i);
        const auto within = hn::And(hn::Gt(nearest, hn::Mul(start, hn::Set(d, 1 + 8 * 0x1p-24f))),
                                    hn::Lt(farthest, hn::Mul(stop, hn::Set(d, 1 - 8 * 0x1p-24f))));
        const auto sure = hn::AndNot(tiny, hn::And(found, within));
        if (const std::uint32_t done = packet_bits(d, sure)) {
          const hn::RebindToUnsigned<RayTag> du;
          hn::BlendedStore(hn::Set(d, -kInfinity), sure, d, rays_.limit + i);
          hn::BlendedStore(hn::Zero(du), hn::RebindMask(du, sure), du, rays_.primitive + i);
          bits &= ~done;
          shorter = true;
        }
      }
      if (bits) shorter |= locate(block, lane, i, bits);
    }
    return shorter;
  }

  /// Looks again, in double precision, at the rays for which an edge function is nearly zero.
  HWY_NOINLINE std::uint32_t settle(const Block& block, int lane, int i, std::uint32_t bits, std::uint32_t tiny) const {
    for (std::uint32_t doubtful = bits & tiny; doubtful; doubtful &= doubtful - 1) {
      const int slot = std::countr_zero(doubtful);
      const RaySetup setup = rays_.setup_of(i + slot, kx_, ky_, kz_);
      ShearedTriangle sheared;
      if (!robust_test(permuted<Leaf>(block, lane, setup), setup, sheared)) bits &= ~(1u << slot);
    }
    return bits;
  }

  /// The class Location of triangle_test.h for several rays at once.
  HWY_NOINLINE bool locate(const Block& block, int lane, int i, std::uint32_t bits) {
    const hn::CappedTag<double, 8> dd;
    using DD = hn::CappedTag<double, 8>;
    const hn::Rebind<float, DD> df;
    const int step = static_cast<int>(hn::Lanes(dd));
    const CornerAt corner[3] = {Leaf::corner(block, lane, 0), Leaf::corner(block, lane, 1),
                                Leaf::corner(block, lane, 2)};
    bool shorter = false;
    for (int at = i; bits; at += step, bits >>= step) {
      const std::uint32_t wanted = bits & ((1u << step) - 1);
      if (!wanted) continue;
      const auto load = [&](const float* p) HWY_ATTR { return hn::PromoteTo(dd, hn::Load(df, p + at)); };
      const auto dz = load(rays_.direction[kz_]);
      const auto shear_x = hn::Div(load(rays_.direction[kx_]), dz), shear_y = hn::Div(load(rays_.direction[ky_]), dz);
      const auto ox = load(rays_.origin[kx_]), oy = load(rays_.origin[ky_]), oz = load(rays_.origin[kz_]);
      const auto z_of = [&](int k) HWY_ATTR { return hn::Sub(hn::Set(dd, double(corner[k][kz_])), oz); };
      const auto z0 = z_of(0), z1 = z_of(1), z2 = z_of(2);
      const auto x_of = [&](int k, auto z) HWY_ATTR {
        return hn::Sub(hn::Sub(hn::Set(dd, double(corner[k][kx_])), ox), hn::Mul(shear_x, z));
      };
      const auto y_of = [&](int k, auto z) HWY_ATTR {
        return hn::Sub(hn::Sub(hn::Set(dd, double(corner[k][ky_])), oy), hn::Mul(shear_y, z));
      };
      const auto x0 = x_of(0, z0), x1 = x_of(1, z1), x2 = x_of(2, z2);
      const auto y0 = y_of(0, z0), y1 = y_of(1, z1), y2 = y_of(2, z2);
      auto u = hn::Sub(hn::Mul(x2, y1), hn::Mul(y2, x1));
      auto v = hn::Sub(hn::Mul(x0, y2), hn::Mul(y0, x2));
      auto w = hn::Sub(hn::Mul(x1, y0), hn::Mul(y1, x0));
      const auto zero = hn::Zero(dd);
      const auto negative = hn::Lt(hn::Add(hn::Add(u, v), w), zero);
      u = hn::Max(hn::IfThenElse(negative, hn::Neg(u), u), zero);
      v = hn::Max(hn::IfThenElse(negative, hn::Neg(v), v), zero);
      w = hn::Max(hn::IfThenElse(negative, hn::Neg(w), w), zero);
      const auto sum = hn::Add(hn::Add(u, v), w);
      const auto t = hn::Div(hn::Add(hn::Add(hn::Mul(u, z0), hn::Mul(v, z1)), hn::Mul(w, z2)), hn::Mul(sum, dz));
      std::uint32_t sound = wanted & double_bits(dd, hn::Gt(sum, zero));
      shorter |= take(block, lane, at, sound, hn::Add(hn::DemoteTo(df, t), hn::Zero(df)), v, w, sum);
      for (sound ^= wanted; sound; sound &= sound - 1)
        shorter |= locate_edge_on(block, lane, at + std::countr_zero(sound));
    }
    return shorter;
  }

  template <class DD>
  static HWY_INLINE std::uint32_t double_bits(DD dd, hn::Mask<DD> mask) {
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(dd, mask, bytes);
    return bytes[0] & ((1u << hn::Lanes(dd)) - 1);
  }

  HWY_INLINE std::uint32_t triangle_number(const Block& block, int lane) const {
    return static_cast<std::uint32_t>(&block - blocks_) * 8 + static_cast<std::uint32_t>(lane);
  }

  /// Best::takes for the rays of `bits` from slot `at` on. u and v are times sum.
  template <class VF, class VD>
  HWY_INLINE bool take(const Block& block, int lane, int at, std::uint32_t bits, VF t, VD u, VD v, VD sum) {
    const hn::DFromV<VF> df;
    const hn::DFromV<VD> dd;
    const hn::RebindToUnsigned<decltype(df)> du;
    const auto id = hn::Set(du, Leaf::primitive(block, lane));
    const auto limit = hn::Load(df, rays_.limit + at);
    const auto before = hn::RebindMask(df, hn::Lt(id, hn::Load(du, rays_.primitive + at)));
    const auto nearer = hn::Or(hn::Lt(t, limit), hn::And(hn::Eq(t, limit), before));
    const auto ok = hn::And(hn::Ge(t, hn::Load(df, rays_.tmin + at)), nearer);
    alignas(8) std::uint8_t taken[8] = {};
    hn::StoreMaskBits(df, ok, taken);
    taken[0] &= static_cast<std::uint8_t>(bits);
    if (!taken[0]) return false;
    const auto mask = hn::LoadMaskBits(df, taken);
    hn::BlendedStore(kAny ? hn::Set(df, -kInfinity) : t, mask, df, rays_.limit + at);
    hn::BlendedStore(id, hn::RebindMask(du, mask), du, rays_.primitive + at);
    if constexpr (!kAny) {
      hn::BlendedStore(hn::Set(du, triangle_number(block, lane)), hn::RebindMask(du, mask), du, rays_.triangle + at);
      const auto wide = hn::LoadMaskBits(dd, taken);
      hn::BlendedStore(u, wide, dd, rays_.u + at);
      hn::BlendedStore(v, wide, dd, rays_.v + at);
      hn::BlendedStore(sum, wide, dd, rays_.sum + at);
    }
    return true;
  }

  HWY_NOINLINE bool locate_edge_on(const Block& block, int lane, int slot) {
    const RaySetup setup = rays_.setup_of(slot, kx_, ky_, kz_);
    const Location at(permuted<Leaf>(block, lane, setup), setup);
    const std::uint32_t id = Leaf::primitive(block, lane);
    const float t = at.t();
    if (!(t >= setup.tmin && (t < rays_.limit[slot] || (t == rays_.limit[slot] && id < rays_.primitive[slot]))))
      return false;
    rays_.limit[slot] = kAny ? -kInfinity : t;
    rays_.primitive[slot] = id, rays_.triangle[slot] = triangle_number(block, lane);
    rays_.u[slot] = at.u_times_sum(), rays_.v[slot] = at.v_times_sum(), rays_.sum[slot] = at.sum();
    return true;
  }

  HWY_INLINE bool fast(const Block& block, int lane, const Meeting& meeting) {
    const RayTag d;
    const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1), c = Leaf::corner(block, lane, 2);
    const auto e1x = hn::Set(d, b[0] - a[0]), e1y = hn::Set(d, b[1] - a[1]), e1z = hn::Set(d, b[2] - a[2]);
    const auto e2x = hn::Set(d, c[0] - a[0]), e2y = hn::Set(d, c[1] - a[1]), e2z = hn::Set(d, c[2] - a[2]);
    V sx, sy, sz, qx, qy, qz, along;  // what does not depend on the direction
    const auto from_origin = [&](int i) HWY_ATTR {
      sx = hn::Sub(origin(0, i), hn::Set(d, a[0]));
      sy = hn::Sub(origin(1, i), hn::Set(d, a[1]));
      sz = hn::Sub(origin(2, i), hn::Set(d, a[2]));
      qx = hn::Sub(hn::Mul(sy, e1z), hn::Mul(sz, e1y));
      qy = hn::Sub(hn::Mul(sz, e1x), hn::Mul(sx, e1z));
      qz = hn::Sub(hn::Mul(sx, e1y), hn::Mul(sy, e1x));
      along = dot_without_fusing(d, e2x, e2y, e2z, qx, qy, qz);
    };
    from_origin(meeting.first_ray[0]);
    bool shorter = false;
    for (int k = 0; k < meeting.count; ++k) {
      const int i = meeting.first_ray[k];
      if (k > 0 && !is_one_origin_) from_origin(i);
      const auto dx = hn::Load(d, rays_.direction[0] + i), dy = hn::Load(d, rays_.direction[1] + i),
                 dz = hn::Load(d, rays_.direction[2] + i);
      const auto px = hn::Sub(hn::Mul(dy, e2z), hn::Mul(dz, e2y));
      const auto py = hn::Sub(hn::Mul(dz, e2x), hn::Mul(dx, e2z));
      const auto pz = hn::Sub(hn::Mul(dx, e2y), hn::Mul(dy, e2x));
      const auto determinant = dot_without_fusing(d, e1x, e1y, e1z, px, py, pz);
      const auto u = dot_without_fusing(d, sx, sy, sz, px, py, pz);
      const auto v = dot_without_fusing(d, dx, dy, dz, qx, qy, qz);
      const auto w = hn::Sub(hn::Sub(determinant, u), v);
      const auto inside =
          hn::And(meeting.active[k], hn::And(same_sign(d, u, v, w, along), hn::Ne(determinant, hn::Zero(d))));
      if (HWY_LIKELY(hn::AllFalse(d, inside))) continue;
      const auto r = hn::Div(hn::Set(d, 1.0f), determinant);
      const auto t = hn::Mul(along, r);
      shorter |= take_fast(block, lane, i, inside, t, hn::Mul(u, r), hn::Mul(v, r));
    }
    return shorter;
  }

  HWY_INLINE bool take_fast(const Block& block, int lane, int i, Mask inside, V t, V u, V v) {
    const RayTag d;
    const hn::RebindToUnsigned<RayTag> du;
    const auto id = hn::Set(du, Leaf::primitive(block, lane));
    const auto limit = hn::Load(d, rays_.limit + i);
    const auto before = hn::RebindMask(d, hn::Lt(id, hn::Load(du, rays_.primitive + i)));
    const auto nearer = hn::Or(hn::Lt(t, limit), hn::And(hn::Eq(t, limit), before));
    const auto ok = hn::And(hn::And(inside, hn::Ge(t, hn::Load(d, rays_.tmin + i))), nearer);
    if (hn::AllFalse(d, ok)) return false;
    hn::BlendedStore(kAny ? hn::Set(d, -kInfinity) : t, ok, d, rays_.limit + i);
    hn::BlendedStore(id, hn::RebindMask(du, ok), du, rays_.primitive + i);
    if constexpr (!kAny) {
      hn::BlendedStore(hn::Set(du, triangle_number(block, lane)), hn::RebindMask(du, ok), du, rays_.triangle + i);
      hn::BlendedStore(u, ok, d, rays_.float_u + i);
      hn::BlendedStore(v, ok, d, rays_.float_v + i);
    }
    return true;
  }

 protected:
  const Block* blocks_;
  PacketRays& rays_;
  int kx_ = 0, ky_ = 0, kz_ = 0;

 private:
  float one_origin_[3];
  bool is_one_origin_ = false;
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
