// Trees over pairs of references. Ranges of more than a few pairs are binned, a pair counting as one reference of the
// average price. For the last few all trees are tried, by dynamic programming over the subsets, with all leaves that
// they can have: at most 25 splits are priced for four pairs, which takes less time than binning them once.
#include "builders/parts/pair_finder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace boxwood::builders {
namespace {

BinnedSahFinder::Settings binned_settings(const EdgePairs& pairs, std::size_t references, const tree::CostModel& cost,
                                          std::uint32_t leaf_max) {
  BinnedSahFinder::Settings settings;
  settings.cost = cost;
  settings.cost.intersection *= float(double(references) / double(pairs.pairs.size()));
  settings.leaf_max = leaf_max == 0 ? 0 : std::max(1u, leaf_max / 2);
  return settings;
}

}  // namespace

PairFinder::PairFinder(ReferenceRanges& ranges, const BuildRange& root, const EdgePairs& pairs,
                       std::span<const refs::Reference> references, const tree::CostModel& cost, std::uint32_t leaf_max)
    : BinnedSahFinder(ranges, root, binned_settings(pairs, references.size(), cost, leaf_max)),
      pairs_(pairs.pairs.span()),
      references_(references),
      numbered_(pairs.numbered),
      traversal_(cost.traversal),
      intersection_(cost.intersection),
      leaf_max_(leaf_max) {}

/// Sets of the pairs of one range, as masks, and the best tree over each.
class PairFinder::FewPairs {
 public:
  FewPairs(const PairFinder& finder, const BuildRange& range) : finder_(finder) {
    const refs::Reference* const source = finder.ranges().references(range);
    const std::uint32_t count = range.size();
    all_ = (1u << count) - 1;
    for (std::uint32_t i = 0; i < count; ++i) {
      pairs_[i] = source[i].primitive;
      __builtin_prefetch(&pair(i));
      parts_area_[i] = EdgePairs::parts_area(source[i]);
      count_[1u << i] = parts_area_[i] == 0 ? 1 : 2;
    }
    if (count == 1) find<1>(source);
    if (count == 2) find<2>(source);
    if (count == 3) find<3>(source);
    if (count == kFew) find<kFew>(source);
  }

  void write(std::uint32_t slot, SubtreeCursor& cursor) const {
    std::array<Place, kFew> waiting;  // right parts: of each depth one
    std::size_t size = 0;
    Place place{all_, slot};
    while (true) {
      const std::uint32_t left = left_[place.set];
      if (left != 0) {
        const std::uint32_t children = cursor.take_pair();
        cursor.nodes[place.slot] = {box_[place.set].box(), children, 0};
        waiting[size++] = {place.set ^ left, children + 1};
        place = {left, children};
        continue;
      }
      if (is_leaf_[place.set])
        write_leaf(place, cursor);
      else
        write_parts(place, cursor);
      if (size == 0) return;
      place = waiting[--size];
    }
  }

 private:
  static constexpr std::uint32_t kSets = 1u << kFew;

  /// A set whose tree is to be written, and its node's place.
  struct Place {
    std::uint32_t set, slot;
  };

  const ReferencePair& pair(std::uint32_t i) const { return finder_.pairs_[pairs_[i]]; }

