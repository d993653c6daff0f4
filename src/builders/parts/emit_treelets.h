// The upper part of an HLBVH: a tree over the roots of treelets, divided by the surface area heuristic.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "boxwood/builders.h"
#include "tree/join_pieces.h"

namespace boxwood::builders {

/// Joins the treelets whose roots have these numbers in `top` into one tree, appending its nodes there. Not empty.
/// Looks at the options `bins` and `axes`. Returns the root's number; none when cancelled.
std::optional<std::uint32_t> join_treelets(std::span<const std::uint32_t> treelets, const OptionValues& options,
                                           const BuildContext& context, LargeVector<tree::TopNode>& top);

}  // namespace boxwood::builders
