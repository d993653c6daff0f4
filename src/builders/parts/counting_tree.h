// How a configuration places a set of references, counted over an auxiliary tree: the query of Popov, Georgiev, Dimov
// and Slusallek 2009 (bib key popov2009, section 3.2). Works for planes anywhere.
//
// The tree halves the box of the centroids (Pharr, Jakob and Humphreys' "Middle", pbrt); its nodes know their boxes and
// how many references are below. A query accepts whole nodes where all of a node goes the same way, gives up at one
// whose references can't all be inside a child, and looks further only into the rest: about sqrt(n) nodes.
#pragma once

#include <vector>

#include "builders/parts/counting_table.h"

namespace boxwood::builders {

class CountingTree {
 public:
  /// `planes` are what PlaneBoxes refer to; they outlive the tree.
  CountingTree(std::span<const refs::Reference> references, const CandidatePlanes& planes);

  SideCounts count(const PlaneBox& left, const PlaneBox& right, bool may_split) const;
  SideCounts count(const Configuration& boxes, bool may_split) const;

 private:
  struct Node {
    Box bounds;
    std::uint32_t begin, end;  ///< of its references' boxes
    std::uint32_t skip;        ///< number of the next node that is not below this one
    bool is_leaf;
  };

  const CandidatePlanes& planes_;
  std::vector<Box> boxes_;
  std::vector<Node> nodes_;  ///< depth first
};

}  // namespace boxwood::builders
