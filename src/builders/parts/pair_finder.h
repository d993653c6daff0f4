// The split finder over pairs of references: binned as if a pair were one reference, and exact for the last few.
#pragma once

#include <span>

#include "builders/parts/binned_finder.h"
#include "builders/parts/edge_pairs.h"
#include "builders/parts/top_down.h"

namespace boxwood::builders {

class PairFinder : public BinnedSahFinder {
 public:
  /// `ranges` are over the pairs of `pairs`; to a driver each stands for two parts.
  PairFinder(ReferenceRanges& ranges, const BuildRange& root, const EdgePairs& pairs,
             std::span<const refs::Reference> references, const tree::CostModel& cost, std::uint32_t leaf_max);

  bool finishes(const BuildRange& range) const { return range.size() <= kFew; }
  /// The cheapest of all trees over a few pairs; one leaf over more.
  void finish(const BuildRange& range, SubtreeCursor& cursor) const;

 private:
  /// So many have few enough trees to try all.
  static constexpr std::uint32_t kFew = 4;

  class FewPairs;

  /// References lie far apart by now, and mostly one need not look at them.
  std::uint32_t primitive(std::uint32_t reference) const {
    return numbered_ ? reference : references_[reference].primitive;
  }

  void write_pair(const ReferencePair& pair, SubtreeCursor& cursor) const;

  std::span<const ReferencePair> pairs_;
  std::span<const refs::Reference> references_;
  bool numbered_;
  float traversal_, intersection_;
  std::uint32_t leaf_max_;
};

}  // namespace boxwood::builders
