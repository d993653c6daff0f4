// Primitive references: what builders sort. A box and a primitive id, nothing of the mesh.
#pragma once

#include <cstdint>

#include "boxwood/base.h"
#include "boxwood/math.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"

namespace boxwood::refs {

/// Box and id of one primitive (or, after splitting, of a part of it). 32 bytes, so that a half is one SIMD load.
struct alignas(16) Reference {
  Vec3 lower;
  std::uint32_t primitive = 0;
  Vec3 upper;
  std::uint32_t reserved = 0;  ///< zero; keeps the upper half loadable

  Box box() const { return {lower, upper}; }
  /// Twice the box's centre on one axis; the factor is left out because only comparisons need it.
  float centroid2(int axis) const { return lower[axis] + upper[axis]; }
  Vec3 centroid2() const { return lower + upper; }
};
static_assert(sizeof(Reference) == 32);

struct ReferenceSet {
  AlignedBuffer<Reference> references;
  Box bounds;                       ///< of all references
  std::size_t primitive_count = 0;  ///< triangles of the mesh, excluded ones too
  std::size_t excluded = 0;         ///< non-finite triangles, which got no reference
};

/// One reference per usable triangle (see mesh::is_usable), in the order of primitive ids. Parallel, deterministic.
/// Errors: what mesh::check_indices refuses, out of memory.
Result<ReferenceSet> make_references(const MeshView& mesh, Executor& executor);

}  // namespace boxwood::refs
