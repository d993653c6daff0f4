// Triangle meshes: a view of the user's arrays, an owning mesh, checks, welding and procedural scenes.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/math.h"
#include "boxwood/parallel.h"

namespace boxwood {

/// An indexed triangle mesh in memory of the caller, which must outlive every use of the view. Nothing is copied and
/// no byte outside the last element is read: a vertex is three floats (12 bytes) every `vertex_stride` bytes, a
/// triangle is three 32-bit vertex indices (12 bytes) every `triangle_stride` bytes; neither needs any alignment.
/// With `indices` null the vertices are taken three at a time and triangle_count is vertex_count / 3.
/// Primitive ids are triangle numbers, 0 to triangle_count - 1; at most 2^31 - 1 of them.
struct MeshView {
  const void* positions = nullptr;
  std::size_t vertex_count = 0;
  const void* indices = nullptr;
  std::size_t triangle_count = 0;
  std::size_t vertex_stride = 12;
  std::size_t triangle_stride = 12;

  std::array<std::uint32_t, 3> corners(std::size_t triangle) const {
    std::array<std::uint32_t, 3> v{static_cast<std::uint32_t>(3 * triangle),
                                   static_cast<std::uint32_t>(3 * triangle + 1),
                                   static_cast<std::uint32_t>(3 * triangle + 2)};
    if (indices) std::memcpy(v.data(), static_cast<const char*>(indices) + triangle * triangle_stride, 12);
    return v;
  }
  Vec3 vertex(std::size_t i) const {
    Vec3 p;
    std::memcpy(&p, static_cast<const char*>(positions) + i * vertex_stride, 12);
    return p;
  }
  Triangle triangle(std::size_t i) const {
    const auto c = corners(i);
    return {vertex(c[0]), vertex(c[1]), vertex(c[2])};
  }
};

/// A mesh that owns its arrays. `name` is what reports call it (file name without folders, or the scene's id).
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::string name;

  MeshView view() const { return {vertices.data(), vertices.size(), triangles.data(), triangles.size()}; }
  operator MeshView() const { return view(); }
};

