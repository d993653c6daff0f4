// Coherent packets of up to 64 rays through wide nodes. Inner nodes are tested once for the whole packet, against the
// beam that encloses its rays (batch_frustum-inl.h); leaves by a vector of rays at a time: first the leaf's box, by the
// arithmetic of a single ray, then its triangles one by one. Where few rays meet the same leaves the packet ends, and
// each ray goes on alone with the subtrees that wait (the hybrid of Benthin et al. 2012, bib key benthin2012). So each
// ray finds what it finds alone: it is tested against the triangles of every leaf whose box it meets, by the same
// operations, and of several hits at one t the lowest id is taken whatever the order.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_PACKET_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_PACKET_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_PACKET_INL_H_
#endif

#include <cstring>

#include "queries/kernels/batch_frustum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

template <int W, class Leaf, bool kRobust, bool kAny>
class PacketTraversal {
 public:
  using Block = typename Leaf::Block;
  using V = hn::Vec<RayTag>;
  using Mask = hn::Mask<RayTag>;
  static constexpr int kLanes = sizeof(Block::primitive) / sizeof(std::uint32_t);

  /// `as_given`: the rays as the caller has them, to whose places those of `rays` refer.
  PacketTraversal(const Layout& layout, const Ray* as_given, PacketRays& rays)
      : layout_(layout),
        nodes_(reinterpret_cast<const WideNode<W>*>(layout.nodes.data())),
        blocks_(reinterpret_cast<const Block*>(layout.triangles.data())),
        as_given_(as_given),
        rays_(rays) {}

  /// Traces the rays whose limit is not below zero; they share this signature.
  HWY_INLINE void run(int signature, StackEntry* const stack) {
    static constexpr int kNext[] = {1, 2, 0};
    kz_ = signature >> 1, kx_ = kNext[kz_], ky_ = kNext[kx_];
    rays_.prepare_triangles<kRobust>(kx_, ky_, kz_);
    if (!frustum_.enclose(rays_, layout_.bounds, kx_, ky_, kz_, signature & 1)) return;
    if (layout_.root & layouts::kLeafBit) {
      float planes[6];
      for (int axis = 0; axis < 3; ++axis)
        planes[2 * axis] = layout_.bounds.lower[axis], planes[2 * axis + 1] = layout_.bounds.upper[axis];
      visit_leaf(layout_.root, planes, 1);
      return;
    }
    traverse(stack);
  }

 private:
  /// A leaf costs as much as some rays that visit it alone. What the packet has saved or lost at leaves is summed up,
  /// and it ends when there is nothing left of what it starts with.
  static constexpr int kCredit = 16, kLeafPrice = 4;

  HWY_INLINE void traverse(StackEntry* const stack) {
    StackEntry* top = stack;
    int credit = kCredit;
    std::uint32_t node_index = layout_.root;
    alignas(64) float entry[W];
    for (;;) {
      const WideNode<W>& node = nodes_[node_index];
      const std::uint32_t hit = frustum_.template test<W>(node, entry);
      push(node, node_index, hit, entry, top);
      for (;;) {
        if (top == stack) return;
        --top;
        if (entry_distance(*top) > frustum_.length()) continue;
        const auto place = static_cast<std::uint32_t>(*top);
        const WideNode<W>& parent = nodes_[place / W];
        const std::uint32_t word = parent.child[place % W];
        if (!(word & layouts::kLeafBit)) {
          node_index = word;
          break;
        }
        if (visit_leaf(word, &parent.planes[0][0] + place % W, W)) return;
        credit += met_ - kLeafPrice;
        if (credit < 0) return hand_over(stack, top);
      }
    }
  }

  /// Puts the children of `hit` on the stack by their places, the one to go on with on top.
  static HWY_INLINE void push(const WideNode<W>&, std::uint32_t node_index, std::uint32_t hit, const float* entry,
                              StackEntry*& top) {
    if constexpr (kAny) {
      while (hit) {
        const int i = 31 - std::countl_zero(hit);
        hit ^= 1u << i;
        *top++ = make_entry(entry[i], node_index * W + i);
      }
      return;
    }
    StackEntry* const base = top;
    for (; hit; hit &= hit - 1) {
      const int i = std::countr_zero(hit);
      const StackEntry e = make_entry(entry[i], node_index * W + i);
      StackEntry* place = top++;
      for (; place != base && place[-1] < e; --place) place[0] = place[-1];
      *place = e;
    }
  }

