// Expected cost of a ray through a tree by the surface area heuristic: Goldsmith and Salmon 1987 (goldsmith1987),
// MacDonald and Booth 1990 (macdonald1990). Not normalised by C_T; area ratios and the sum in double precision, in
// the order of the nodes.
#include "boxwood/metrics.h"
#include "metrics/box_measures.h"

namespace boxwood::metrics {

double surface_area_cost(const tree::BinaryTree& tree, const tree::CostModel& cost) {
  if (tree.empty()) return 0;
  const double root_area = half_area(tree.nodes[0].bounds);
  double sum = 0;
  for (const tree::Node& node : tree.nodes) {
    const double share = root_area > 0 ? half_area(node.bounds) / root_area : 1.0;
    sum += share * visit_cost(node, cost);
  }
  return sum;
}

}  // namespace boxwood::metrics
