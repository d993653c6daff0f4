// Accel: mesh in, ray queries out. What most programs need of Boxwood.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "boxwood/builders.h"
#include "boxwood/layouts.h"
#include "boxwood/mesh.h"
#include "boxwood/optimizers.h"
#include "boxwood/queries.h"

namespace boxwood {

/// A name for a whole pipeline, taken wherever a builder is named.
struct QualityLevel {
  const char* id;       ///< "fast", "balanced", "best"
  const char* summary;  ///< one line: what it is for
  const char* presplit;
  const char* builder;
  std::span<const std::pair<const char*, const char*>> settings;  ///< of the builder, key and value
  const char* optimizer;
  const char* second_builder;  ///< of a second tree, over whole triangles: see TreePlan; null: there is none
  const char* build_cost;      ///< build time against `balanced`, as measured (docs/best-tree.md)
  const char* memory;          ///< of the finished Accel, likewise
};

/// All levels, from the quickest to build to the fastest to trace.
std::span<const QualityLevel> quality_levels();
/// The level of an id, or null.
const QualityLevel* find_quality_level(std::string_view id);

/// See TreePlan::second.
inline constexpr double kSecondTreeAllowance = 1.025;

/// What makes a binary tree, with all options checked. Made by plan_tree.
struct TreePlan {
  const QualityLevel* level = nullptr;  ///< that was named; null: a builder was
  builders::BuildOptions build;         ///< the builder itself, with the level's settings
  /// Builder of a second tree from the same references, bettered by the same optimizer; empty: there is none. It is for
  /// builders that split references: the tree that leaves them whole is kept where it costs at most
  /// kSecondTreeAllowance times as much, since rays that end at a hit pass fewer nodes in it than their boxes' areas
  /// say.
  builders::BuildOptions second = {.builder = {}, .settings = {}};
  refs::Presplit presplit;
  optimizers::Optimizer optimizer;
  /// Prices to compare trees by: those that were asked for, else the builder's defaults. What a level sets for its
  /// builder is not among them, or Exp(T) of two levels would be in different units.
  tree::CostModel cost;

  /// Key and value as text of all that was resolved: level (if any), builder, pre-split, optimizer, second builder (if
  /// any), settings.
  std::vector<std::pair<std::string, std::string>> echo() const;
};

/// `build.builder` is a builder or a quality level; its settings are the builder's and go before those of the level. An
/// empty pre-split or optimizer is the level's, or none. Errors: those of builders::resolve_options,
/// refs::parse_presplit and optimizers::parse_optimizer.
Result<TreePlan> plan_tree(const builders::BuildOptions& build, std::string_view presplit = {},
                           std::string_view optimizer = {});

/// How build_tree fared.
struct TreeReport {
  std::size_t excluded = 0;  ///< non-finite triangles left out
  refs::PresplitReport presplit;
  double reference_seconds = 0, presplit_seconds = 0, builder_seconds = 0, optimizer_seconds = 0;
  /// Expected cost of the second tree by that of the first, in the plan's prices; 0: there was none.
  double second_tree_cost = 0;

