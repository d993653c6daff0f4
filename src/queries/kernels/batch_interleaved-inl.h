// Many rays in flight, in phases: an incoherent ray spends most of its time on mispredicted branches (how many children
// were hit, node or leaf, still near enough or not) and on waiting for memory. Here all rays in flight take one step
// together, and what kind of step it is is sorted out by writing their numbers to lists without a branch:
//
//   1. each ray pops an entry and goes onto the list of nodes, of leaves or of finished rays; an entry that lies behind
//      the ray's best hit is dropped by going onto none; what was popped is prefetched
//   2. nodes: all children are tested, sorted by entry distance with a sorting network and stored on the ray's
//      stack, those that were missed above its new end
//   3. leaves: one block of triangles each; further blocks of the leaf go back onto the stack
//   4. finished rays report and hand their place to the next one
//
// Entry distances lose their three or four lowest bits to the lane's number. They become smaller by that, so an entry
// is never dropped too early. Any-hit rays need no distances: their children stand in the order in which to try them.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_INTERLEAVED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_INTERLEAVED_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_INTERLEAVED_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_INTERLEAVED_INL_H_
#endif

#include <hwy/cache_control.h>

#include <array>

#include "queries/kernels/batch.h"
#include "queries/kernels/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

/// The children of a node that are hit are sorted in one vector, of eight lanes at least.
template <int W>
inline constexpr bool kInterleaves = (W == 8 || W == 16) && HWY_MAX_BYTES >= 32;

#if HWY_MAX_BYTES >= 32
/// For each set of lanes its members, the last one first.
inline constexpr auto kBackwards = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (unsigned bits = 0; bits < 256; ++bits)
    for (unsigned lane = 8, place = 0; lane-- > 0;)
      if (bits >> lane & 1) table[bits][place++] = static_cast<std::uint8_t>(lane);
  return table;
}();

/// Sorts eight keys, largest first, with a bitonic network of six layers, or sixteen with one of ten.
template <class VI>
HWY_INLINE VI sort_descending(VI v) {
  const hn::DFromV<VI> di;
  const hn::RepartitionToWide<decltype(di)> wide;
  const auto by_one = [&](VI x) HWY_ATTR {
    const auto other = hn::Shuffle2301(x);
    return hn::OddEven(hn::Min(x, other), hn::Max(x, other));
  };
  const auto by_pairs = [&](VI x, VI other) HWY_ATTR {
    return hn::BitCast(di, hn::OddEven(hn::BitCast(wide, hn::Min(x, other)), hn::BitCast(wide, hn::Max(x, other))));
  };
  v = by_one(v);
  v = by_one(by_pairs(v, hn::Shuffle0123(v)));
  if constexpr (hn::MaxLanes(di) == 4) return v;
#if HWY_MAX_BYTES >= 64
  if constexpr (hn::MaxLanes(di) == 16) {
    const auto by_blocks = [&](VI x, VI other)
                               HWY_ATTR { return hn::OddEvenBlocks(hn::Min(x, other), hn::Max(x, other)); };
    v = by_blocks(v, hn::SwapAdjacentBlocks(hn::Shuffle0123(v)));
    v = by_one(by_pairs(v, hn::Shuffle1032(v)));
    const auto turned = hn::Reverse(di, v);
    v = hn::ConcatUpperLower(di, hn::Min(v, turned), hn::Max(v, turned));
    v = by_blocks(v, hn::SwapAdjacentBlocks(v));
    return by_one(by_pairs(v, hn::Shuffle1032(v)));
  }
#endif
  const auto turned = hn::Reverse(di, v);
  v = hn::ConcatUpperLower(di, hn::Min(v, turned), hn::Max(v, turned));
  return by_one(by_pairs(v, hn::Shuffle1032(v)));
}

/// The first N lanes of a vector.
template <int N, class V>
HWY_INLINE auto first_lanes(V v) {
  const hn::DFromV<V> d;
  if constexpr (hn::MaxLanes(d) == N)
    return v;
  else
    return first_lanes<N>(hn::LowerHalf(v));
}
/// A vector with zeros behind, so that it has N lanes.
template <int N, class V>
HWY_INLINE auto as_lanes_of(V v) {
  const hn::DFromV<V> d;
  if constexpr (hn::MaxLanes(d) == N)
    return v;
  else
    return as_lanes_of<N>(hn::ZeroExtendVector(hn::Twice<decltype(d)>(), v));
}

