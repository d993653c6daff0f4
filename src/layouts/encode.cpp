#include "layouts/encode.h"

#include <algorithm>
#include <vector>

namespace boxwood::layouts {

namespace {

constexpr std::size_t kChunk = 8192;

bool is_usable(std::uint32_t id, const MeshView& mesh) {
  if (id >= mesh.triangle_count) return false;
  const auto corners = mesh.corners(id);
  return std::all_of(corners.begin(), corners.end(), [&](auto corner) { return corner < mesh.vertex_count; });
}

}  // namespace

Status check_references(std::span<const std::uint32_t> references, const MeshView& mesh, Executor& executor) {
  std::vector<std::size_t> bad((references.size() + kChunk - 1) / kChunk, references.size());
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!is_usable(references[i], mesh)) {
        bad[chunk] = i;
        return;
      }
  });
  const auto first = std::find_if(bad.begin(), bad.end(), [&](std::size_t i) { return i < references.size(); });
  if (first == bad.end()) return {};
  const std::uint32_t id = references[*first];
  if (id >= mesh.triangle_count)
    return {ErrorCode::out_of_range, "the tree references triangle " + std::to_string(id) + ", but the mesh has " +
                                         std::to_string(mesh.triangle_count)};
  const auto corners = mesh.corners(id);
  const auto corner =
      *std::find_if(corners.begin(), corners.end(), [&](auto place) { return place >= mesh.vertex_count; });
  return {ErrorCode::out_of_range, "triangle " + std::to_string(id) + " uses vertex " + std::to_string(corner) +
                                       ", but the mesh has " + std::to_string(mesh.vertex_count)};
}

}  // namespace boxwood::layouts
