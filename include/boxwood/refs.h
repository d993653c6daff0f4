// Primitive references: what builders sort. A box and a primitive id, nothing of the mesh.
#pragma once

#include <cstdint>
#include <memory>

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

/// What builders that split may ask of the primitives behind the references. Implementations answer from several
/// threads at once.
class Primitives {
 public:
  virtual ~Primitives() = default;
  /// The box of what the reference stands for (the part of its primitive inside its box) inside `box`: rounded
  /// outwards, inside both boxes, empty when they are clearly apart.
  virtual Box clip(const Reference& reference, const Box& box) const = 0;
  /// Cuts what the reference stands for at the plane where coordinate `axis` is `position`, which lies inside its box.
  /// Both boxes are rounded outwards, lie in the reference's box and together hold all of it; one of them is empty when
  /// nothing lies on its side.
  virtual void cut(const Reference& reference, int axis, float position, Box& left, Box& right) const = 0;
  /// Pairs of primitives that share an edge, by rank, as mesh::edge_links gives them. By default there are none.
  virtual AlignedBuffer<mesh::EdgeLink> edge_links(mesh::Weld weld, Executor& executor) const;
};

/// The primitives of a triangle mesh. Reads the mesh's arrays, which must outlive it. Only usable triangles may be
/// asked for.
std::shared_ptr<const Primitives> triangle_primitives(const MeshView& mesh);
/// Primitives that fill their boxes: what stands in where nothing else is known of them.
std::shared_ptr<const Primitives> box_primitives();

struct ReferenceSet {
  AlignedBuffer<Reference> references;
  Box bounds;                       ///< of all references
  std::size_t primitive_count = 0;  ///< triangles of the mesh, excluded ones too
  std::size_t excluded = 0;         ///< non-finite triangles, which got no reference
  /// What the references stand for; null: box_primitives().
  std::shared_ptr<const Primitives> primitives;
};

/// One reference per usable triangle (see mesh::is_usable), in the order of primitive ids. Parallel, deterministic. The
/// set's `primitives` read the mesh, which must outlive the set.
/// Errors: what mesh::check_indices refuses, out of memory.
Result<ReferenceSet> make_references(const MeshView& mesh, Executor& executor);

}  // namespace boxwood::refs
