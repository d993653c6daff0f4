// From sorted Morton codes to nodes: what all Morton builders share.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/parallel.h"
#include "boxwood/refs.h"
#include "boxwood/tree.h"
#include "parallel/radix_sort.h"

namespace boxwood::builders {

/// Positions [first, last) of the sorted references. Never empty.
struct MortonRange {
  std::uint32_t first, last;
  std::uint32_t size() const { return last - first; }
};

/// A subtree whose root has no place yet, with its price: the sum over its nodes of area times cost.
struct EmittedSubtree {
  tree::Node root;
  double cost = 0;
};

/// Makes radix trees (see emit_morton.cpp) over ranges of sorted references. A node that divides its range at position
/// m keeps its children at nodes[2 * m - 1] and nodes[2 * m]. Each position between 1 and n - 1 divides at most one
/// range, so threads never meet, and tree::canonicalize closes the gaps afterwards.
class MortonEmitter {
 public:
  struct Leaves {
    std::uint32_t largest = 0;  ///< most references of a leaf, 0 = no limit
    tree::CostModel cost;
  };

  /// `nodes` has two slots per reference. `cancel` may be null.
  MortonEmitter(std::span<const KeyedIndex> order, std::span<const refs::Reference> references, const Leaves& leaves,
                std::span<tree::Node> nodes, const std::atomic<bool>* cancel)
      : order_(order), references_(references), leaves_(leaves), nodes_(nodes), cancel_(cancel) {}

  /// One subtree for each range; the ranges must not overlap. Parallel within and across ranges. When the build is
  /// cancelled on the way, the subtrees are not all there.
  std::vector<EmittedSubtree> emit(std::span<const MortonRange> ranges, Executor& executor) const;

 private:
  struct Split;
  struct Waiting;
  std::uint32_t middle(MortonRange range) const;
  EmittedSubtree leaf(std::uint32_t position) const;
  EmittedSubtree finish(const Split& split, const EmittedSubtree& left, const EmittedSubtree& right) const;
  EmittedSubtree emit_equal(MortonRange range) const;
  EmittedSubtree emit_small(MortonRange range, std::vector<Waiting>& waiting) const;

  std::span<const KeyedIndex> order_;
  std::span<const refs::Reference> references_;
  Leaves leaves_;
  std::span<tree::Node> nodes_;
  const std::atomic<bool>* cancel_;
};

}  // namespace boxwood::builders
