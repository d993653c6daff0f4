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
#include "tree/join_pieces.h"

namespace boxwood::builders {

/// Positions [first, last) of the sorted references. Never empty.
struct MortonRange {
  std::uint32_t first, last;
  std::uint32_t size() const { return last - first; }
};

/// Makes radix trees (see emit_morton.cpp) over ranges of sorted references, as pieces for tree::join_pieces.
class MortonEmitter {
 public:
  struct Leaves {
    std::uint32_t largest = 0;  ///< most references of a leaf, 0 = no limit
    tree::CostModel cost;
  };

  /// `cancel` may be null.
  MortonEmitter(std::span<const KeyedIndex> order, std::span<const refs::Reference> references, const Leaves& leaves,
                const std::atomic<bool>* cancel)
      : order_(order), references_(references), leaves_(leaves), primitives_(order.size()), cancel_(cancel) {}

  /// Makes a subtree for each range; the ranges are in order and do not overlap. Appends to `top`, which must have a
  /// node already, and returns the numbers that the subtrees' roots have there. The pieces are good as long as the
  /// emitter; to be called once. Parallel within and across ranges. When the build is cancelled on the way, the
  /// subtrees are not all there.
  LargeVector<std::uint32_t> emit(std::span<const MortonRange> ranges, LargeVector<tree::TopNode>& top,
                                  Executor& executor);

  /// The primitives of the references in their sorted order, where subtrees have been made.
  std::span<const std::uint32_t> primitives() const { return primitives_.span(); }

 private:
  struct Split;
  struct Subtree;
  struct Writer;
  std::uint32_t middle(MortonRange range) const;

  std::span<const KeyedIndex> order_;
  std::span<const refs::Reference> references_;
  Leaves leaves_;
  std::vector<AlignedBuffer<tree::Node>> pairs_;  ///< what the pieces point to
  AlignedBuffer<std::uint32_t> primitives_;
  const std::atomic<bool>* cancel_;
};

}  // namespace boxwood::builders
