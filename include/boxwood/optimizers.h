// Tree to tree: better binary trees, and wide ones.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
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

// ---- Binary trees -------------------------------------------------------------------------------------------------

/// Most passes that `reinsert` takes.
inline constexpr int kMostReinsertionPasses = 1000;

struct ReinsertionOptions {
  int passes = 16;  ///< at most, 0 to kMostReinsertionPasses
  /// The part of the nodes, the dearest ones, that a pass looks for better places of, above 0 to 1.
  float share = 0.25f;
  /// Passes end after one that takes less than this part off the summed prices of the inner nodes, 0 to 1.
  float least_gain = 0.001f;
  /// What an inner node with this box costs, in any unit; a box that holds another must not cost less. Empty: its
  /// surface area. Called from several threads at once.
  std::function<float(const Box&)> price = {};
};

struct ReinsertionReport {
  int passes = 0;                            ///< made
  std::size_t moves = 0;                     ///< subtrees put elsewhere, in all passes
  double price_before = 0, price_after = 0;  ///< summed over inner nodes
};

/// Takes subtrees out of a binary tree and puts them where the tree costs less, until that gains too little (Bittner,
/// Hapala and Havran 2013; Meister and Bittner 2018). Leaves stay as they are. Canonical in, canonical out; never
/// dearer than before; the same bits for every executor. O(nodes) searches per pass, parallel. Errors: an option out of
/// range, out of memory.
Result<tree::BinaryTree> reinsert(tree::BinaryTree&& tree, const ReinsertionOptions& options, Executor& executor,
                                  ReinsertionReport* report = nullptr);

/// One option of an optimizer, a number from `lowest` to `highest`.
struct OptimizerOption {
  const char* key;          ///< "passes"
  const char* description;  ///< one line
  double default_value = 0, lowest = 0, highest = 0;
  bool integer = false;
};

struct Optimizer;

/// One row of the registry of optimizers.
struct OptimizerInfo {
  const char* id;       ///< "reinsertion"
  const char* summary;  ///< one line
  const char* paper;    ///< bib key(s) in docs/references.bib
  std::span<const OptimizerOption> options;
  /// Makes a better tree; adds notes of what it did. Null: leaves the tree as it is.
  Result<tree::BinaryTree> (*apply)(tree::BinaryTree&& tree, const Optimizer& optimizer, Executor& executor);
};

/// All optimizers of binary trees, in the order they are listed to people; the first is `none`.
std::span<const OptimizerInfo> optimizer_registry();

/// An optimizer with a value for each of its options. The default is `none`.
struct Optimizer {
  Optimizer();
  const OptimizerInfo* info;   ///< never null
  std::vector<double> values;  ///< in the order of info->options

  bool is_none() const { return info->apply == nullptr; }
  double value(std::string_view key) const;  ///< the key must exist
  /// What parse_optimizer reads, every option with its value: "reinsertion:passes=16,share=0.25,gain=0.001".
  std::string text() const;
};

/// Reads "none", "reinsertion", "reinsertion:passes=4": an id of the registry, then options after the first colon or
/// comma. Errors name the value and list what there is.
Result<Optimizer> parse_optimizer(std::string_view text);

/// Runs an optimizer. The same bits for every executor. Errors: out of memory.
Result<tree::BinaryTree> apply_optimizer(tree::BinaryTree&& tree, const Optimizer& optimizer, Executor& executor);

// ---- Measured rays ------------------------------------------------------------------------------------------------

/// A binary tree with the wide tree's leaves, or these split down to single references (`splits_leaves`): children are
/// merged pair by pair, the smallest common box first, leaves are cut where the surface area cost is least.
/// `reference_boxes` are those of `wide.references`, inside their leaves. Any width and leaf size. Errors: a number of
/// boxes that does not fit, out of memory. Deterministic, any depth.
Result<tree::BinaryTree> expand_to_binary(const tree::WideTree& wide, std::span<const Box> reference_boxes,
                                          std::size_t primitive_count, bool splits_references, Executor& executor,
                                          bool splits_leaves = true);

/// How often rays visit each node, as shares of the rays that visit the root: measured with segments, which are rays
/// whose tmax is where they ended, and `prior` rays more at each node that go as the surface area says. What
/// CollapseOptions::node_weights takes. Segments without a direction or interval count for nothing. The same for every
/// executor. Error: out of memory.
Result<std::vector<float>> node_visits(const tree::BinaryTree& tree, std::span<const Ray> segments, float prior,
                                       Executor& executor);

struct RestructureOptions {
  int passes = 3;   ///< at most; ends early when nothing changes any more
  float prior = 8;  ///< as for node_visits
};

/// The tree with its treelets rebuilt for fewer visits by `segments` (as for node_visits). The same references and
/// leaves; the same for every executor. Error: out of memory.
Result<tree::BinaryTree> restructure(const tree::BinaryTree& tree, std::span<const Ray> segments,
                                     const RestructureOptions& options, Executor& executor);

}  // namespace boxwood::optimizers
