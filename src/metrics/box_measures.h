// Areas and volumes in double precision: boxes of any float size neither overflow nor vanish.
#pragma once

#include <cstdint>

#include "boxwood/math.h"
#include "boxwood/tree.h"

namespace boxwood::metrics {

inline double side(const Box& box, int axis) {
  return static_cast<double>(box.upper[axis]) - box.lower[axis];
}
inline double half_area(const Box& box) {
  const double x = side(box, 0), y = side(box, 1), z = side(box, 2);
  return x * y + y * z + z * x;
}
inline double volume(const Box& box) {
  return side(box, 0) * side(box, 1) * side(box, 2);
}

/// What a node costs each time it is visited.
inline double visit_cost(const tree::Node& node, const tree::CostModel& cost) {
  return node.is_leaf() ? static_cast<double>(node.count) * cost.intersection : cost.traversal;
}

}  // namespace boxwood::metrics
