// A vertex in a register.
#pragma once

#include "boxwood/mesh.h"
#include "math/float4.h"

namespace boxwood::mesh {

/// The three floats of a vertex, and whatever follows them.
inline Float4 load_vertex(const MeshView& mesh, std::uint32_t vertex) {
  const auto* place = static_cast<const char*>(mesh.positions) + vertex * mesh.vertex_stride;
  if (vertex + 1 < mesh.vertex_count) return Float4::load_anywhere(place);
  const Vec3 last = mesh.vertex(vertex);  // no byte behind it may be read
  return Float4::of(last.x, last.y, last.z);
}

}  // namespace boxwood::mesh
