// From a binary tree to a layout.
#pragma once

#include "boxwood/layouts.h"
#include "boxwood/optimizers.h"

namespace boxwood {

/// Collapses where the layout is a wide one, then encodes. `node_weights`: what CollapseOptions takes; a node visit is
/// priced dearer with them, since what is measured leaves out visits that the surface area cost counts twice.
Result<layouts::Layout> encode_tree(layouts::LayoutId id, const tree::BinaryTree& tree, const MeshView& mesh,
                                    std::span<const float> node_weights, Executor& executor);

}  // namespace boxwood
