// From a binary tree to a layout.
#pragma once

#include "boxwood/layouts.h"
#include "boxwood/optimizers.h"

namespace boxwood {

/// Collapses where the layout is a wide one, then encodes. Of the options, node_cost, max_leaf_blocks and node_weights
/// count; the others follow from the layout.
Result<layouts::Layout> encode_tree(layouts::LayoutId id, const tree::BinaryTree& tree, const MeshView& mesh,
                                    optimizers::CollapseOptions options, Executor& executor);

}  // namespace boxwood
