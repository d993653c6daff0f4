// Measures of a tree that need no rays.
#pragma once

#include "boxwood/tree.h"

namespace boxwood::metrics {

/// Exp(T): the expected cost of a ray that meets the root's box and never ends (MacDonald and Booth 1990; Goldsmith and
/// Salmon 1987): the sum over inner nodes of area(node) / area(root) * traversal plus the sum over leaves of
/// area(leaf) / area(root) * references * intersection, in double precision. A root without area counts its own nodes
/// as if all areas were equal. Zero for an empty tree.
double surface_area_cost(const tree::BinaryTree& tree, const tree::CostModel& cost = {});

}  // namespace boxwood::metrics
