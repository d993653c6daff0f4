// Binary tree to wide tree of least surface area cost (Ylitie, Karras and Laine 2017, bib key ylitie2017; Pinto 2010,
// bib key pinto2010). forest_costs.cpp chooses; this file makes the tree those choices describe: wide nodes numbered
// depth first, so that a node's first inner child directly follows it, children from left to right, each with the
// references of its subtree as one range. O(nodes * width^2), deterministic, iterative: any depth.
#include <array>
#include <cmath>
#include <new>
#include <string>

#include "boxwood/optimizers.h"
#include "optimizers/forest_costs.h"
#include "optimizers/leaf_chunks.h"
#include "tree/unique_prefix.h"

namespace boxwood::optimizers {
namespace {

constexpr std::uint32_t kNoChild = 0xffffffffu;

/// A wide node still to be made: from an inner node of the binary tree, or from a part of a leaf above the limit.
struct Pending {
  std::uint32_t node;
  std::uint32_t first, count;  ///< its references
  std::uint32_t child;         ///< the child record that shall point to it
  std::uint32_t waiting;       ///< entries a traversal can have waiting beside this node
};

class Emitter {
 public:
  Emitter(const tree::BinaryTree& tree, const CollapseOptions& options, const ForestCosts& costs)
      : tree_(tree), costs_(costs), width_(options.width), largest_leaf_(largest_leaf(options)) {
    out_.width = options.width;
    out_.bounds = tree.nodes[0].bounds;
    // Never more children than leaves, and inner nodes have several: what is not needed is not touched.
    out_.children.reserve(tree.nodes.size() / 2);
    out_.first_child.reserve(tree.nodes.size() / 4);
  }

  tree::WideTree run() && {
    const tree::Node& root = tree_.nodes[0];
    const Pending whole{0, 0, count_of(root), kNoChild, 0};
    if (is_leaf(root)) {
      begin_node(whole);
      add_leaf(whole.node, whole.first, whole.count);
      finish_node(whole);
    } else {
      pending_.push_back(whole);
    }
    while (!pending_.empty()) {
      const Pending node = pending_.back();
      pending_.pop_back();
      begin_node(node);
      open(node);
      finish_node(node);
    }
    out_.first_child.push_back(std::uint32_t(out_.children.size()));
    out_.max_stack = std::size_t(most_waiting_) + 1;
    own_references();
    return std::move(out_);
  }

 private:
  std::uint32_t count_of(const tree::Node& node) const {
    return node.is_leaf() ? node.count : costs_.counts[ForestCosts::pair_of(node)];
  }
  /// Does the node, taken as one tree, become a leaf?
  bool is_leaf(const tree::Node& node) const {
    return node.is_leaf() ? node.count <= largest_leaf_ : costs_.choices[ForestCosts::pair_of(node)].is_leaf();
  }

  void begin_node(const Pending& node) {
    if (node.child != kNoChild) out_.children[node.child].first = std::uint32_t(out_.first_child.size());
    out_.first_child.push_back(std::uint32_t(out_.children.size()));
    first_pending_ = pending_.size();
  }

  void finish_node(const Pending& node) {
    const auto children = std::uint32_t(out_.children.size()) - out_.first_child.back();
    const std::uint32_t waiting = node.waiting + children - 1;
    most_waiting_ = std::max(most_waiting_, waiting);
    // The children were found from left to right and shall leave the stack that way.
    std::reverse(pending_.begin() + std::ptrdiff_t(first_pending_), pending_.end());
    for (std::size_t p = first_pending_; p < pending_.size(); ++p) pending_[p].waiting = waiting;
  }

  void add_leaf(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    out_.children.push_back({tree_.nodes[node].bounds, first, count});
  }
  void add_inner(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    pending_.push_back({node, first, count, std::uint32_t(out_.children.size()), 0});
    out_.children.push_back({tree_.nodes[node].bounds, 0, 0});
  }

  /// The children of a wide node: the forest of `width` trees of its binary node, from left to right.
  void open(const Pending& wide) {
    struct Part {
      std::uint32_t node, first;
      int trees;
    };
    std::array<Part, kLargestWidth> parts;  // together they have at most `width` trees
    std::size_t size = 0;
    const auto split = [&](std::uint32_t node, std::uint32_t first, int trees) {
      const std::uint32_t left = tree_.nodes[node].first;
      const int left_trees = costs_.choices[ForestCosts::pair_of(tree_.nodes[node])].left_trees(trees);
      parts[size++] = {left + 1, first + count_of(tree_.nodes[left]), trees - left_trees};
      parts[size++] = {left, first, left_trees};
    };
    if (tree_.nodes[wide.node].is_leaf()) return add_chunks(wide.node, wide.first, wide.count, width_);
    split(wide.node, wide.first, width_);
    while (size > 0) {
      const auto [n, first, trees] = parts[--size];
      const tree::Node& node = tree_.nodes[n];
      if (is_leaf(node) && !(trees > 1 && opens(node, trees))) {
        add_leaf(n, first, count_of(node));
      } else if (node.is_leaf()) {
        add_chunks(n, first, node.count, trees);
      } else if (opens(node, trees)) {
        split(n, first, trees);
      } else {
        add_inner(n, first, count_of(node));
      }
    }
  }