template <int W, class Leaf, bool kRobust, bool kAny>
class Interleaved {
 public:
  static constexpr std::uint32_t kFlights = 24;

  Interleaved(const Layout& layout, const Ray* rays, std::size_t count, Hit* hits, Vec3* normals,
              std::uint8_t* occluded)
      : layout_(layout),
        nodes_(reinterpret_cast<const WideNode<W>*>(layout.nodes.data())),
        blocks_(reinterpret_cast<const Block*>(layout.triangles.data())),
        rays_(rays),
        count_(count),
        hits_(hits),
        normals_(normals),
        occluded_(occluded),
        depth_((layout.max_stack + 2 * W + 15) / 16 * 16),
        memory_(std::make_unique_for_overwrite<std::uint32_t[]>(2 * depth_ * kFlights)) {}

  void run() {
    std::uint32_t active[kFlights], active_count = 0;
    for (std::uint32_t slot = 0; slot < kFlights; ++slot) {
      words_[slot] = memory_.get() + 2 * slot * depth_;
      distances_[slot] = reinterpret_cast<float*>(words_[slot] + depth_);
      active[active_count] = slot;
      active_count += start(slot);
    }
    std::uint32_t nodes[kFlights], leaves[kFlights], finished[kFlights];
    while (active_count) {
      std::uint32_t node_count = 0, leaf_count = 0, finished_count = 0;
      for (std::uint32_t i = 0; i < active_count; ++i) {
        const std::uint32_t slot = active[i];
        const std::uint32_t place = --top_[slot];
        const std::uint32_t word = words_[slot][place];
        const bool is_live = kAny || distances_[slot][place] <= flights_[slot].best.t;
        const bool is_leaf = word >> 31, is_end = word == layouts::kNoRoot;
        word_[slot] = word;
        nodes[node_count] = slot, node_count += !is_leaf & is_live;
        leaves[leaf_count] = slot, leaf_count += is_leaf & !is_end & is_live;
        finished[finished_count] = slot, finished_count += is_end;
        prefetch(word, is_leaf);
      }
      for (std::uint32_t i = 0; i < node_count; ++i) visit_node(nodes[i]);
      for (std::uint32_t i = 0; i < leaf_count; ++i) visit_leaf(leaves[i]);
      if (!finished_count) continue;
      bool shrinks = false;
      for (std::uint32_t i = 0; i < finished_count; ++i) {
        report(finished[i]);
        shrinks |= !start(finished[i]);
      }
      if (!shrinks) continue;
      const std::uint32_t before = active_count;
      active_count = 0;
      for (std::uint32_t i = 0; i < before; ++i) {
        const std::uint32_t slot = active[i];
        active[active_count] = slot, active_count += top_[slot] != 0;
      }
    }
  }

 private:
  using Block = typename Leaf::Block;
  struct alignas(64) Flight {
    RaySetup setup;
    Best<Leaf> best;
    std::size_t ray;
  };

  HWY_INLINE void prefetch(std::uint32_t word, bool is_leaf) const {
    // Numbers, since one of the two is no address of anything.
    const std::uintptr_t node = reinterpret_cast<std::uintptr_t>(nodes_) + std::uintptr_t{word} * sizeof(WideNode<W>);
    const std::uintptr_t block =
        reinterpret_cast<std::uintptr_t>(blocks_) + std::uintptr_t{layouts::leaf_first(word)} * sizeof(Block);
    const auto* address = reinterpret_cast<const char*>(is_leaf ? block : node);
    for (int line = 0; line < W / 2; ++line) hwy::Prefetch(address + 64 * line);
  }

  /// Gives the next ray to a place; false when there is none. Rays that can hit nothing are answered here.
  HWY_INLINE bool start(std::uint32_t slot) {
    Flight& flight = flights_[slot];
    for (; next_ < count_; ++next_) {
      if (layout_.root == layouts::kNoRoot || !set_up_ray<kRobust>(rays_[next_], layout_.bounds, flight.setup)) {
        miss(next_);
        continue;
      }
      flight.best = {};
      flight.best.t = flight.setup.tmax;
      flight.ray = next_++;
      words_[slot][0] = layouts::kNoRoot, words_[slot][1] = layout_.root;
      distances_[slot][0] = distances_[slot][1] = 0;
      top_[slot] = 2;
      return true;
    }
    top_[slot] = 0;
    return false;
  }

