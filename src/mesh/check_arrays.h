// The part of mesh::check_indices that does not look at any triangle.
#pragma once

#include "boxwood/mesh.h"

namespace boxwood::mesh {

/// Refuses what check_indices refuses, but for indices past the vertices. O(1).
Status check_arrays(const MeshView& mesh);

}  // namespace boxwood::mesh
