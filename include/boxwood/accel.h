// Accel: mesh in, ray queries out. What most programs need of Boxwood.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "boxwood/builders.h"
#include "boxwood/layouts.h"
#include "boxwood/mesh.h"
#include "boxwood/queries.h"

namespace boxwood {

struct AccelOptions {
  builders::BuildOptions build = {};  ///< builder id and its settings
  std::string presplit = "none";      ///< how to split references first: what refs::parse_presplit reads
  std::string layout = "wide8";       ///< linear, wide4, wide8 or wide8-quads
  std::string isa = {};               ///< empty = environment variable BOXWOOD_ISA, or the best the processor has
  /// Runs the build and later the batch queries. Null = a pool of its own over all processors.
  std::shared_ptr<Executor> executor = {};
};

/// A hit with the geometric normal (v1 - v0) x (v2 - v0), not normalised; zero on a miss.
struct SurfaceHit : Hit {
  Vec3 normal{};
};

/// A bounding volume hierarchy over a triangle mesh, ready for ray queries. Copies the triangles it needs: the mesh may
/// go once `build` has returned. Moves, never copies. All queries are const and safe from any number of threads at
/// once.
///
///     auto accel = boxwood::Accel::build(mesh);
///     if (!accel) return fail(accel.error().message);
///     boxwood::Hit hit = accel->closest_hit({.origin = {0, 0, 5}, .direction = {0, 0, -1}});
class Accel {
 public:
  /// Errors: what refs::make_references, refs::parse_presplit, refs::apply_presplit, builders::build and
  /// layouts::encode refuse; an unknown layout or ISA. An empty mesh gives an Accel that every ray misses.
  static Result<Accel> build(const MeshView& mesh, const AccelOptions& options = {});
  /// From a tree built before over the same mesh; `options.build` and `presplit` are not looked at.
  static Result<Accel> from_tree(const MeshView& mesh, const tree::BinaryTree& tree, const AccelOptions& options = {});

  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;
  ~Accel();

  Hit closest_hit(const Ray& ray, queries::Mode mode = queries::Mode::robust) const;
  SurfaceHit closest_surface_hit(const Ray& ray, queries::Mode mode = queries::Mode::robust) const;
  /// Is there any triangle on the ray within [tmin, tmax]?
  bool any_hit(const Ray& ray, queries::Mode mode = queries::Mode::robust) const;

  /// Batches, in parallel on the executor given at build. The spans must be equally long (else invalid_argument, and
  /// nothing is written); `normals` may be empty. By default the way of tracing is picked for each tile of rays
  /// (Traversal::batch): faster than a loop over closest_hit, above all where neighbours in the array are neighbours in
  /// a picture, row by row or tile by tile. Every traversal gives the same hits; errors: a layout that has not got the
  /// one asked for, a packet size out of range, not enough memory. Extra memory does not grow with the number of rays.
  Status closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<Vec3> normals = {},
                      queries::Mode mode = queries::Mode::robust,
                      const queries::TraversalOptions& traversal = {}) const;
  Status any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                  queries::Mode mode = queries::Mode::robust, const queries::TraversalOptions& traversal = {}) const;
  /// The same, counting the work of each ray (slower; the traversal is the same code, but batches of wide layouts are
  /// counted as single rays).
  Status closest_hits_counted(std::span<const Ray> rays, std::span<Hit> hits, std::span<queries::Counts> per_ray,
                              queries::Mode mode = queries::Mode::robust,
                              const queries::TraversalOptions& traversal = {}) const;
  Status any_hits_counted(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                          std::span<queries::Counts> per_ray, queries::Mode mode = queries::Mode::robust,
                          const queries::TraversalOptions& traversal = {}) const;

  Box bounds() const;         ///< of all triangles in it
  std::size_t bytes() const;  ///< memory held, nodes and triangles
  std::size_t reference_count() const;
  std::size_t excluded_count() const;  ///< non-finite triangles left out (0 for from_tree)
  const std::string& isa() const;
  const layouts::Layout& layout() const;
  Executor& executor() const;

 private:
  struct State;
  explicit Accel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace boxwood
