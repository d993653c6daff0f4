// References of a mesh. Chunks are filled at their own place in parallel; only when triangles were left out do the
// later chunks move down, in order. O(triangles), the same for every number of threads.
#include <algorithm>
#include <vector>

#include "boxwood/refs.h"
#include "mesh/check_arrays.h"
#include "mesh/load_vertex.h"

namespace boxwood::refs {
namespace {

constexpr std::size_t kChunk = 1 << 12;

struct Filled {
  std::size_t count = 0;
  Box bounds;
  bool bad_index = false;
};

/// References of the triangles [begin, end); stops at an index past the vertices.
Filled fill(const MeshView& mesh, std::size_t begin, std::size_t end, Reference* out) {
  Filled filled;
  Float4 all_lower = Float4::fill(kInfinity), all_upper = Float4::fill(-kInfinity);
  for (std::size_t i = begin; i < end; ++i) {
    const auto corners = mesh.corners(i);
    const std::uint32_t largest = std::max({corners[0], corners[1], corners[2]});
    if (largest >= mesh.vertex_count) {
      filled.bad_index = true;
      return filled;
    }
    const mesh::VertexLoader load(mesh, largest);
    const Float4 a = load(corners[0]), b = load(corners[1]), c = load(corners[2]);
    // Mostly the sum tells that all are within: it is at least as large as each, and NaN with one that is.
    if (!all_within(absolute(a) + absolute(b) + absolute(c), kLargestCoordinate) &&
        !(all_within(a, kLargestCoordinate) && all_within(b, kLargestCoordinate) && all_within(c, kLargestCoordinate)))
      continue;
    const Float4 lower = minimum(minimum(a, b), c), upper = maximum(maximum(a, b), c);
    all_lower = minimum(all_lower, lower);
    all_upper = maximum(all_upper, upper);
    Reference& reference = out[filled.count++];
    lower.store(&reference.lower);
    upper.store(&reference.upper);
    reference.primitive = static_cast<std::uint32_t>(i);
    reference.reserved = 0;
  }
  alignas(16) float l[4], u[4];
  all_lower.store(l), all_upper.store(u);
  filled.bounds = {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
  return filled;
}

Result<ReferenceSet> make(const MeshView& mesh, Executor& executor) {
  if (Status status = mesh::check_arrays(mesh); !status) return status.error();
  ReferenceSet set;
  set.primitive_count = mesh.triangle_count;
  set.primitives = triangle_primitives(mesh);
  set.references = AlignedBuffer<Reference>(mesh.triangle_count);
  Reference* const out = set.references.data();
  std::vector<Filled> chunks((mesh.triangle_count + kChunk - 1) / kChunk);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    chunks[chunk] = fill(mesh, begin, end, out + begin);
  });
  for (const Filled& chunk : chunks)
    if (chunk.bad_index) return mesh::check_indices(mesh, executor).error();  // it names the first one
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
    return make(mesh, executor);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "out of memory for the references of " + std::to_string(mesh.triangle_count) + " triangles"};
  }
}

}  // namespace boxwood::refs
