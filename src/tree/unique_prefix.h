// The first of each id of a leaf, in order.
#pragma once

#include <cstdint>
#include <span>

namespace boxwood::tree {

/// Moves the first occurrence of each id to the front, in the order they stood; returns how many there are.
std::size_t unique_prefix(std::span<std::uint32_t> ids);

}  // namespace boxwood::tree
