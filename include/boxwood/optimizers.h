// Tree to tree: better binary trees, and wide ones.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/math.h"
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
  /// What takes the place of each node's area, one for each node of the binary tree: how often rays visit it, in any
  /// unit. Finite, not negative, no larger than the parent's. Empty: the areas. Not owned.
  std::span<const float> node_weights = {};
};

/// The cheapest tree of the given width that can be made by merging nodes of a binary tree and turning subtrees into
/// leaves, by dynamic programming over the surface area cost with whole blocks (Ylitie, Karras and Laine 2017; Pinto
/// 2010). Leaves larger than the limit are cut into chunks. O(nodes * width^2), deterministic, any depth.
Result<tree::WideTree> collapse_to_wide(const tree::BinaryTree& tree, const CollapseOptions& options,
                                        Executor& executor);

/// A binary tree with the wide tree's leaves split down to single references: children are merged pair by pair, the
/// smallest common box first, leaves are cut where the surface area cost is least. `reference_boxes` are those of
/// `wide.references`, inside their leaves. Any width and leaf size. Errors: a number of boxes that does not fit, out of
/// memory. Deterministic, any depth.
Result<tree::BinaryTree> expand_to_binary(const tree::WideTree& wide, std::span<const Box> reference_boxes,
                                          std::size_t primitive_count, bool splits_references, Executor& executor);

/// How often rays visit each node, as shares of the rays that visit the root: measured with segments, which are rays
/// whose tmax is where they ended, and `prior` rays more at each node that go as the surface area says. What
/// CollapseOptions::node_weights takes. Segments without a direction or interval count for nothing. The same for every
/// executor. Error: out of memory.
Result<std::vector<float>> node_visits(const tree::BinaryTree& tree, std::span<const Ray> segments, float prior,
                                       Executor& executor);

struct RestructureOptions {
  int passes = 3;     ///< at most; ends early when nothing changes any more
  float prior = 8;    ///< as for node_visits
};

/// The tree with its treelets rebuilt for fewer visits by `segments` (as for node_visits). The same references and
/// leaves; the same for every executor. Error: out of memory.
Result<tree::BinaryTree> restructure(const tree::BinaryTree& tree, std::span<const Ray> segments,
                                     const RestructureOptions& options, Executor& executor);

}  // namespace boxwood::optimizers
