// Triangles of one leaf as quads: which of them share an edge, and blocks of four quads made of them.
#pragma once

#include <cstdint>
#include <span>

#include "boxwood/layouts.h"

namespace boxwood::layouts {

/// Fills all quad_blocks(references, mesh) blocks of a leaf.
void fill_quads(QuadBlock* blocks, std::span<const std::uint32_t> references, const MeshView& mesh);

}  // namespace boxwood::layouts
