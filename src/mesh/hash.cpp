// Hash of a mesh: corner positions of fixed blocks of triangles, then the blocks' hashes in order. O(triangles).
#include "boxwood/mesh.h"
#include "mesh/chunks.h"

namespace boxwood::mesh {

std::uint64_t hash(const MeshView& mesh, Executor& executor) {
  constexpr std::size_t kBlock = 128;  // triangles gathered at a time, on the stack
  std::vector<std::uint64_t> parts(chunk_count(mesh.triangle_count));
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Triangle block[kBlock];
    std::uint64_t h = 0;
    for (std::size_t i = begin; i < end;) {
      std::size_t filled = 0;
      while (filled < kBlock && i < end) block[filled++] = mesh.triangle(i++);
      h = hash_bytes(block, filled * sizeof(Triangle), h);
    }
    parts[chunk] = h;
  });
  return hash_bytes(parts.data(), parts.size() * sizeof(parts[0]), mesh.triangle_count);
}

}  // namespace boxwood::mesh
