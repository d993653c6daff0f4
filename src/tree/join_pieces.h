// A tree put together from pieces that were made on their own.
#pragma once

#include <span>

#include "boxwood/tree.h"

namespace boxwood::tree {

/// A node of the top of a tree: the parent of two others, or the root of a piece.
struct TopNode {
  Node root;                          ///< of a parent only the box counts
  std::uint32_t left = 0, right = 0;  ///< a parent's children among the top nodes; 0: a piece
  std::uint32_t inner = 0;            ///< inner nodes of a piece
  /// The pairs of their children in canonical order. Where the first one lies by what the nodes say is root.first.
  const Node* pairs = nullptr;
  std::uint32_t first_reference = 0, reference_count = 0;  ///< of a piece, which its leaves divide in order
};

/// The tree below top node number `root`, in canonical form: pieces are copied, each as it is. No node may be reached
/// twice; number 0 may only be the root. O(nodes), the same for every number of threads.
BinaryTree join_pieces(std::span<const TopNode> top, std::uint32_t root, std::span<const std::uint32_t> references,
                       std::size_t primitive_count, Executor& executor);

}  // namespace boxwood::tree
