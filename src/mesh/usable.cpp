// A mesh whose vertices are all usable, as nearly all are, has no other triangles; only else each one is looked at.
// O(n).
#include "mesh/usable.h"

#include "mesh/chunks.h"

namespace boxwood::mesh {
namespace {

bool is_usable_vertex(Vec3 p) {
  return std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
         std::fabs(p.z) <= kLargestCoordinate;
}

}  // namespace

std::vector<std::uint8_t> find_unusable(const MeshView& mesh, Executor& executor) {
  std::vector<std::uint8_t> bad_chunks(chunk_count(mesh.vertex_count));
  executor.for_chunks(mesh.vertex_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    bool usable = true;
    for (std::size_t v = begin; v < end; ++v) usable &= is_usable_vertex(mesh.vertex(v));
    bad_chunks[chunk] = !usable;
  });
  bool all_usable = true;
  for (const std::uint8_t bad : bad_chunks) all_usable &= !bad;
  if (all_usable) return {};
  std::vector<std::uint8_t> unusable(mesh.triangle_count);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) unusable[t] = !mesh::is_usable(mesh.triangle(t));
  });
  return unusable;
}

}  // namespace boxwood::mesh
