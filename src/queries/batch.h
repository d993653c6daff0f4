// The batch engine: how a stream of rays is cut into packets, rays in flight and single rays. docs/batches.md has what
// is chosen when, and the measurements behind it.
#pragma once

#include <span>

#include "boxwood/queries.h"
#include "queries/kernels/batch.h"

namespace boxwood::queries {

/// The ways a batch can go; `batch` has no packets and no rays in flight on layouts that lack them.
struct BatchMethods {
  Kernels single{};
  BatchKernels batch{};
  bool has_batch = false;
};
/// Errors: those of select_kernels.
Result<BatchMethods> select_batch(layouts::LayoutId layout, Mode mode, std::string_view isa);

/// Is this one of the traversals that trace_batch has (on layouts for which check_traversal allows it)?
constexpr bool is_batch(Traversal traversal) {
  return traversal == Traversal::batch || traversal == Traversal::coherent || traversal == Traversal::interleaved ||
         traversal == Traversal::sorted;
}

/// How a stream is cut, the same for every number of threads.
struct BatchCut {
  std::size_t row = 0;  ///< rays in a row of the picture that they come from; 0: none found
  std::size_t chunk = 0;
};
/// Looks at a few hundred rays of the stream. Deterministic.
BatchCut cut_batch(const BatchMethods& methods, std::span<const Ray> rays, Traversal traversal);

/// Where the answers go: for a closest hit `hits` and perhaps `normals`, else `occluded`.
struct BatchAnswers {
  Hit* hits = nullptr;
  Vec3* normals = nullptr;
  std::uint8_t* occluded = nullptr;

  bool any() const { return occluded != nullptr; }
  BatchAnswers from(std::size_t begin) const {
    return {hits ? hits + begin : nullptr, normals ? normals + begin : nullptr, occluded ? occluded + begin : nullptr};
  }
};

/// Traces one chunk. Memory besides a few kilobytes is allocated by `sorted` alone, in proportion to the chunk. Throws
/// std::bad_alloc.
void trace_batch(const BatchMethods& methods, const layouts::Layout& layout, Traversal traversal, std::size_t row,
                 std::span<const Ray> rays, const BatchAnswers& answers);

/// Puts rays that start in the same place and go the same way next to each other: by octant, Morton code of the origin
/// in `bounds` and coarse direction. `sorted` gets the rays, `places` where each of them stood; both as long as `rays`,
/// `scratch` twice. At most 2^32 rays. Stable, hence deterministic.
void sort_rays(std::span<const Ray> rays, const Box& bounds, std::span<Ray> sorted, std::span<std::uint32_t> places,
               std::span<std::uint64_t> scratch);

}  // namespace boxwood::queries