  HWY_INLINE void miss(std::size_t ray) {
    if constexpr (kAny) {
      occluded_[ray] = 0;
    } else {
      hits_[ray] = {};
      if (normals_) normals_[ray] = {};
    }
  }

  HWY_INLINE void report(std::uint32_t slot) {
    const Flight& flight = flights_[slot];
    if constexpr (kAny) {
      occluded_[flight.ray] = flight.best.block != nullptr;
    } else {
      if (!flight.best.block) return miss(flight.ray);
      hits_[flight.ray] = make_hit(flight.setup, flight.best);
      if (normals_) normals_[flight.ray] = triangle_of<Leaf>(*flight.best.block, flight.best.lane).normal();
    }
  }

  HWY_INLINE void visit_node(std::uint32_t slot) {
    if constexpr (W == hn::MaxLanes(Floats()))
      visit_whole(slot);
    else
      visit_halves(slot);
  }

  using Floats = hn::CappedTag<float, W>;
  using Signed = hn::RebindToSigned<Floats>;
  using Unsigned = hn::RebindToUnsigned<Floats>;

  /// Where the ray enters children from `first` on, and which of them it meets.
  HWY_INLINE hn::Mask<Floats> test(const WideNode<W>& node, int first, std::uint32_t slot,
                                   hn::Vec<Floats>& near) const {
    const Floats d;
    const RaySetup& ray = flights_[slot].setup;
    const auto entry = [&](int axis) HWY_ATTR {
      return hn::MulAdd(hn::Load(d, node.planes[ray.entry_plane[axis]] + first), hn::Set(d, ray.reciprocal[axis]),
                        hn::Set(d, ray.entry_add[axis]));
    };
    const auto exit = [&](int axis) HWY_ATTR {
      return hn::MulAdd(hn::Load(d, node.planes[ray.exit_plane[axis]] + first), hn::Set(d, ray.reciprocal[axis]),
                        hn::Set(d, ray.exit_add[axis]));
    };
    near = hn::Max(hn::Max(entry(0), entry(1)), hn::Max(entry(2), hn::Set(d, ray.tmin)));
    return hn::Le(near, hn::Min(hn::Min(exit(0), exit(1)), hn::Min(exit(2), hn::Set(d, flights_[slot].best.t))));
  }

  /// Entry distances with the lanes' numbers in their lowest bits.
  static HWY_INLINE hn::Vec<Signed> keys_of(hn::Vec<Floats> near, int first) {
    const Signed di;
    return hn::Or(hn::AndNot(hn::Set(di, W - 1), hn::BitCast(di, near)), hn::Iota(di, first));
  }

  /// Those of up to eight lanes that `bits` names, the last one first.
  template <class V>
  static HWY_INLINE V backwards(V v, std::uint64_t bits) {
    const hn::RebindToUnsigned<hn::DFromV<V>> du;
    const hn::Rebind<std::uint8_t, decltype(du)> bytes;
    const auto lanes = hn::PromoteTo(du, hn::Load(bytes, kBackwards[bits].data()));
    return hn::TableLookupLanes(v, hn::IndicesFromVec(hn::DFromV<V>(), lanes));
  }

