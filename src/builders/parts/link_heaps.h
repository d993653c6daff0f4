// Rounds of pairing over shared edges when each changes little: see link_heaps.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "builders/parts/edge_clustering.h"

namespace boxwood::builders {

class LinkHeaps {
 public:
  /// Goes on from where `clustering` stands, and keeps its forest, parents and number of merges up to date.
  explicit LinkHeaps(EdgeClustering& clustering);
  /// One round; returns how many pairs merged.
  std::uint32_t merge_round();

 private:
  static constexpr std::uint32_t kNone = EdgeClustering::kNone;

  std::uint32_t root_of(std::uint32_t cluster);
  std::uint32_t meld(std::uint32_t a, std::uint32_t b);
  /// Takes the best link out of a cluster's heap.
  std::uint32_t take_best(std::uint32_t cluster);

  EdgeClustering& clustering_;
  std::vector<std::uint32_t> best_;             ///< per cluster: the link on top of its heap, or kNone
  std::vector<std::uint32_t> child_, sibling_;  ///< per link, in the heap it is in
  std::vector<std::uint32_t> looking_;          ///< clusters that have links to try in the next round
};

}  // namespace boxwood::builders
