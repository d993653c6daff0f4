// Trees over pairs of references. Ranges of more than a few pairs are binned, a pair counting as one reference of the
// average price. For the last few all trees are tried, by dynamic programming over the subsets, with all leaves that
// they can have: at most 25 splits are priced for four pairs, which takes less time than binning them once.
//
// Places: pair i of the final order has ids 2 * i and 2 * i + 1. The split at `mid` puts its children where the driver
// puts them, at 2 * mid and 2 * mid + 1; those of a pair that is taken apart stand behind all of these.
#include "builders/parts/pair_finder.h"

#include <array>
#include <bit>

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

std::uint32_t count_of(const ReferencePair& pair) {
  return pair.second == kNoPartner ? 1 : 2;
}

}  // namespace

PairFinder::PairFinder(ReferenceRanges& ranges, const BuildRange& root, const EdgePairs& pairs,
                       std::span<const refs::Reference> references, const tree::CostModel& cost,
                       std::uint32_t leaf_max)
    : BinnedSahFinder(ranges, root, binned_settings(pairs, references.size(), cost, leaf_max)),
      pairs_(pairs.pairs.span()),
      references_(references),
      traversal_(cost.traversal),
      intersection_(cost.intersection),
      leaf_max_(leaf_max) {}

/// Sets of the pairs of one range, as masks, and the best tree over each.
class PairFinder::FewPairs {
 public:
  FewPairs(const PairFinder& finder, const BuildRange& range) : finder_(finder), first_(range.first) {
    const refs::Reference* const source = finder.ranges().references(range);
    const std::uint32_t count = range.size();
    all_ = (1u << count) - 1;
    for (std::uint32_t i = 0; i < count; ++i) pairs_[i] = source[i].primitive;
    measure(source, count);
    price();
  }

  void write(std::uint32_t slot, tree::Node* nodes, std::uint32_t* ids) const {
    std::array<Place, kFew> waiting;  // right parts: of each depth one
    std::size_t size = 0;
    Place place{all_, first_, slot};
    while (true) {
      const std::uint32_t left = left_[place.set];
      if (left != 0) {
        const std::uint32_t mid = place.first + std::uint32_t(std::popcount(left));
        nodes[place.slot] = {box_[place.set].box(), 2 * mid, 0};
        waiting[size++] = {place.set ^ left, mid, 2 * mid + 1};
        place = {left, place.first, 2 * mid};
        continue;
      }
      if (is_leaf_[place.set])
        write_leaf(place, nodes, ids);
      else
        write_parts(place, nodes, ids);
      if (size == 0) return;
      place = waiting[--size];
    }
  }

 private:
  static constexpr std::uint32_t kSets = 1u << kFew;

  /// A set whose tree is to be written: its first pair's place and its node's.
  struct Place {
    std::uint32_t set, first, slot;
  };

  const ReferencePair& pair(std::uint32_t i) const { return finder_.pairs_[pairs_[i]]; }

  void measure(const refs::Reference* source, std::uint32_t count) {
    const Float4 mask = xyz_mask(), scale = Float4::fill(finder_.scale());
    for (std::uint32_t set = 1; set <= all_; ++set) {
      const auto low = std::uint32_t(std::countr_zero(set));
      const Box4 box = Box4::of(source[low]);
      box_[set] = {box.lower & mask, box.upper};
      if (const std::uint32_t rest = set & (set - 1); rest != 0) box_[set].grow(box_[rest]);
    }
    for (std::uint32_t set = all_ + 1; set <= all_ + 2; ++set) box_[set] = box_[1];  // they are looked at by three
    for (std::uint32_t set = 1; set <= all_; set += 3)
      half_areas((box_[set].upper - box_[set].lower) * scale, (box_[set + 1].upper - box_[set + 1].lower) * scale,
                 (box_[set + 2].upper - box_[set + 2].lower) * scale)
          .store_anywhere(area_ + set);
    for (std::uint32_t i = 0; i < count; ++i) count_[1u << i] = count_of(pair(i));
  }