  /// Boxes and areas of all sets of the first `kCount` pairs.
  template <std::uint32_t kCount>
  void measure(const refs::Reference* source) {
    const Float4 mask = xyz_mask(), scale = Float4::fill(finder_.scale());
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Box4 box = Box4::of(source[i]);
      box_[1u << i] = {box.lower & mask, box.upper};
      for (std::uint32_t rest = 1; rest < 1u << i; ++rest) {
        box_[1u << i | rest] = box_[1u << i];
        box_[1u << i | rest].grow(box_[rest]);
      }
    }
    constexpr std::uint32_t kAll = (1u << kCount) - 1;
    const auto extent = [&](std::uint32_t set) {
      const Box4& box = box_[std::min(set, kAll)];
      return (box.upper - box.lower) * scale;
    };
    for (std::uint32_t set = 1; set <= kAll; set += 3)
      half_areas(extent(set), extent(set + 1), extent(set + 2)).store_anywhere(area_ + set);
  }

  /// A price and what it is for, in an integer that is ordered by price. Prices are not negative.
  static std::uint64_t priced(float cost, std::uint32_t left) {
    return std::uint64_t(std::bit_cast<std::uint32_t>(cost)) << 32 | left;
  }

  /// The cheapest tree over a set whose parts have theirs. Without branches: nothing here can be foretold.
  template <std::uint32_t kSet>
  void price_set(float traversal, float intersection, std::uint32_t leaf_max) {
    constexpr std::uint32_t kRest = kSet & (kSet - 1), kLow = kSet ^ kRest;
    float open = 0;  // the price of what is below a node over the set
    std::uint32_t best_left = 0;
    if constexpr (kRest == 0) {
      open = intersection * (parts_area_[std::countr_zero(kSet)] * area_[kSet]);
    } else {
      count_[kSet] = count_[kRest] + count_[kLow];
      std::uint64_t best = priced(cost_[kLow] + cost_[kRest], kLow);
      const auto try_right = [&]<std::uint32_t kRight>() {
        if constexpr (kRight != 0 && kRight != kRest && (kRight & ~kRest) == 0)
          best = std::min(best, priced(cost_[kSet ^ kRight] + cost_[kRight], kSet ^ kRight));
      };
      [&]<std::uint32_t... kRights>(std::integer_sequence<std::uint32_t, kRights...>) {
        (try_right.template operator()<kRights>(), ...);
      }
      (std::make_integer_sequence<std::uint32_t, kRest>());
      open = std::bit_cast<float>(std::uint32_t(best >> 32));
      best_left = std::uint32_t(best);
    }
    const float inner = traversal * area_[kSet] + open, leaf = intersection * float(count_[kSet]) * area_[kSet];
    const bool is_leaf = (count_[kSet] == 1) | ((count_[kSet] <= leaf_max) & (leaf <= inner));
    is_leaf_[kSet] = is_leaf;
    cost_[kSet] = is_leaf ? leaf : inner;
    left_[kSet] = is_leaf ? 0 : best_left;
  }

  template <std::uint32_t kCount>
  void find(const refs::Reference* source) {
    measure<kCount>(source);
    const float traversal = finder_.traversal_, intersection = finder_.intersection_;
    const std::uint32_t leaf_max = finder_.leaf_max_ == 0 ? 2 * kFew : finder_.leaf_max_;
    [&]<std::uint32_t... kSets>(std::integer_sequence<std::uint32_t, kSets...>) {
      (price_set<kSets + 1>(traversal, intersection, leaf_max), ...);
    }
    (std::make_integer_sequence<std::uint32_t, (1u << kCount) - 1>());
  }

  void write_leaf(const Place& place, SubtreeCursor& cursor) const {
    cursor.nodes[place.slot] = {box_[place.set].box(), cursor.next_id, count_[place.set]};
    for (std::uint32_t rest = place.set; rest != 0; rest &= rest - 1)
      finder_.write_pair(pair(std::uint32_t(std::countr_zero(rest))), cursor);
  }

  /// A pair of which each reference is a leaf.
  void write_parts(const Place& place, SubtreeCursor& cursor) const {
    const ReferencePair& one = pair(std::uint32_t(std::countr_zero(place.set)));
    const std::uint32_t children = cursor.take_pair();
    cursor.nodes[place.slot] = {box_[place.set].box(), children, 0};
    for (const std::uint32_t part : {0u, 1u}) {
      const refs::Reference& reference = finder_.references_[part == 0 ? one.first : one.second];
      cursor.nodes[children + part] = {reference.box(), cursor.next_id, 1};
      cursor.ids[cursor.next_id++] = reference.primitive;
    }
  }

  const PairFinder& finder_;
  std::uint32_t all_;
  std::uint32_t pairs_[kFew];
  float parts_area_[kFew];
  // By set. Areas are half and in the finder's scale.
  Box4 box_[kSets];
  float area_[kSets + 4];
  float cost_[kSets];
  std::uint32_t count_[kSets];
  std::uint32_t left_[kSets];  ///< the part that the best tree has on the left; 0: there are no parts
  bool is_leaf_[kSets];
};

void PairFinder::write_pair(const ReferencePair& pair, SubtreeCursor& cursor) const {
  cursor.ids[cursor.next_id++] = primitive(pair.first);
  if (pair.second != kNoPartner) cursor.ids[cursor.next_id++] = primitive(pair.second);
}

void PairFinder::finish(const BuildRange& range, SubtreeCursor& cursor) const {
  if (finishes(range)) return FewPairs(*this, range).write(range.slot, cursor);
  const refs::Reference* const source = ranges().references(range);
  const std::uint32_t first = cursor.next_id;
  for (std::uint32_t i = 0; i < range.size(); ++i) write_pair(pairs_[source[i].primitive], cursor);
  cursor.nodes[range.slot] = {range.bounds.box(), first, cursor.next_id - first};
}

}  // namespace boxwood::builders
