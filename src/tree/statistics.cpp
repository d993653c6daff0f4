// Shape of a tree, by one walk with a stack of its own.
#include <algorithm>

#include "boxwood/tree.h"

namespace boxwood::tree {

Statistics statistics(const BinaryTree& tree) {
  Statistics result;
  result.nodes = tree.nodes.size();
  result.references = tree.references.size();
  if (tree.empty()) return result;

  struct Visit {
    std::uint32_t node;
    std::size_t depth;
  };
  std::vector<Visit> stack{{0, 0}};
  double depths = 0;
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Node& node = tree.nodes[visit.node];
    result.max_depth = std::max(result.max_depth, visit.depth);
    if (!node.is_leaf()) {
      ++result.inner;
      stack.push_back({node.first + 1, visit.depth + 1});
      stack.push_back({node.first, visit.depth + 1});
      continue;
    }
    ++result.leaves;
    depths += static_cast<double>(visit.depth);
    if (node.count >= result.leaf_histogram.size()) result.leaf_histogram.resize(node.count + std::size_t{1});
    ++result.leaf_histogram[node.count];
  }
  result.max_leaf = result.leaf_histogram.size() - 1;
  result.average_leaf = static_cast<double>(result.references) / static_cast<double>(result.leaves);
  result.average_leaf_depth = depths / static_cast<double>(result.leaves);
  return result;
}

}  // namespace boxwood::tree