  /// Leaves made of whole subtrees may have got several parts of one primitive; one reference is enough.
  void own_references() {
    out_.references.assign(tree_.references.begin(), tree_.references.end());
    if (!tree_.splits_references) return;
    std::size_t next = 0;
    LargeVector<std::uint32_t> references(out_.references.size());
    for (tree::WideTree::Child& child : out_.children) {
      if (child.count == 0) continue;
      const std::span<std::uint32_t> ids = std::span(out_.references).subspan(child.first, child.count);
      child.count = std::uint32_t(tree::unique_prefix(ids));
      child.first = std::uint32_t(next);
      std::copy_n(ids.begin(), child.count, references.begin() + std::ptrdiff_t(next));
      next += child.count;
    }
    references.resize(next);
    out_.references = std::move(references);
  }

  bool opens(const tree::Node& node, int trees) const {
    return !node.is_leaf() && costs_.choices[ForestCosts::pair_of(node)].is_opened(trees);
  }

  /// A part of a binary leaf above the limit as a forest of so many trees.
  void add_chunks(std::uint32_t node, std::uint32_t first, std::uint32_t count, int trees) {
    const std::uint64_t chunks = divide_up(count, largest_leaf_);
    const auto roots = std::min(std::uint64_t(trees), chunks);
    ChunkForest forest(chunks, roots, std::uint64_t(width_));
    const std::uint64_t end = std::uint64_t(first) + count;
    for (std::uint64_t begin = first, tree = 0; tree < roots; ++tree) {
      const std::uint64_t below = forest.next(), size = std::min(below * largest_leaf_, end - begin);
      if (below == 1) {
        add_leaf(node, std::uint32_t(begin), std::uint32_t(size));
      } else {
        add_inner(node, std::uint32_t(begin), std::uint32_t(size));
      }
      begin += size;
    }
  }

  const tree::BinaryTree& tree_;
  const ForestCosts& costs_;
  int width_;
  std::uint32_t largest_leaf_;
  tree::WideTree out_;
  std::vector<Pending> pending_;
  std::size_t first_pending_ = 0;  // of the node being made
  std::uint32_t most_waiting_ = 0;
};

Status check_option(const char* name, int value, int lowest, int highest) {
  if (value >= lowest && value <= highest) return {};
  return {ErrorCode::out_of_range, std::string("collapse option ") + name + " is " + std::to_string(value) +
                                       ", valid are " + std::to_string(lowest) + " to " + std::to_string(highest)};
}

Status check_options(const CollapseOptions& options) {
  if (auto status = check_option("width", options.width, 2, kLargestWidth); !status) return status;
  if (auto status = check_option("block", options.block, 1, 16); !status) return status;
  if (auto status = check_option("max_leaf_blocks", options.max_leaf_blocks, 1, 8); !status) return status;
  if (options.node_cost > 0 && std::isfinite(options.node_cost)) return {};
  return {ErrorCode::out_of_range,
          "collapse option node_cost is " + std::to_string(options.node_cost) + ", it must be finite and above 0"};
}

}  // namespace

Result<tree::WideTree> collapse_to_wide(const tree::BinaryTree& tree, const CollapseOptions& options,
                                        Executor& executor) try {
  if (auto status = check_options(options); !status) return status.error();
  if (tree.empty()) {
    tree::WideTree empty;
    empty.width = options.width;
    empty.first_child.push_back(0);
    return empty;
  }
  if (!options.node_weights.empty() && options.node_weights.size() != tree.nodes.size())
    return Error{ErrorCode::invalid_argument, "the binary tree has " + std::to_string(tree.nodes.size()) +
                                                  " nodes but there are weights of " +
                                                  std::to_string(options.node_weights.size())};
  const auto costs = price_forests(tree, options, executor);
  if (!costs) return costs.error();
  return Emitter(tree, options, *costs).run();
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::out_of_memory,
               "not enough memory to collapse a binary tree of " + std::to_string(tree.nodes.size()) + " nodes"};
}

}  // namespace boxwood::optimizers