  HWY_INLINE void visit_whole(std::uint32_t slot) {
    const Floats d;
    const Signed di;
    const Unsigned du;
    const WideNode<W>& node = nodes_[word_[slot]];
    auto near = hn::Zero(d);
    const auto hit = test(node, 0, slot, near);
    const auto children = hn::Load(du, node.child);
    std::uint32_t* const words = words_[slot] + top_[slot];
    if constexpr (kAny && W == 16) {
      const auto turned = hn::MaskFromVec(hn::Reverse(d, hn::VecFromMask(d, hit)));
      hn::StoreU(hn::Compress(hn::Reverse(du, children), hn::RebindMask(du, turned)), du, words);
      top_[slot] += static_cast<std::uint32_t>(hn::CountTrue(d, hit));
    } else if constexpr (kAny) {
      const std::uint64_t bits = mask_bits(d, hit);
      hn::StoreU(backwards(children, bits), du, words);
      top_[slot] += static_cast<std::uint32_t>(std::popcount(bits));
    } else {
      const auto low_bits = hn::Set(di, W - 1);
      const auto keys = keys_of(near, 0);
      if constexpr (W == 16) {
        const std::size_t count = hn::CountTrue(d, hit);
        const auto lookup = [&](auto lanes) HWY_ATTR {
          return hn::TableLookupLanes(children, hn::IndicesFromVec(du, as_lanes_of<16>(lanes)));
        };
        if (HWY_LIKELY(count <= 4))
          return push_few<4>(hn::Compress(keys, hn::RebindMask(di, hit)), lookup, slot, count);
        if (HWY_LIKELY(count <= 8))
          return push_few<8>(hn::Compress(keys, hn::RebindMask(di, hit)), lookup, slot, count);
      }
      const auto sorted = sort_descending(hn::IfThenElse(hn::RebindMask(di, hit), keys, hn::Set(di, -1)));
      hn::StoreU(hn::TableLookupLanes(children, hn::IndicesFromVec(du, hn::BitCast(du, hn::And(sorted, low_bits)))), du,
                 words);
      hn::StoreU(hn::BitCast(d, hn::AndNot(low_bits, sorted)), d, distances_[slot] + top_[slot]);
      top_[slot] += static_cast<std::uint32_t>(hn::CountTrue(d, hit));
    }
  }

  /// Sixteen children in two vectors of eight.
  HWY_INLINE void visit_halves(std::uint32_t slot) {
    const Floats d;
    const Signed di;
    const Unsigned du;
    const WideNode<W>& node = nodes_[word_[slot]];
    auto low_near = hn::Zero(d), high_near = low_near;
    const std::uint64_t low_bits = mask_bits(d, test(node, 0, slot, low_near));
    const std::uint64_t high_bits = mask_bits(d, test(node, 8, slot, high_near));
    const auto low_count = static_cast<std::uint32_t>(std::popcount(low_bits));
    const auto high_count = static_cast<std::uint32_t>(std::popcount(high_bits));
    const auto low = hn::Load(du, node.child), high = hn::Load(du, node.child + 8);
    if constexpr (kAny) {
      std::uint32_t* const words = words_[slot] + top_[slot];
      hn::StoreU(backwards(high, high_bits), du, words);
      hn::StoreU(backwards(low, low_bits), du, words + high_count);
      top_[slot] += low_count + high_count;
    } else {
      const auto low_keys = backwards(keys_of(low_near, 0), low_bits);
      const auto high_keys = backwards(keys_of(high_near, 8), high_bits);
      const auto lookup = [&](auto lanes) HWY_ATTR {
        const auto all = hn::BitCast(di, as_lanes_of<8>(lanes));
        const auto places = hn::IndicesFromVec(du, hn::BitCast(du, hn::And(all, hn::Set(di, 7))));
        return hn::IfThenElse(hn::RebindMask(du, hn::Gt(all, hn::Set(di, 7))), hn::TableLookupLanes(high, places),
                              hn::TableLookupLanes(low, places));
      };
      const std::uint32_t count = low_count + high_count;
      if (HWY_UNLIKELY(count > 8)) return push_many(low_keys, low_count, high_keys, count, node, slot);
      // The high half's behind the low half's.
      const auto behind = hn::Sub(hn::Iota(di, 0), hn::Set(di, static_cast<std::int32_t>(low_count)));
      const auto turn = hn::IndicesFromVec(di, hn::And(behind, hn::Set(di, 7)));
      const auto keys = hn::IfThenElse(hn::Lt(behind, hn::Zero(di)), low_keys, hn::TableLookupLanes(high_keys, turn));
      if (HWY_LIKELY(count <= 4))
        push_few<4>(keys, lookup, slot, count);
      else
        push_few<8>(keys, lookup, slot, count);
    }
  }

