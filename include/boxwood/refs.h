// Primitive references: what builders sort. A box and a primitive id, nothing of the mesh.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
  /// Boxes of what several planes at increasing positions inside the reference's box make of it: parts[i] lies below
  /// positions[i], the last one above all; empty where there is nothing. For pricing splits: not rounded outwards.
  virtual void chop(const Reference& reference, int axis, std::span<const float> positions,
                    std::span<Box> parts) const = 0;
  /// Pairs of primitives that share an edge, by rank, as mesh::edge_links gives them. By default there are none.
  virtual AlignedBuffer<mesh::EdgeLink> edge_links(mesh::Weld weld, Executor& executor) const;
  /// The neighbours of each primitive over its edges, as mesh::edge_neighbours gives them. By default nothing at all.
  virtual AlignedBuffer<mesh::EdgeNeighbours> edge_neighbours(mesh::Weld weld, Executor& executor) const;
  /// Do two primitives share an edge, as mesh::share_edge says? By default no two do. Called from many threads at once.
  virtual bool share_edge(std::uint32_t a, std::uint32_t b, mesh::Weld weld) const;
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

// ---- Pre-splits: several tight references in place of one loose one, before any builder looks at them --------------

/// One option of a pre-split, a number from `lowest` to `highest`.
struct PresplitOption {
  const char* key;          ///< "t"
  const char* description;  ///< one line
  double default_value = 0, lowest = 0, highest = 0;
};

struct Presplit;

/// What a pre-split did. Areas are of boxes of references, in square units of the mesh.
struct PresplitReport {
  std::size_t references_before = 0, references_after = 0;
  double area_before = 0, area_after = 0;  ///< sums over all references
  std::size_t splits = 0;                  ///< cuts in two
  /// Area of a part's box over that of the box it was cut from, over both parts of all splits (Dammertz and Keller
  /// 2008, Table 1); 1 when nothing was split.
  double best_factor = 1, average_factor = 1, worst_factor = 1;
  double threshold = 0;  ///< what a part's measure was held against: a volume (evh) or an area (esc)
  double t = 0;          ///< evh: log2 of the scene's volume over the threshold, given or found; else 0

  /// Sum of the areas after over the sum before; 1 when there was no area.
  double area_reduction() const { return area_before > 0 ? area_after / area_before : 1; }
};

/// One row of the registry of pre-splits.
struct PresplitInfo {
  const char* id;       ///< "evh", or with a variant "evh:auto"
  const char* summary;  ///< one line: what is split where
  const char* paper;    ///< bib key(s) in docs/references.bib, or what it departs from
  std::span<const PresplitOption> options;
  bool subdivides;  ///< splits edges alike on both sides, so that `subdivide` can do it
  /// Replaces references by their parts. Null: leaves everything as it is.
  Status (*apply)(ReferenceSet& set, const MeshView& mesh, const Presplit& presplit, Executor& executor,
                  PresplitReport& report);
};

/// All pre-splits, in the order they are listed to people; the first is `none`.
std::span<const PresplitInfo> presplits();

/// A pre-split with a value for each of its options. The default is `none`.
struct Presplit {
  Presplit();
  const PresplitInfo* info;    ///< never null
  std::vector<double> values;  ///< in the order of info->options

  bool is_none() const { return info->apply == nullptr; }
  double value(std::string_view key) const;  ///< the key must exist
  /// What parse_presplit reads, every option with its value: "evh:t=14", "evh:auto,budget=1.3".
  std::string text() const;
};

/// Reads "none", "evh", "evh:t=14", "evh:auto,budget=1.2", "esc:k=100": an id of the registry, then options after the
/// first colon or comma. Errors name the value and list what there is.
Result<Presplit> parse_presplit(std::string_view text);

/// Splits references that are one per primitive, as make_references leaves them; the parts stand where the whole stood.
/// Every part of a triangle lies in at least one of its references. Parallel, the same bits for every executor.
/// `report`, if any, is filled in. Errors: more than 2^31 - 1 references, out of memory.
Result<ReferenceSet> apply_presplit(ReferenceSet&& set, const MeshView& mesh, const Presplit& presplit,
                                    Executor& executor, PresplitReport* report = nullptr);

/// A mesh whose triangles are cut where a pre-split would cut them, for ray tracers that take triangles only.
struct Subdivision {
  TriangleMesh mesh;          ///< usable triangles only; the old vertices first, then the midpoints, each position once
  std::size_t midpoints = 0;  ///< vertices added
  std::size_t split = 0;      ///< triangles that were cut
  std::size_t left_out = 0;   ///< triangles that are not finite
  std::size_t open_edges_before = 0;    ///< edges (by position) of one triangle only
  std::size_t open_edges_expected = 0;  ///< pieces those were cut into
  std::size_t open_edges_after = 0;     ///< more than expected would be T-junctions
};
/// Cuts every edge at the same midpoints on all its triangles, so that what was closed stays closed. Parallel,
/// deterministic. Errors: a pre-split that does not subdivide, more than 2^31 - 1 triangles, what make_references
/// refuses, out of memory.
Result<Subdivision> subdivide(const MeshView& mesh, const Presplit& presplit, Executor& executor);

}  // namespace boxwood::refs
