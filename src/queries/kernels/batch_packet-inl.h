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
#include "queries/kernels/batch_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

template <int W, class Leaf, bool kRobust, bool kAny>
class PacketTraversal : PacketTriangles<Leaf, kRobust, kAny> {
 public:
  using Triangles = PacketTriangles<Leaf, kRobust, kAny>;
  using Block = typename Leaf::Block;
  using V = hn::Vec<RayTag>;
  using Mask = hn::Mask<RayTag>;

  PacketTraversal(const Layout& layout, PacketRays& rays)
      : Triangles(reinterpret_cast<const Block*>(layout.triangles.data()), rays),
        layout_(layout),
        nodes_(reinterpret_cast<const WideNode<W>*>(layout.nodes.data())) {}

  /// Traces the rays whose limit is not below zero; they share this signature. False when they have gone on alone.
  HWY_INLINE bool run(int signature, StackEntry* const stack) {
    static constexpr int kNext[] = {1, 2, 0};
    const int kz = signature >> 1, kx = kNext[kz], ky = kNext[kx];
    rays_.template prepare_triangles<kRobust>(kx, ky, kz);
    this->begin(kx, ky, kz);
    if (!frustum_.enclose(rays_, layout_.bounds, kx, ky, kz, signature & 1)) return true;
    if (layout_.root & layouts::kLeafBit) {
      float planes[6];
      for (int axis = 0; axis < 3; ++axis)
        planes[2 * axis] = layout_.bounds.lower[axis], planes[2 * axis + 1] = layout_.bounds.upper[axis];
      visit_leaf(layout_.root, planes, 1);
      return true;
    }
    return traverse(stack);
  }

 private:
  using Triangles::blocks_, Triangles::kz_, Triangles::rays_;

  /// A leaf costs as much as some rays that visit it alone. What the packet has saved or lost at leaves is summed up,
  /// and it ends when there is nothing left of what it starts with.
  static constexpr int kCredit = 16, kLeafPrice = 4;
  /// So many rays at a leaf are tested one by one.
  static constexpr int kFewRays = 3;

  HWY_INLINE bool traverse(StackEntry* const stack) {
    StackEntry* top = stack;
    int credit = kCredit;
    std::uint32_t node_index = layout_.root;
    alignas(64) float entry[W];
    for (;;) {
      const WideNode<W>& node = nodes_[node_index];
      const std::uint32_t hit = frustum_.template test<W>(node, entry);
      push(node, node_index, hit, entry, top);
      for (;;) {
        if (top == stack) return true;
        --top;
        if (entry_distance(*top) > frustum_.length()) continue;
        const auto place = static_cast<std::uint32_t>(*top);
        const WideNode<W>& parent = nodes_[place / W];
        const std::uint32_t word = parent.child[place % W];
        if (!(word & layouts::kLeafBit)) {
          node_index = word;
          break;
        }
        if (visit_leaf(word, &parent.planes[0][0] + place % W, W)) return true;
        credit += met_ - kLeafPrice;
        if (credit < 0) {
          hand_over(stack, top);
          return false;
        }
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
    Meeting meeting;
    met_ = 0;
    auto near = hn::Zero(d);
    for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto active = meets(i, planes, stride, near);
      const std::size_t count = hn::CountTrue(d, active);
      meeting.first_ray[meeting.count] = i, meeting.active[meeting.count] = active;
      meeting.count += count != 0;
      met_ += static_cast<int>(count);
    }
    if (meeting.count == 0) return false;
    bool shorter = false;
    if (met_ <= kFewRays) {
      shorter = test_one_by_one(begin, end, meeting);
    } else {
      for (const Block* block = begin; block != end; ++block) shorter |= this->test(*block, meeting);
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
    Stack own(layout_.max_stack + kAtOnce + W);  // sorted, they may wait while a subtree from higher up is gone through
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
        if constexpr (!kAny) sort_farthest_first(base, base + counts[slot]);
        go_on_alone(slot, base, base + counts[slot]);
      }
    }
  }

  /// The packet's order is no ray's own, and rays that meet the nearest first visit fewer. Mostly these are two or
  /// three.
  static HWY_INLINE void sort_farthest_first(StackEntry* const begin, StackEntry* const end) {
    for (StackEntry* e = begin + 1; e < end; ++e) {
      const StackEntry moved = *e;
      StackEntry* place = e;
      for (; place != begin && place[-1] < moved; --place) place[0] = place[-1];
      *place = moved;
    }
  }

  HWY_INLINE void go_on_alone(int slot, StackEntry* const base, StackEntry* top) {
    Alone ray(rays_, slot, kz_);
    --top;
    if constexpr (kAny) {
      const std::uint32_t word = nodes_[*top >> 32].child[std::countr_zero(static_cast<std::uint32_t>(*top))];
      traverse_any<W, Leaf, kRobust, false>(layout_, ray.setup, base, top, word, ray.best, nullptr);
    } else {
      const auto word = static_cast<std::uint32_t>(*top);
      traverse_closest<W, Leaf, kRobust, false>(layout_, ray.setup, base, top, word, ray.best, nullptr);
    }
    this->take(slot, ray.best);
  }

  /// A leaf that few rays meet: vectors of its triangles rather than of the rays.
  HWY_INLINE bool test_one_by_one(const Block* begin, const Block* end, const Meeting& meeting) {
    bool shorter = false;
    for (int k = 0; k < meeting.count; ++k)
      for (std::uint32_t bits = packet_bits(RayTag(), meeting.active[k]); bits; bits &= bits - 1) {
        const int slot = meeting.first_ray[k] + std::countr_zero(bits);
        Alone ray(rays_, slot, kz_);
        test_leaf<Leaf, kRobust, kAny>(begin, end, ray.setup, ray.best);
        shorter |= this->take(slot, ray.best);
      }
    return shorter;
  }

  /// A ray of the packet as the kernels of single rays want it.
  struct Alone {
    RaySetup setup;
    Best<Leaf> best;
    HWY_INLINE Alone(const PacketRays& rays, int slot, int kz) {
      rays.set_up_alone<kRobust>(slot, kz, setup);
      best.t = rays.limit[slot], best.primitive = rays.primitive[slot];
    }
  };

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

  const Layout& layout_;
  const WideNode<W>* nodes_;
  Frustum frustum_;
  int met_ = 0;  ///< rays that met the last leaf's box
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