  bool kept_second_tree() const { return second_tree_cost > 0 && second_tree_cost <= kSecondTreeAllowance; }
  double seconds() const { return reference_seconds + presplit_seconds + builder_seconds + optimizer_seconds; }
};

/// References of the mesh, their pre-split, the builder, the optimizer, perhaps a second tree: what Accel::build does
/// before it encodes. `split`, if any, gets a 1 for each primitive that has several references, by the pre-split or by
/// the builder, and a 0 for the others. The same bits for every executor. Errors: what these steps refuse.
Result<tree::BinaryTree> build_tree(const MeshView& mesh, const TreePlan& plan, const builders::BuildContext& context,
                                    TreeReport* report = nullptr, std::vector<std::uint32_t>* split = nullptr);

struct AccelOptions {
  builders::BuildOptions build = {.builder = "balanced"};  ///< id of a quality level or a builder, and settings
  std::string presplit = {};   ///< how to split references first: what refs::parse_presplit reads; empty: the level's
  std::string optimizer = {};  ///< how to better the tree: what optimizers::parse_optimizer reads; empty: the level's
  std::string layout = {};     ///< id of layouts::registry; empty: queries::default_layout
  /// Wide layouts: what visiting a node costs against testing one block of triangles, above 0 (0: the layout's own,
  /// layouts::node_cost), and the most blocks of a leaf, 1 to 8 (docs/collapse.md; leaves of `wide8-quads` end at 32
  /// triangles). `linear` has no use for them.
  float node_cost = 0;
  int max_leaf_blocks = 4;
  std::string isa = {};  ///< empty = environment variable BOXWOOD_ISA, or the best the processor has
  /// Runs the build and later the batch queries. Null = a pool of its own over all processors.
  std::shared_ptr<Executor> executor = {};
};

/// A hit with the geometric normal (v1 - v0) x (v2 - v0), not normalised; zero on a miss.
struct SurfaceHit : Hit {
  Vec3 normal{};
};

/// Rays like those that will be traced, by what is asked of them. Either may be empty. Not owned.
struct RaySample {
  std::span<const Ray> closest_hit = {};
  std::span<const Ray> any_hit = {};
};

/// How Accel::optimize works. The budget is in passes and rays, not in seconds, so that results do not depend on time.
struct OptimizeOptions {
  int passes = 3;  ///< over all treelets, 0 to 100 (0: only collapse and order); ends early when nothing changes
  /// Rays, at each node, that go as the surface area says: above 0, to 1e6. Many keep the tree closer to one for all
  /// kinds of rays, few trust the sample.
  float prior = 128;
  std::size_t most_rays = std::size_t{1} << 17;  ///< looked at, of each question, evenly spaced; at least 4
  std::string layout = {};                       ///< empty: as it is
  float node_cost = 0;                           ///< as for AccelOptions
  int max_leaf_blocks = 4;
};

/// What Accel::optimize did. Work is per held-out ray, in tests of one leaf block; a node visit is queries::kNodePrice
/// of them.
struct OptimizeReport {
  std::size_t trained_rays = 0;
  std::size_t tested_rays = 0;  ///< held out: every fourth, seen by no decision but whether to take the new tree
  double work_before = 0, work_after = 0;  ///< zero for the layout `linear`, whose visits are not counted
  bool improved = true;  ///< false: it would have been no better on the rays held out, and the tree is as it was
};

struct OptimizedAccel;

/// A bounding volume hierarchy over a triangle mesh, ready for ray queries. Copies the triangles it needs: the mesh may
/// go once `build` has returned. Moves, never copies. All queries are const and safe from any number of threads at
/// once.
///
///     auto accel = boxwood::Accel::build(mesh);
///     if (!accel) return fail(accel.error().message);
///     boxwood::Hit hit = accel->closest_hit({.origin = {0, 0, 5}, .direction = {0, 0, -1}});
class Accel {
 public:
  /// Errors: what plan_tree, build_tree and layouts::encode refuse; an unknown layout or ISA. An empty mesh gives an
  /// Accel that every ray misses.
  static Result<Accel> build(const MeshView& mesh, const AccelOptions& options = {});
  /// From a tree built before over the same mesh; `options.build`, `presplit` and `optimizer` are not looked at.
  static Result<Accel> from_tree(const MeshView& mesh, const tree::BinaryTree& tree, const AccelOptions& options = {});

  /// The same triangles in a tree that is better for rays like the sample: treelets rebuilt and nodes merged by
  /// measured visits of rays that end at their hits, children in the order that is best for any-hit queries (Ogaki and
  /// Derouet-Jourdan 2016), visited nodes side by side. Hits stay the same, bit for bit in robust mode. This object
  /// stays as it is and can go on answering from other threads; needs neither the mesh nor the builder's tree. The same
  /// sample and options give the same bits for every executor and instruction set. Some 10^4 rays are a useful sample;
  /// it takes about a second for a million triangles and 10^5 rays. Errors: no rays, an option out of range, an unknown
  /// layout, out of memory.
  Result<OptimizedAccel> optimize(const RaySample& sample, const OptimizeOptions& options = {}) const;

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

struct OptimizedAccel {
  Accel accel;
  OptimizeReport report;
};

}  // namespace boxwood
