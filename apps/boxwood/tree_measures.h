// The measures of a tree that build --metrics and correlate report.
#pragma once

#include "boxwood/metrics.h"
#include "session.h"

namespace boxwood::program {

struct TreeMeasures {
  metrics::Estimate end_point_overlap, leaf_count_variability;
  metrics::SiblingOverlap sibling_overlap;
  double references_per_primitive = 0;
};

/// Leaf counts are those of 65,536 random lines through the box. `samples` as metrics::end_point_overlap has it.
TreeMeasures measure_tree(const tree::BinaryTree& tree, const MeshView& mesh, const tree::CostModel& cost,
                          std::size_t samples, Executor& executor);

/// One key for each number.
Json measures_json(const TreeMeasures& measures);

}  // namespace boxwood::program
