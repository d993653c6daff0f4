// The binary tree every builder gives and every optimizer and layout takes. Stores ids and boxes only.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/math.h"
#include "boxwood/parallel.h"

namespace boxwood::tree {

/// Prices of the surface area heuristic, in any common unit. Valid: 0 <= traversal <= 1e6, 0 < intersection <= 1e6.
struct CostModel {
  float traversal = 1.0f;     ///< C_T: visiting an inner node
  float intersection = 1.5f;  ///< C_I: testing one primitive reference
};

/// 32 bytes. Inner: count == 0, children at nodes[first] and nodes[first + 1]. Leaf: count > 0, its primitives are
/// references[first] to references[first + count - 1].
struct Node {
  Box bounds;
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  bool is_leaf() const { return count != 0; }
};
static_assert(sizeof(Node) == 32);

/// A binary bounding volume hierarchy in canonical form: nodes[0] is the root; nodes are numbered depth first, left
/// before right, the two children of a node side by side (a node's children are numbered when it is first visited);
/// references are in depth-first leaf order, so that each subtree owns one contiguous range of them. Equal trees
/// therefore have equal arrays. An empty tree has no nodes.
struct BinaryTree {
  AlignedBuffer<Node> nodes;
  AlignedBuffer<std::uint32_t> references;  ///< primitive ids
  std::size_t primitive_count = 0;          ///< ids are below this
  bool splits_references = false;           ///< a primitive may be referenced more than once
  /// What its builder found worth telling, a name and a number each ("roots after round 1"). Not part of the hash.
  std::vector<std::pair<std::string, double>> notes = {};

  bool empty() const { return nodes.empty(); }
  Box bounds() const { return empty() ? Box{} : nodes[0].bounds; }
  std::size_t bytes() const { return nodes.bytes() + references.bytes(); }
};

/// Puts a tree whose nodes may stand in any order, with unused ones between (as parallel builders leave them), into
/// canonical form. `nodes[0]` is the root of the input. References are permuted to leaf order. O(nodes).
BinaryTree canonicalize(std::span<const Node> nodes, std::span<const std::uint32_t> references,
                        std::size_t primitive_count, bool splits_references, Executor& executor);

/// Takes further references to a primitive out of each leaf that has the primitive already, as it happens when parts of
/// one primitive meet again in a leaf (Dammertz and Keller 2008). The first of each stays; boxes and nodes are as
/// before. Canonical in, canonical out. O(references).
void remove_duplicates(BinaryTree& tree);

/// A tree of up to `width` children per node, ready to be encoded. Children are in the order of the binary tree.
struct WideTree {
  struct Child {
    Box bounds;
    std::uint32_t first = 0;  ///< inner: index of the node; leaf: first reference
    std::uint32_t count = 0;  ///< 0: inner; else references of the leaf
  };
  int width = 0;
  Box bounds;
  LargeVector<std::uint32_t> first_child;  ///< per node, plus one at the end: children[first_child[n]] to [n + 1]
  LargeVector<Child> children;
  LargeVector<std::uint32_t> references;  ///< primitive ids by leaf, no id twice in one leaf
  std::size_t max_stack = 0;              ///< most entries a depth-first traversal can have waiting at once
};

/// Shape of a tree. Depth of the root is 0.
struct Statistics {
  std::size_t nodes = 0, inner = 0, leaves = 0, references = 0;
  std::size_t max_depth = 0, max_leaf = 0;
  double average_leaf = 0, average_leaf_depth = 0;
  std::vector<std::size_t> leaf_histogram;  ///< [n] = leaves of n references
};
Statistics statistics(const BinaryTree& tree);

/// 64-bit hash of the nodes and references. Trees are equal bit for bit when their hashes are (up to 2^-64).
std::uint64_t hash(const BinaryTree& tree);

/// What `validate` holds a tree against. Boxes of primitives are asked for through `primitive_box`.
struct Expectation {
  /// Box of each primitive that must be in the tree, indexed by id; an empty box says "must not be in the tree".
  std::span<const Box> primitive_boxes = {};
  std::size_t max_leaf = 0;  ///< 0 = no limit
};
/// Walks the whole tree and gives the first contradiction as an error that names the node: canonical numbering, each
/// node once, children inside their parent and the parent no larger than both, leaves non-empty and in order, each
/// expected primitive exactly once (at least once when references are split) with its box inside the leaf (or touching
/// it, when split, the pieces together covering it on each axis), no unexpected one, no leaf above max_leaf.
/// Iterative: any depth. O(nodes + references).
Status validate(const BinaryTree& tree, const Expectation& expectation);

}  // namespace boxwood::tree
