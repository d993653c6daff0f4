// Visits of a sample, counted.
#pragma once

#include <vector>

#include "boxwood/parallel.h"
#include "boxwood/tree.h"
#include "optimizers/sample.h"

namespace boxwood::optimizers {

/// How many of the segments cross each node of a tree that is not empty, and all its parents.
std::vector<std::uint32_t> count_visits(const tree::BinaryTree& tree, std::span<const Segment> segments,
                                        Executor& executor);

}  // namespace boxwood::optimizers
