// The bottom-up phase of EBBVH: clusters that share an edge merge, in rounds (see edge_clustering.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/build_monitor.h"
#include "builders/parts/merge_forest.h"

namespace boxwood::builders {

/// Two clusters that may merge. Equal ends: the link is of no use any more.
using ClusterLink = mesh::EdgeLink;

/// Which pairs may merge; zero means no limit. A link whose pair may not is dropped for good.
struct GrowthGate {
  double area = 0;         ///< most that the joined box's area may be of the two boxes' areas added
  std::uint32_t size = 0;  ///< most references of a cluster
};

class EdgeClustering {
 public:
  struct Limits {
    std::uint32_t rounds = 0;       ///< 0: as many as it takes
    std::uint32_t pair_cutoff = 1;  ///< the last round is the first that merges fewer pairs
  };
  /// What to do with rounds of many or few links; tests force each way. The clusters are the same for all.
  struct Ways {
    std::size_t parallel_links = std::size_t{1} << 17;  ///< a round of so many is worked on in parallel
    int parallel_threads = 3;     ///< if there are so many threads: it takes twice the work of the sequence
    std::size_t slow_share = 16;  ///< rounds that merge fewer than one in so many links are the heaps' business
  };

  /// `links` by rank, between single references. `forest` may not have merges yet.
  EdgeClustering(MergeForest& forest, AlignedBuffer<ClusterLink> links, const GrowthGate& gate, const Ways& ways,
                 Executor& executor);

  /// Runs all rounds. False: cancelled.
  bool run(const Limits& limits, const BuildMonitor& monitor);

  /// Merged pairs of each round.
  const std::vector<std::uint32_t>& pairs_by_round() const { return pairs_by_round_; }
  std::uint32_t merged() const { return merged_; }
  /// Clusters that were not merged, by number.
  std::vector<std::uint32_t> roots() const;
  std::vector<std::uint32_t> root_of_each_reference() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  bool may_merge(std::uint32_t a, std::uint32_t b) const;
  void merge(std::uint32_t number, std::uint32_t a, std::uint32_t b);
  bool is_root(std::uint32_t cluster) const { return parents_[cluster] == kNone; }
  void merge_round();
  void merge_round_in_parallel();
  std::vector<std::uint32_t> choose_in_parallel();
  bool is_done(const Limits& limits) const;

  MergeForest& forest_;
  AlignedBuffer<ClusterLink> links_;  ///< of the clusters at the start of the last round
  GrowthGate gate_;
  Ways ways_;
  Executor& executor_;
  AlignedBuffer<std::uint32_t> parents_;  ///< kNone: a root
  std::uint32_t merged_ = 0;
  std::vector<std::uint32_t> pairs_by_round_;

  friend class LinkHeaps;
};

}  // namespace boxwood::builders