  /// True when no ray is left. Plane p of the leaf's box is planes[p * stride].
  HWY_INLINE bool visit_leaf(std::uint32_t word, const float* planes, int stride) {
    const RayTag d;
    const Block* const begin = blocks_ + layouts::leaf_first(word);
    const Block* const end = begin + layouts::leaf_blocks(word);
    bool shorter = false;
    met_ = 0;
    auto near = hn::Zero(d);
    for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto active = meets(i, planes, stride, near);
      const std::size_t count = hn::CountTrue(d, active);
      if (count == 0) continue;
      met_ += static_cast<int>(count);
      for (const Block* block = begin; block != end; ++block) {
        if constexpr (kRobust)
          shorter |= robust(*block, i, active);
        else
          shorter |= fast(*block, i, active);
      }
    }
    if (!shorter) return false;
    frustum_.update_end(rays_);
    return kAny && frustum_.length() < 0;
  }

  /// Ends the packet: each ray goes on alone, through those of the waiting subtrees whose box it meets.
  HWY_NOINLINE void hand_over(const StackEntry* const stack, const StackEntry* top) {
    constexpr std::ptrdiff_t kAtOnce = 32, kFew = 4;  // mostly a ray waits for few
    const RayTag d;
    alignas(64) StackEntry waiting[PacketRays::kRays][kAtOnce];
    alignas(64) float distances[hn::MaxLanes(RayTag())];
    Stack own(layout_.max_stack + W);
    StackEntry* const base = own.entries();
    while (top != stack) {
      const StackEntry* const end = top;
      top -= std::min(kAtOnce, top - stack);
      std::uint8_t counts[PacketRays::kRays] = {};
      std::uint64_t some = 0;  // rays with a subtree to go through
      for (const StackEntry* from = top; from != end; ++from) {
        const auto place = static_cast<std::uint32_t>(*from), node = place / W, child = place % W;
        for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
          auto near = hn::Zero(d);
          std::uint64_t met = packet_bits(d, meets(i, &nodes_[node].planes[0][0] + child, W, near));
          some |= met << i;
          hn::Store(near, d, distances);
          for (; met; met &= met - 1) {
            const int lane = std::countr_zero(met), slot = i + lane;
            waiting[slot][counts[slot]++] =
                kAny ? StackEntry{node} << 32 | 1u << child : make_entry(distances[lane], nodes_[node].child[child]);
          }
        }
      }
      for (; some; some &= some - 1) {
        const int slot = std::countr_zero(some);
        std::memcpy(base, waiting[slot], kFew * sizeof(StackEntry));
        if (counts[slot] > kFew) std::memcpy(base, waiting[slot], kAtOnce * sizeof(StackEntry));
        go_on_alone(slot, base, base + counts[slot]);
      }
    }
  }

  HWY_INLINE void go_on_alone(int slot, StackEntry* const base, StackEntry* top) {
    RaySetup setup;
    if (!set_up_ray<kRobust>(as_given_[rays_.place[slot]], layout_.bounds, setup)) return;
    Best<Leaf> best;
    best.t = rays_.limit[slot], best.primitive = rays_.primitive[slot];
    --top;
    if constexpr (kAny) {
      const std::uint32_t word = nodes_[*top >> 32].child[std::countr_zero(static_cast<std::uint32_t>(*top))];
      if (!traverse_any<W, Leaf, kRobust, false>(layout_, setup, base, top, word, best, nullptr)) return;
      rays_.limit[slot] = -kInfinity, rays_.primitive[slot] = 0;
    } else {
      if (!traverse_closest<W, Leaf, kRobust, false>(layout_, setup, base, top, static_cast<std::uint32_t>(*top), best,
                                                     nullptr))
        return;
      rays_.limit[slot] = best.t, rays_.primitive[slot] = best.primitive;
      rays_.triangle[slot] =
          static_cast<std::uint32_t>(best.block - blocks_) * 8 + static_cast<std::uint32_t>(best.lane);
      if constexpr (kRobust)
        rays_.u[slot] = best.u, rays_.v[slot] = best.v, rays_.sum[slot] = best.sum;
      else
        rays_.float_u[slot] = static_cast<float>(best.u), rays_.float_v[slot] = static_cast<float>(best.v);
    }
  }

  /// The box test of single rays; which of two planes is entered first follows from the products.
  HWY_INLINE Mask meets(int i, const float* planes, int stride, V& near) const {
    const RayTag d;
    near = hn::Load(d, rays_.tmin + i);
    auto far = hn::Load(d, rays_.limit + i);
    for (int axis = 0; axis < 3; ++axis) {
      const auto lower = hn::Set(d, planes[2 * axis * stride]), upper = hn::Set(d, planes[(2 * axis + 1) * stride]);
      const auto r = hn::Load(d, rays_.reciprocal[axis] + i);
      const auto entry = hn::Load(d, rays_.entry_add[axis] + i), exit = hn::Load(d, rays_.exit_add[axis] + i);
      near = hn::Max(near, hn::Min(hn::MulAdd(lower, r, entry), hn::MulAdd(upper, r, entry)));
      far = hn::Min(far, hn::Max(hn::MulAdd(lower, r, exit), hn::MulAdd(upper, r, exit)));
    }
    return hn::Le(near, far);
  }

  HWY_INLINE bool robust(const Block& block, int i, Mask active) {
    const RayTag d;
    const auto ox = hn::Load(d, rays_.origin[kx_] + i), oy = hn::Load(d, rays_.origin[ky_] + i),
               oz = hn::Load(d, rays_.origin[kz_] + i);
    const auto shear_x = hn::Load(d, rays_.shear_x + i), shear_y = hn::Load(d, rays_.shear_y + i);
    const auto scale = hn::Load(d, rays_.inverse_z + i);
    bool shorter = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (block.primitive[lane] == layouts::kInvalidPrimitive) continue;
      const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1),
                     c = Leaf::corner(block, lane, 2);
      const auto az = hn::Sub(hn::Set(d, a[kz_]), oz), bz = hn::Sub(hn::Set(d, b[kz_]), oz),
                 cz = hn::Sub(hn::Set(d, c[kz_]), oz);
      const auto ax = hn::Sub(hn::Sub(hn::Set(d, a[kx_]), ox), hn::Mul(shear_x, az));
      const auto bx = hn::Sub(hn::Sub(hn::Set(d, b[kx_]), ox), hn::Mul(shear_x, bz));
      const auto cx = hn::Sub(hn::Sub(hn::Set(d, c[kx_]), ox), hn::Mul(shear_x, cz));
      const auto ay = hn::Sub(hn::Sub(hn::Set(d, a[ky_]), oy), hn::Mul(shear_y, az));
      const auto by = hn::Sub(hn::Sub(hn::Set(d, b[ky_]), oy), hn::Mul(shear_y, bz));
      const auto cy = hn::Sub(hn::Sub(hn::Set(d, c[ky_]), oy), hn::Mul(shear_y, cz));
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

  HWY_INLINE bool fast(const Block& block, int i, Mask active) {
    const RayTag d;
    const auto dx = hn::Load(d, rays_.direction[0] + i), dy = hn::Load(d, rays_.direction[1] + i),
               dz = hn::Load(d, rays_.direction[2] + i);
    bool shorter = false;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (block.primitive[lane] == layouts::kInvalidPrimitive) continue;
      const CornerAt a = Leaf::corner(block, lane, 0), b = Leaf::corner(block, lane, 1),
                     c = Leaf::corner(block, lane, 2);
      const auto e1x = hn::Set(d, b[0] - a[0]), e1y = hn::Set(d, b[1] - a[1]), e1z = hn::Set(d, b[2] - a[2]);
      const auto e2x = hn::Set(d, c[0] - a[0]), e2y = hn::Set(d, c[1] - a[1]), e2z = hn::Set(d, c[2] - a[2]);
      const auto px = hn::Sub(hn::Mul(dy, e2z), hn::Mul(dz, e2y));
      const auto py = hn::Sub(hn::Mul(dz, e2x), hn::Mul(dx, e2z));
      const auto pz = hn::Sub(hn::Mul(dx, e2y), hn::Mul(dy, e2x));
      const auto determinant = dot_without_fusing(d, e1x, e1y, e1z, px, py, pz);
      const auto sx = hn::Sub(hn::Load(d, rays_.origin[0] + i), hn::Set(d, a[0]));
      const auto sy = hn::Sub(hn::Load(d, rays_.origin[1] + i), hn::Set(d, a[1]));
      const auto sz = hn::Sub(hn::Load(d, rays_.origin[2] + i), hn::Set(d, a[2]));
      const auto qx = hn::Sub(hn::Mul(sy, e1z), hn::Mul(sz, e1y));
      const auto qy = hn::Sub(hn::Mul(sz, e1x), hn::Mul(sx, e1z));
      const auto qz = hn::Sub(hn::Mul(sx, e1y), hn::Mul(sy, e1x));
      const auto u = dot_without_fusing(d, sx, sy, sz, px, py, pz);
      const auto v = dot_without_fusing(d, dx, dy, dz, qx, qy, qz);
      const auto w = hn::Sub(hn::Sub(determinant, u), v);
      const auto along = dot_without_fusing(d, e2x, e2y, e2z, qx, qy, qz);
      const auto inside = hn::And(active, hn::And(same_sign(d, u, v, w, along), hn::Ne(determinant, hn::Zero(d))));
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

  const Layout& layout_;
  const WideNode<W>* nodes_;
  const Block* blocks_;
  const Ray* as_given_;
  PacketRays& rays_;
  Frustum frustum_;
  int met_ = 0;  ///< rays that met the last leaf's box
  int kx_ = 0, ky_ = 0, kz_ = 0;
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
