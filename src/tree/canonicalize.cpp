// Canonical form of a binary tree whose nodes stand in any order.
//
// In canonical order the inner node that is met k-th in depth-first order (its rank, from 0) has its children at
// 2 * k + 1 and 2 * k + 2. So a subtree can be written as soon as its rank and its first reference are known, and these
// follow from the sizes of the subtrees before it. The top levels are opened breadth first into some hundred subtrees;
// these are counted in parallel, placed, and written in parallel. O(nodes); explicit stacks only; what comes out does
// not depend on where the tree was cut.
#include <cassert>
#include <cstring>
#include <vector>

#include "boxwood/tree.h"

namespace boxwood::tree {
namespace {

/// Trees of fewer nodes are not cut.
constexpr std::size_t kWorthCutting = 1 << 14;
constexpr std::size_t kSubtrees = 1 << 9;
/// Opening levels ends here whatever the shape: a chain has one node per level.
constexpr int kLevels = 32;

struct Size {
  std::uint32_t inner = 0, references = 0;
};

/// A node of the top of the tree, or the root of a subtree below it.
struct TopNode {
  std::uint32_t input;            ///< its index in the input
  std::uint32_t first_child = 0;  ///< among the top nodes; 0: the subtree is not opened
  Size size{};
  std::uint32_t output = 0, rank = 0, first_reference = 0;
};

std::vector<TopNode> open_top(std::span<const Node> nodes) {
  std::vector<TopNode> top{{.input = 0}};
  if (nodes.size() < kWorthCutting) return top;
  std::size_t level_begin = 0;
  for (int level = 0; level < kLevels && top.size() - level_begin < kSubtrees; ++level) {
    const std::size_t level_end = top.size();
    for (std::size_t i = level_begin; i < level_end; ++i) {
      const Node& node = nodes[top[i].input];
      if (node.is_leaf()) continue;
      top[i].first_child = static_cast<std::uint32_t>(top.size());
      top.push_back({.input = node.first});
      top.push_back({.input = node.first + 1});
    }
    level_begin = level_end;
  }
  return top;
}

Size measure(std::span<const Node> nodes, std::uint32_t root) {
  Size size{};
  std::vector<std::uint32_t> stack;
  std::uint32_t current = root;
  while (true) {
    const Node& node = nodes[current];
    if (!node.is_leaf()) {
      ++size.inner;
      stack.push_back(node.first + 1);
      current = node.first;
      continue;
    }
    size.references += node.count;
    if (stack.empty()) return size;
    current = stack.back();
    stack.pop_back();
  }
}

class Writer {
 public:
  Writer(std::span<const Node> nodes, std::span<const std::uint32_t> references, BinaryTree& tree)
      : nodes_(nodes), references_(references), tree_(tree) {}

  void write_subtree(const TopNode& root) const {
    struct Place {
      std::uint32_t input, output;
    };
    std::vector<Place> stack;
    std::uint32_t rank = root.rank, next_reference = root.first_reference;
    Place current{root.input, root.output};
    while (true) {
      const Node& node = nodes_[current.input];
      if (!node.is_leaf()) {
        const std::uint32_t children = 2 * rank++ + 1;
        tree_.nodes[current.output] = {node.bounds, children, 0};
        stack.push_back({node.first + 1, children + 1});
        current = {node.first, children};
        continue;
      }
      tree_.nodes[current.output] = {node.bounds, next_reference, node.count};
      std::memcpy(tree_.references.data() + next_reference, references_.data() + node.first,
                  node.count * sizeof(std::uint32_t));
      next_reference += node.count;
      if (stack.empty()) return;
      current = stack.back();
      stack.pop_back();
    }
  }

  void write_inner(const TopNode& node) const {
    tree_.nodes[node.output] = {nodes_[node.input].bounds, 2 * node.rank + 1, 0};
  }

 private:
  std::span<const Node> nodes_;
  std::span<const std::uint32_t> references_;
  BinaryTree& tree_;
};

/// Adds up the sizes of opened nodes (children stand after their parents), then hands out places from the root down.
void place(std::vector<TopNode>& top) {
  for (std::size_t i = top.size(); i-- > 0;) {
    if (top[i].first_child == 0) continue;
    const Size &left = top[top[i].first_child].size, &right = top[top[i].first_child + 1].size;
    top[i].size = {left.inner + right.inner + 1, left.references + right.references};
  }
  for (const TopNode& node : top) {
    if (node.first_child == 0) continue;
    TopNode &left = top[node.first_child], &right = top[node.first_child + 1];
    left.output = 2 * node.rank + 1;
    right.output = 2 * node.rank + 2;
    left.rank = node.rank + 1;
    right.rank = left.rank + left.size.inner;
    left.first_reference = node.first_reference;
    right.first_reference = left.first_reference + left.size.references;
  }
}

}  // namespace

BinaryTree canonicalize(std::span<const Node> nodes, std::span<const std::uint32_t> references,
                        std::size_t primitive_count, bool splits_references, Executor& executor) {
  BinaryTree tree;
  tree.primitive_count = primitive_count;
  tree.splits_references = splits_references;
  if (nodes.empty()) return tree;

  std::vector<TopNode> top = open_top(nodes);
  const auto for_subtrees = [&](auto f) {
    executor.for_chunks(top.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      if (top[i].first_child == 0) f(top[i]);
    });
  };
  for_subtrees([&](TopNode& root) { root.size = measure(nodes, root.input); });
  place(top);
  tree.nodes = AlignedBuffer<Node>(2 * static_cast<std::size_t>(top[0].size.inner) + 1);
  tree.references = AlignedBuffer<std::uint32_t>(top[0].size.references);
  assert(tree.references.size() <= references.size());
  const Writer writer(nodes, references, tree);
  for (const TopNode& node : top)
    if (node.first_child != 0) writer.write_inner(node);
  for_subtrees([&](TopNode& root) { writer.write_subtree(root); });
  return tree;
}

}  // namespace boxwood::tree
