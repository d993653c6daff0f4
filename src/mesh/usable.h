// Triangles that can't be used, found by looking at the vertices first.
#pragma once

#include <cstdint>
#include <vector>

#include "boxwood/mesh.h"

namespace boxwood::mesh {

/// Flags of the triangles that can't be used; empty when all can.
std::vector<std::uint8_t> find_unusable(const MeshView& mesh, Executor& executor);

}  // namespace boxwood::mesh