  void price() {
    const double traversal = finder_.traversal_, intersection = finder_.intersection_;
    const std::uint32_t leaf_max = finder_.leaf_max_;
    for (std::uint32_t set = 1; set <= all_; ++set) {
      const std::uint32_t rest = set & (set - 1), low = set ^ rest;
      double open;  // the price of what is below a node over the set
      std::uint32_t best_left = 0;
      if (rest == 0) {
        const ReferencePair& alone = pair(std::uint32_t(std::countr_zero(low)));
        open = alone.second == kNoPartner ? double(kInfinity) : intersection * (double(alone.parts_area) * area_[set]);
      } else {
        count_[set] = count_[rest] + count_[low];
        open = cost_[rest] + cost_[low];
        best_left = low;
        for (std::uint32_t right = (rest - 1) & rest; right != 0; right = (right - 1) & rest)
          if (const double cost = cost_[right] + cost_[set ^ right]; cost < open) open = cost, best_left = set ^ right;
      }
      const double inner = traversal * area_[set] + open, leaf = intersection * count_[set] * area_[set];
      is_leaf_[set] = count_[set] == 1 || ((leaf_max == 0 || count_[set] <= leaf_max) && leaf <= inner);
      cost_[set] = is_leaf_[set] ? leaf : inner;
      left_[set] = is_leaf_[set] ? 0 : best_left;
    }
  }

  void write_leaf(const Place& place, tree::Node* nodes, std::uint32_t* ids) const {
    std::uint32_t* next = ids + 2 * place.first;
    for (std::uint32_t rest = place.set; rest != 0; rest &= rest - 1) {
      const ReferencePair& one = pair(std::uint32_t(std::countr_zero(rest)));
      *next++ = finder_.references_[one.first].primitive;
      if (one.second != kNoPartner) *next++ = finder_.references_[one.second].primitive;
    }
    nodes[place.slot] = {box_[place.set].box(), 2 * place.first, count_[place.set]};
  }

  /// A pair of which each reference is a leaf.
  void write_parts(const Place& place, tree::Node* nodes, std::uint32_t* ids) const {
    const ReferencePair& one = pair(std::uint32_t(std::countr_zero(place.set)));
    const auto children = std::uint32_t(2 * (finder_.pairs_.size() + place.first));
    nodes[place.slot] = {box_[place.set].box(), children, 0};
    for (const std::uint32_t part : {0u, 1u}) {
      const refs::Reference& reference = finder_.references_[part == 0 ? one.first : one.second];
      ids[2 * place.first + part] = reference.primitive;
      nodes[children + part] = {reference.box(), 2 * place.first + part, 1};
    }
  }

  const PairFinder& finder_;
  std::uint32_t first_, all_;
  std::uint32_t pairs_[kFew];
  // By set. Areas are half and in the finder's scale.
  Box4 box_[kSets + 2];
  float area_[kSets + 4];
  double cost_[kSets];
  std::uint32_t count_[kSets];
  std::uint32_t left_[kSets];  ///< the part that the best tree has on the left; 0: there are no parts
  bool is_leaf_[kSets];
};

void PairFinder::finish(const BuildRange& range, tree::Node* nodes, std::uint32_t* ids) const {
  if (finishes(range)) return FewPairs(*this, range).write(range.slot, nodes, ids);
  const refs::Reference* const source = ranges().references(range);
  std::uint32_t* next = ids + 2 * range.first;
  for (std::uint32_t i = 0; i < range.size(); ++i) {
    const ReferencePair& pair = pairs_[source[i].primitive];
    *next++ = references_[pair.first].primitive;
    if (pair.second != kNoPartner) *next++ = references_[pair.second].primitive;
  }
  nodes[range.slot] = {range.bounds.box(), 2 * range.first, std::uint32_t(next - (ids + 2 * range.first))};
}

}  // namespace boxwood::builders
