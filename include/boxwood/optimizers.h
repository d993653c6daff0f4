// Tree to tree: better binary trees, and wide ones.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "boxwood/base.h"
#include "boxwood/parallel.h"
#include "boxwood/tree.h"

namespace boxwood::optimizers {

/// What a wide tree is priced with: a node visit against a test of one block of `block` primitives.
struct CollapseOptions {
  int width = 8;            ///< children per node, 2 to 16
  int block = 4;            ///< primitives tested at once, 1 to 16
  int max_leaf_blocks = 2;  ///< leaves hold at most block * this references, 1 to 8
  float node_cost = 1.0f;   ///< relative to one block test, > 0
  /// Blocks that a leaf over these references takes, where their number alone does not say it; empty: their number over
  /// `block`, rounded up, which is also the least it may say. Called from several threads at once.
  std::function<std::uint32_t(std::span<const std::uint32_t> references)> leaf_blocks = {};
};

/// The cheapest tree of the given width that can be made by merging nodes of a binary tree and turning subtrees into
/// leaves, by dynamic programming over the surface area cost with whole blocks (Ylitie, Karras and Laine 2017; Pinto
/// 2010). Leaves larger than the limit are cut into chunks. O(nodes * width^2), deterministic, any depth.
Result<tree::WideTree> collapse_to_wide(const tree::BinaryTree& tree, const CollapseOptions& options,
                                        Executor& executor);

}  // namespace boxwood::optimizers
