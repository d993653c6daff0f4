#include "layouts/encode.h"

namespace boxwood::layouts {

Status check_references(std::span<const std::uint32_t> references, const MeshView& mesh) {
  for (std::uint32_t id : references) {
    if (id >= mesh.triangle_count)
      return {ErrorCode::out_of_range, "the tree references triangle " + std::to_string(id) + ", but the mesh has " +
                                           std::to_string(mesh.triangle_count)};
    for (std::uint32_t corner : mesh.corners(id))
      if (corner >= mesh.vertex_count)
        return {ErrorCode::out_of_range, "triangle " + std::to_string(id) + " uses vertex " + std::to_string(corner) +
                                             ", but the mesh has " + std::to_string(mesh.vertex_count)};
  }
  return {};
}

}  // namespace boxwood::layouts