  /// Sixteen children of which up to N were hit, whose keys stand first: mostly four at most. Four are sorted in three
  /// layers and eight in six; the ten of sixteen take twice as long each on processors with 256-bit units.
  template <int N, class VI, class Lookup>
  HWY_INLINE void push_few(VI keys, Lookup lookup, std::uint32_t slot, std::size_t count) {
    const hn::CappedTag<std::int32_t, N> di;
    const hn::RebindToUnsigned<decltype(di)> du;
    const hn::RebindToFloat<decltype(di)> d;
    const auto low_bits = hn::Set(di, 15);
    const auto sorted = sort_descending(hn::IfThenElse(hn::FirstN(di, count), first_lanes<N>(keys), hn::Set(di, -1)));
    hn::StoreU(first_lanes<N>(lookup(hn::BitCast(du, hn::And(sorted, low_bits)))), du, words_[slot] + top_[slot]);
    hn::StoreU(hn::BitCast(d, hn::AndNot(low_bits, sorted)), d, distances_[slot] + top_[slot]);
    top_[slot] += static_cast<std::uint32_t>(count);
  }

  /// More than eight, which is rare.
  HWY_NOINLINE void push_many(hn::Vec<Signed> low_keys, std::uint32_t low_count, hn::Vec<Signed> high_keys,
                              std::uint32_t count, const WideNode<W>& node, std::uint32_t slot) {
    const Signed di;
    std::int32_t keys[W + 8];
    hn::StoreU(low_keys, di, keys);
    hn::StoreU(high_keys, di, keys + low_count);
    std::sort(keys, keys + count, [](std::int32_t a, std::int32_t b) { return a > b; });
    for (std::uint32_t i = 0; i < count; ++i, ++top_[slot]) {
      words_[slot][top_[slot]] = node.child[keys[i] & (W - 1)];
      distances_[slot][top_[slot]] = std::bit_cast<float>(keys[i] & ~(W - 1));
    }
  }

  HWY_INLINE void visit_leaf(std::uint32_t slot) {
    Flight& flight = flights_[slot];
    const std::uint32_t word = word_[slot], first = layouts::leaf_first(word), count = layouts::leaf_blocks(word);
    // The entry is still where it was popped, with its distance; the word stands for the blocks behind these.
    constexpr std::uint32_t kAtOnce = Leaf::kPairs ? 2 : 1;
    words_[slot][top_[slot]] = layouts::kLeafBit | (count - kAtOnce - 1) << 28 | (first + kAtOnce);
    top_[slot] += count > kAtOnce;
    if constexpr (Leaf::kPairs)
      Leaf::template two<kRobust, kAny>(blocks_[first], blocks_[first + (count > 1)], flight.setup, flight.best);
    else
      Leaf::template one<kRobust, kAny>(blocks_[first], flight.setup, flight.best);
    if constexpr (kAny) top_[slot] = flight.best.block ? 1 : top_[slot];
  }

  const Layout& layout_;
  const WideNode<W>* nodes_;
  const Block* blocks_;
  const Ray* rays_;
  std::size_t count_, next_ = 0;
  Hit* hits_;
  Vec3* normals_;
  std::uint8_t* occluded_;
  std::size_t depth_;
  std::unique_ptr<std::uint32_t[]> memory_;
  std::uint32_t* words_[kFlights];
  float* distances_[kFlights];
  std::uint32_t top_[kFlights], word_[kFlights];
  Flight flights_[kFlights];
};

#endif  // at least eight lanes

template <int W, class Leaf, bool kRobust>
void interleaved_closest(const Layout& layout, const Ray* rays, std::size_t count, Hit* hits, Vec3* normals) {
#if HWY_MAX_BYTES >= 32
  if constexpr (kInterleaves<W>)
    return Interleaved<W, Leaf, kRobust, false>(layout, rays, count, hits, normals, nullptr).run();
#endif
  closest<W, Leaf, kRobust, false>(layout, rays, count, hits, normals, nullptr);
}

template <int W, class Leaf, bool kRobust>
void interleaved_any(const Layout& layout, const Ray* rays, std::size_t count, std::uint8_t* occluded) {
#if HWY_MAX_BYTES >= 32
  if constexpr (kInterleaves<W>)
    return Interleaved<W, Leaf, kRobust, true>(layout, rays, count, nullptr, nullptr, occluded).run();
#endif
  any<W, Leaf, kRobust, false>(layout, rays, count, occluded, nullptr);
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
