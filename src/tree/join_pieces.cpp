#include "tree/join_pieces.h"

#include <algorithm>
#include <vector>

namespace boxwood::tree {
namespace {

/// Where there are many pieces they are small, and a thread copies up to so many in one go.
constexpr std::size_t kMostInOneGo = 8, kChunksWanted = 256;

/// A top node, in preorder, with the size of its subtree and its place in the tree.
struct Placed {
  const TopNode* from;
  std::uint32_t left = 0, right = 0;  ///< among the placed ones; 0: a piece
  std::uint32_t inner = 0, references = 0;
  std::uint32_t output = 0;  ///< where its node goes
  std::uint32_t rank = 0;    ///< inner nodes before it
  std::uint32_t first_reference = 0;
};

LargeVector<Placed> in_preorder(std::span<const TopNode> top, std::uint32_t root) {
  struct Open {
    std::uint32_t node;
    std::uint32_t right_of;  ///< the placed parent of a right child; 0 else, as the root has no parent
    bool is_right;
  };
  LargeVector<Placed> placed;
  placed.reserve(top.size());
  std::vector<Open> open{{root, 0, false}};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const auto place = static_cast<std::uint32_t>(placed.size());
    if (next.is_right) placed[next.right_of].right = place;
    const TopNode& node = top[next.node];
    placed.push_back({.from = &node});
    if (node.right == 0) continue;
    placed.back().left = place + 1;
    open.push_back({node.right, place, true});
    open.push_back({node.left, 0, false});
  }
  return placed;
}

/// Adds up sizes from the pieces to the root, then hands out places from the root to the pieces.
void place(LargeVector<Placed>& nodes) {
  for (std::size_t i = nodes.size(); i-- > 0;) {
    Placed& node = nodes[i];
    if (node.right == 0) {
      node.inner = node.from->inner;
      node.references = node.from->reference_count;
    } else {
      node.inner = nodes[node.left].inner + nodes[node.right].inner + 1;
      node.references = nodes[node.left].references + nodes[node.right].references;
    }
  }
  for (const Placed& node : nodes) {
    if (node.right == 0) continue;
    Placed &left = nodes[node.left], &right = nodes[node.right];
    left.output = 2 * node.rank + 1;
    right.output = 2 * node.rank + 2;
    left.rank = node.rank + 1;
    right.rank = left.rank + left.inner;
    left.first_reference = node.first_reference;
    right.first_reference = left.first_reference + left.references;
  }
}

void write(const Placed& placed, std::span<const std::uint32_t> references, BinaryTree& tree) {
  const TopNode& top = *placed.from;
  const std::uint32_t children = 2 * placed.rank + 1;
  if (placed.right != 0) {
    tree.nodes[placed.output] = {top.root.bounds, children, 0};
    return;
  }
  // Unsigned differences: what is added may wrap around.
  const std::uint32_t further = children - top.root.first, back = placed.first_reference - top.first_reference;
  const auto moved = [&](const Node& node) {
    return Node{node.bounds, node.first + (node.is_leaf() ? back : further), node.count};
  };
  tree.nodes[placed.output] = moved(top.root);
  Node* const out = tree.nodes.data() + children;
  for (std::uint32_t n = 0; n < 2 * top.inner; ++n) out[n] = moved(top.pairs[n]);
  std::copy_n(references.begin() + top.first_reference, top.reference_count,
              tree.references.begin() + placed.first_reference);
}

}  // namespace

BinaryTree join_pieces(std::span<const TopNode> top, std::uint32_t root, std::span<const std::uint32_t> references,
                       std::size_t primitive_count, Executor& executor) {
  LargeVector<Placed> placed = in_preorder(top, root);
  place(placed);
  BinaryTree tree;
  tree.primitive_count = primitive_count;
  tree.nodes = AlignedBuffer<Node>(2 * std::size_t{placed[0].inner} + 1);
  tree.references = AlignedBuffer<std::uint32_t>(placed[0].references);
  const std::size_t in_one_go = std::clamp<std::size_t>(placed.size() / kChunksWanted, 1, kMostInOneGo);
  executor.for_chunks(placed.size(), in_one_go, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) write(placed[i], references, tree);
  });
  return tree;
}

}  // namespace boxwood::tree
