// How much of a node its two children's boxes share, area-weighted: the quantity behind the overlap penalty of Popov,
// Georgiev, Dimov and Slusallek 2009 (popov2009, equation 5), as a measure of a finished tree. Ratios and sums in
// double precision, in the order of the nodes; O(nodes).
#include <algorithm>
#include <vector>

#include "boxwood/metrics.h"
#include "math/clip.h"
#include "metrics/box_measures.h"

namespace boxwood::metrics {

SiblingOverlap sibling_overlap(const tree::BinaryTree& tree) {
  SiblingOverlap sum;
  double weights = 0;
  for (const tree::Node& node : tree.nodes) {
    if (node.is_leaf()) continue;
    const double area = half_area(node.bounds);
    weights += area;
    const Box shared = intersection(tree.nodes[node.first].bounds, tree.nodes[node.first + 1].bounds);
    if (shared.is_empty()) continue;
    sum.area += half_area(shared);
    if (const double whole = volume(node.bounds); whole > 0) sum.volume += area * (volume(shared) / whole);
  }
  if (!(weights > 0)) return {};
  return {sum.area / weights, sum.volume / weights};
}

double references_per_primitive(const tree::BinaryTree& tree) {
  if (tree.empty()) return 0;
  if (!tree.splits_references) return 1;
  std::vector<std::uint32_t> ids(tree.references.begin(), tree.references.end());
  std::sort(ids.begin(), ids.end());
  const auto primitives = std::unique(ids.begin(), ids.end()) - ids.begin();
  return static_cast<double>(tree.references.size()) / static_cast<double>(primitives);
}

}  // namespace boxwood::metrics
