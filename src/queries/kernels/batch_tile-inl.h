// A tile's way through the packet kernel: from the caller's rays to its answers. Four neighbours in a row go in and
// out by one transposition of four vectors.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_TILE_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_TILE_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_TILE_INL_H_
#endif

#include <cstring>

#include "queries/kernels/batch_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

/// Where a packet's answers go.
struct PacketAnswers {
  Hit* hits = nullptr;
  Vec3* normals = nullptr;
  std::uint8_t* occluded = nullptr;
};

template <class Leaf>
HWY_INLINE Vec3 normal_at(const Layout& layout, std::uint32_t triangle) {
  const auto* blocks = reinterpret_cast<const typename Leaf::Block*>(layout.triangles.data());
  return triangle_of<Leaf>(blocks[triangle / 8], static_cast<int>(triangle % 8)).normal();
}

/// Divides what is kept times `sum`.
HWY_INLINE void divide_by_sums(PacketRays& rays) {
  using Doubles = hn::CappedTag<double, 8>;
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(dd))) {
    const auto sum = hn::Load(dd, rays.sum + i);
    hn::Store(hn::DemoteTo(df, hn::Div(hn::Load(dd, rays.u + i), sum)), df, rays.float_u + i);
    hn::Store(hn::DemoteTo(df, hn::Div(hn::Load(dd, rays.v + i), sum)), df, rays.float_v + i);
  }
}

/// Four neighbours, all of this pass.
template <bool kAny>
HWY_INLINE void answer_four(const PacketRays& rays, int slot, const PacketAnswers& answers) {
#if HWY_TARGET != HWY_SCALAR
  const FourTag d;
  const hn::RebindToUnsigned<FourTag> du;
  const std::uint32_t place = rays.place[slot];
  const auto primitive = hn::Load(du, rays.primitive + slot);
  const auto hit = hn::RebindMask(d, hn::Ne(primitive, hn::Set(du, layouts::kInvalidPrimitive)));
  if constexpr (kAny) {
    const std::uint32_t bytes = packet_bits(d, hit) * 0x00204081u & 0x01010101u;  // a bit for each
    std::memcpy(answers.occluded + place, &bytes, sizeof bytes);
  } else {
    const auto t = hn::Mul(hn::Load(d, rays.limit + slot), hn::Load(d, rays.t_scale + slot));
    auto a = hn::IfThenElse(hit, t, hn::Set(d, kInfinity));
    auto b = hn::IfThenElseZero(hit, hn::Load(d, rays.float_u + slot));
    auto c = hn::IfThenElseZero(hit, hn::Load(d, rays.float_v + slot));
    auto e = hn::BitCast(d, primitive);
    transpose_four(a, b, c, e);
    float* const to = reinterpret_cast<float*>(answers.hits + place);
    hn::StoreU(a, d, to);
    hn::StoreU(b, d, to + 4);
    hn::StoreU(c, d, to + 8);
    hn::StoreU(e, d, to + 12);
  }
#else
  (void)rays, (void)slot, (void)answers;
#endif
}

template <bool kAny>
HWY_INLINE void answer_one(const PacketRays& rays, int slot, const PacketAnswers& answers) {
  const std::uint32_t place = rays.place[slot];
  const bool hit = rays.primitive[slot] != layouts::kInvalidPrimitive;
  if constexpr (kAny)
    answers.occluded[place] = hit;
  else
    answers.hits[place] =
        !hit ? Hit{}
             : Hit{rays.limit[slot] * rays.t_scale[slot], rays.float_u[slot], rays.float_v[slot], rays.primitive[slot]};
}

/// Writes the answers of the rays with this signature.
template <class Leaf, bool kRobust, bool kAny>
HWY_INLINE void answer(const Layout& layout, PacketRays& rays, float signature, const PacketAnswers& answers) {
  if constexpr (kRobust && !kAny) divide_by_sums(rays);
  for (int slot = 0; slot < PacketRays::kRays; slot += 4) {
    const float* const own = rays.signature + slot;
    const bool all = own[0] == signature && own[1] == signature && own[2] == signature && own[3] == signature;
    if (all && rays.place[slot + 3] != PacketRays::kNowhere) {
      answer_four<kAny>(rays, slot, answers);
      continue;
    }
    for (int i = slot; i < slot + 4; ++i)
      if (rays.place[i] != PacketRays::kNowhere && rays.signature[i] == signature) answer_one<kAny>(rays, i, answers);
  }
  if (kAny || !answers.normals) return;
  for (int slot = 0; slot < PacketRays::kRays; ++slot) {
    if (rays.place[slot] == PacketRays::kNowhere || rays.signature[slot] != signature) continue;
    const bool hit = rays.primitive[slot] != layouts::kInvalidPrimitive;
    answers.normals[rays.place[slot]] = hit ? normal_at<Leaf>(layout, rays.triangle[slot]) : Vec3{};
  }
}

/// One packet, in a pass for each main axis and sense of running along it; more than `kPasses` of them are too many.
template <int W, class Leaf, bool kRobust, bool kAny>
Packet trace_packet(const Layout& layout, const Ray* rays, const Tile& tile, PacketAnswers answers) {
  constexpr int kPasses = 2;
  // Without vectors a packet gains nothing.
  if constexpr (hn::MaxLanes(RayTag()) < 4) return Packet::refused;
  PacketRays packet;
  packet.load(rays, tile);
  packet.prepare();
  const RayTag d;
  const hn::RebindToUnsigned<RayTag> du;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::uint32_t present = packet.signatures_present();
  const std::uint32_t signatures = present >> 1;
  if (std::popcount(signatures) > kPasses) return Packet::refused;
  packet.prepare_boxes(layout.bounds);
  for (int i = 0; i < PacketRays::kRays; i += lanes)
    hn::Store(hn::Set(du, layouts::kInvalidPrimitive), du, packet.primitive + i);
  if constexpr (kRobust && !kAny) packet.clear_locations();
  if (answers.hits) answers.hits += tile.first;
  if (answers.normals) answers.normals += tile.first;
  if (answers.occluded) answers.occluded += tile.first;
  Stack stack(layout.max_stack + W);
  PacketTraversal<W, Leaf, kRobust, kAny> traversal(layout, packet);
  if (present & 1) answer<Leaf, kRobust, kAny>(layout, packet, -1, answers);
  bool holds = true;
  for (std::uint32_t left = signatures; left; left &= left - 1) {
    const int signature = std::countr_zero(left);
    const auto mine = hn::Set(d, static_cast<float>(signature));
    for (int i = 0; i < PacketRays::kRays; i += lanes) {
      const auto active = hn::Eq(hn::Load(d, packet.signature + i), mine);
      hn::Store(hn::IfThenElse(active, hn::Load(d, packet.tmax + i), hn::Set(d, -kInfinity)), d, packet.limit + i);
    }
    if (layout.root != layouts::kNoRoot) holds &= traversal.run(signature, stack.entries());
    answer<Leaf, kRobust, kAny>(layout, packet, static_cast<float>(signature), answers);
  }
  return holds ? Packet::held_together : Packet::fell_apart;
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
