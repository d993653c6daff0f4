// When a range of references becomes a leaf: the one place that compares a leaf's cost with a split's.
#pragma once

#include <cstdint>

#include "boxwood/tree.h"

namespace boxwood::builders {

/// Surface area heuristic (Goldsmith and Salmon 1987; MacDonald and Booth 1990). Areas may be scaled by any common
/// factor: the parent's is on both sides of the comparison, so nothing is divided and an area of zero makes a leaf.
class LeafRule {
 public:
  /// `leaf_max` = 0: no limit.
  LeafRule(const tree::CostModel& cost, std::uint32_t leaf_max)
      : traversal_(cost.traversal), intersection_(cost.intersection), leaf_max_(leaf_max) {}

  bool may_be_leaf(std::uint32_t count) const { return leaf_max_ == 0 || count <= leaf_max_; }

  /// A leaf however good the best split is: even children that cost nothing would not pay for their parent.
  bool is_always_leaf(std::uint32_t count) const { return may_be_leaf(count) && intersection_ * count <= traversal_; }

  /// `children_cost` is area * count of both children of the best split, added.
  bool prefers_leaf(std::uint32_t count, double area, double children_cost) const {
    return may_be_leaf(count) && intersection_ * (count * area) <= traversal_ * area + intersection_ * children_cost;
  }

 private:
  double traversal_, intersection_;
  std::uint32_t leaf_max_;
};

}  // namespace boxwood::builders