namespace mesh {

/// Refuses views that can't be read: counts beyond 2^31 - 1, strides under 12, null arrays, an index past the vertices
/// (the sentence names the triangle and the index). Does not look at coordinates. O(triangles), parallel.
Status check_indices(const MeshView& mesh, Executor& executor);

/// True when every coordinate of the triangle is finite and within +-kLargestCoordinate.
bool is_usable(const Triangle& triangle);

/// Box of all usable triangles (empty when there are none). Unused vertices do not count. Parallel.
Box bounds(const MeshView& mesh, Executor& executor);

/// 64-bit hash of the triangles' corner positions in order; the same for indexed and unindexed copies of a mesh.
std::uint64_t hash(const MeshView& mesh, Executor& executor);

/// What a mesh looks like before anything is built over it. Counts are of triangles unless named otherwise.
struct Report {
  std::size_t vertices = 0, triangles = 0;
  Box bounds;
  std::size_t non_finite = 0;          ///< NaN, infinite, or beyond kLargestCoordinate: excluded from trees
  std::size_t degenerate = 0;          ///< usable, with area exactly zero (decided in double precision)
  std::size_t duplicate = 0;           ///< further copies of an earlier triangle (same three positions in any order)
  std::size_t components = 0;          ///< connected by shared vertex positions, among usable triangles
  std::size_t boundary_edges = 0;      ///< edges (by position) that exactly one non-degenerate triangle has
  std::size_t non_manifold_edges = 0;  ///< edges that more than two non-degenerate triangles have
  bool closed = false;                 ///< no boundary edges, and at least one usable triangle with an area
  bool manifold = false;               ///< no edge on more than two triangles
  double surface_area = 0;             ///< of usable triangles, square units
};
/// Requires check_indices to have passed. O(n log n), parallel, deterministic.
Report inspect(const MeshView& mesh, Executor& executor);

/// For each vertex the first vertex with exactly the same position (-0 equals +0); non-finite positions stay alone.
std::vector<std::uint32_t> weld(const MeshView& mesh, Executor& executor);

/// Turns all vertices by degrees about x, then y, then z through `center`. Calculated in double precision; whole turns
/// change nothing, quarter turns round each coordinate once. Requires finite degrees and centre.
void rotate(TriangleMesh& mesh, Vec3 degrees, Vec3 center);
/// The view that sees of the turned mesh what `view` sees of the mesh.
View rotate(const View& view, Vec3 degrees, Vec3 center);

/// Two triangles that share an edge.
struct EdgeLink {
  std::uint32_t a, b;
  friend bool operator==(const EdgeLink&, const EdgeLink&) = default;
};
/// When two triangles have a vertex in common: the same position (as weld decides), or the same index.
enum class Weld { position, index };
/// The links of all edges between usable triangles by rank: the edge whose box has the larger area (to 22 bits) first,
/// then the one with the lower vertices. Three or more triangles on an edge are linked each to the next by their ids.
/// Requires check_indices to have passed. O(n), parallel, deterministic.
AlignedBuffer<EdgeLink> edge_links(const MeshView& mesh, Weld weld, Executor& executor);

/// Triangles across a triangle's sides from corner 0 to 1, 1 to 2 and 2 to 0.
using EdgeNeighbours = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t kNoNeighbour = 0xffffffffu;
/// The neighbours of all triangles, unusable ones without any. Of three or more triangles on an edge the first is the
/// neighbour of the second, the third that of the fourth, and so on by their ids. Requires check_indices to have
/// passed. Expected O(n), parallel, deterministic.
AlignedBuffer<EdgeNeighbours> edge_neighbours(const MeshView& mesh, Weld weld, Executor& executor);
/// Have two different triangles a side in common, whose ends are two vertices? Both must be among the mesh's triangles,
/// and check_indices must have passed. Looks at these two alone.
bool share_edge(const MeshView& mesh, std::size_t a, std::size_t b, Weld weld);

// ---- Procedural scenes -------------------------------------------------------------------------------------------

/// How to make a scene. `triangles` is a target from 12 to 20 million: the scene comes as near to it as its
/// structure allows and never above 1.1 times it; `seed` moves its random choices; `rotate` turns the whole scene about
/// its centre by degrees around x, then y, then z (the view turns with it). Two defects that real files have come last,
/// on top of `triangles` and after `rotate`: `outlier` adds a tiny triangle that many diagonals of the scene's box
/// away, `spike` a triangle of the scene's middle one of whose vertices is that far off; the view stays as it was.
struct SceneOptions {
  std::size_t triangles = 0;  ///< 0 = the scene's own default
  std::uint64_t seed = 1;
  Vec3 rotate{};
  float outlier = 0;  ///< 0 = none; up to 1e9
  float spike = 0;    ///< 0 = none; up to 1e9
};

struct Scene {
  TriangleMesh mesh;
  View view;  ///< a camera inside or in front of it that sees what the scene is about
};

/// One row of the scene registry.
struct SceneInfo {
  const char* id;       ///< "atrium"
  const char* summary;  ///< one line: what it is and which property of which paper's argument it has
  const char* paper;    ///< whose scenes it stands in for
  std::size_t default_triangles;
  Scene (*make)(const SceneOptions&);  ///< options already checked; no rotation
};

/// All scenes, in the order they are listed to people.
std::span<const SceneInfo> scenes();

/// Makes a scene by id. The same options give the same bits on every machine of this architecture. Errors: unknown id
/// (the sentence lists what there is), triangles outside 12 to 20 million, rotation not finite, outlier or spike
/// outside 0 to 1e9.
Result<Scene> make_scene(std::string_view id, const SceneOptions& options = {});

/// A view that shows a whole mesh: from outside, slightly above, the long side across, 40 degrees.
View view_from_bounds(const Box& bounds);

}  // namespace mesh
}  // namespace boxwood
