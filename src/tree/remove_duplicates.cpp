// In-leaf removal of duplicate references (Dammertz and Keller 2008, bib key evh, section 2.3).
#include <cstring>

#include "boxwood/tree.h"
#include "tree/unique_prefix.h"

namespace boxwood::tree {

void remove_duplicates(BinaryTree& tree) {
  // Leaves own their references in depth-first order, which is not the order of the nodes: each leaf is closed up on
  // its own first, then all move together in the order of the references.
  std::vector<std::uint32_t> leaf_at(tree.references.size());
  for (std::size_t n = 0; n < tree.nodes.size(); ++n)
    if (tree.nodes[n].is_leaf()) leaf_at[tree.nodes[n].first] = static_cast<std::uint32_t>(n);
  std::uint32_t* const ids = tree.references.data();
  std::uint32_t next = 0;
  for (std::size_t first = 0; first < tree.references.size();) {
    Node& leaf = tree.nodes[leaf_at[first]];
    const std::size_t count = unique_prefix({ids + first, leaf.count});
    first += leaf.count;
    std::memmove(ids + next, ids + leaf.first, count * sizeof *ids);
    leaf.first = next;
    leaf.count = static_cast<std::uint32_t>(count);
    next += leaf.count;
  }
  tree.references.truncate(next);
}

}  // namespace boxwood::tree
