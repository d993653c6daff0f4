// References of a mesh. Chunks are filled at their own place in parallel; only when triangles were left out do the
// later chunks move down, in order. O(triangles), the same for every number of threads.
#include <vector>

#include "boxwood/refs.h"

namespace boxwood::refs {
namespace {

constexpr std::size_t kChunk = 1 << 12;

struct Filled {
  std::size_t count = 0;
  Box bounds;
};

Filled fill(const MeshView& mesh, std::size_t begin, std::size_t end, Reference* out) {
  Filled filled;
  for (std::size_t i = begin; i < end; ++i) {
    const Triangle triangle = mesh.triangle(i);
    if (!mesh::is_usable(triangle)) continue;
    const Box box = triangle.bounds();
    filled.bounds.grow(box);
    out[filled.count++] = {box.lower, static_cast<std::uint32_t>(i), box.upper, 0};
  }
  return filled;
}

ReferenceSet make(const MeshView& mesh, Executor& executor) {
  ReferenceSet set;
  set.primitive_count = mesh.triangle_count;
  set.primitives = triangle_primitives(mesh);
  set.references = AlignedBuffer<Reference>(mesh.triangle_count);
  Reference* const out = set.references.data();
  std::vector<Filled> chunks((mesh.triangle_count + kChunk - 1) / kChunk);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    chunks[chunk] = fill(mesh, begin, end, out + begin);
  });
  std::size_t count = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (count != i * kChunk)
      std::memmove(static_cast<void*>(out + count), out + i * kChunk, chunks[i].count * sizeof(Reference));
    count += chunks[i].count;
    set.bounds.grow(chunks[i].bounds);
  }
  set.references.truncate(count);
  set.excluded = mesh.triangle_count - count;
  return set;
}

}  // namespace

Result<ReferenceSet> make_references(const MeshView& mesh, Executor& executor) {
  try {
    if (const Status status = mesh::check_indices(mesh, executor); !status) return status.error();
    return make(mesh, executor);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "out of memory for the references of " + std::to_string(mesh.triangle_count) + " triangles"};
  }
}

}  // namespace boxwood::refs
