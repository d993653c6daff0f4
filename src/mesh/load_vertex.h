// Vertices in registers.
#pragma once

#include <cstring>

#include "boxwood/mesh.h"
#include "math/float4.h"

namespace boxwood::mesh {

/// The three floats of vertices, and whatever follows them.
class VertexLoader {
 public:
  /// `largest`: of the vertices that will be loaded, one of the mesh.
  VertexLoader(const MeshView& mesh, std::uint32_t largest)
      : positions_(static_cast<const char*>(mesh.positions)),
        stride_(mesh.vertex_stride),
        is_last_(largest + std::size_t{1} >= mesh.vertex_count) {}

  Float4 operator()(std::uint32_t vertex) const {
    const char* const place = positions_ + vertex * stride_;
    if (!is_last_) return Float4::load_anywhere(place);
    float v[4] = {};  // no byte behind the last vertex may be read
    std::memcpy(v, place, 12);
    return Float4::load_anywhere(v);
  }

 private:
  const char* positions_;
  std::size_t stride_;
  bool is_last_;
};

}  // namespace boxwood::mesh
