#include "boxwood/tree.h"

namespace boxwood::tree {

std::uint64_t hash(const BinaryTree& tree) {
  const std::uint64_t nodes = hash_bytes(tree.nodes.data(), tree.nodes.bytes());
  return hash_bytes(tree.references.data(), tree.references.bytes(), nodes);
}

}  // namespace boxwood::tree
