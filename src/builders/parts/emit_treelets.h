// The upper part of an HLBVH: a tree over the roots of treelets, divided by the surface area heuristic.
#pragma once

#include <span>

#include "boxwood/builders.h"
#include "builders/parts/emit_morton.h"

namespace boxwood::builders {

/// Joins treelets into one tree, whose root goes to nodes[0]. `ranges` are their references and `treelets` their roots,
/// as the emitter made them: in Morton order, not empty. Looks at the options `bins` and `axes`. False when cancelled.
bool join_treelets(std::span<const MortonRange> ranges, std::span<const EmittedSubtree> treelets,
                   const OptionValues& options, const BuildContext& context, std::span<tree::Node> nodes);

}  // namespace boxwood::builders
