// Accel runs the pipeline: mesh -> tree (build_tree.cpp) -> (wide tree) -> layout, and hands rays to its
// kernels.
#include "boxwood/accel.h"

#include <algorithm>

#include "accel/encode_tree.h"
#include "accel/optimize_layout.h"
#include "boxwood/metrics.h"
#include "boxwood/optimizers.h"
#include "layouts/encode.h"
#include "queries/batch.h"

namespace boxwood {
namespace {

/// Rays a worker takes at a time: enough to make the hand-over free, few enough to share out uneven work.
constexpr std::size_t kRaysPerChunk = 1024;

Result<layouts::LayoutId> find_layout(const AccelOptions& options) {
  return layouts::find(options.layout.empty() ? queries::default_layout(options.isa) : options.layout);
}

Status same_length(std::size_t rays, std::size_t results, const char* what) {
  if (rays == results) return {};
  return {ErrorCode::invalid_argument,
          "there are " + std::to_string(rays) + " rays but room for " + std::to_string(results) + " " + what};
}

}  // namespace

Result<layouts::Layout> encode_tree(layouts::LayoutId id, const tree::BinaryTree& tree, const MeshView& mesh,
                                    optimizers::CollapseOptions options, Executor& executor) {
  if (id == layouts::LayoutId::linear) return layouts::encode_linear(tree, mesh, executor);
  options.width = layouts::width(id);
  const bool quads = layouts::has_quads(id);
  if (quads) {
    // Pricing looks at the triangles, before the encoder could find one that is not there.
    if (auto status = layouts::check_references(tree.references.span(), mesh, executor); !status) return status.error();
    // Both triangles of a block's four quads are tested in one go, or nearly.
    options.block = 8;
    // A leaf's triangles are paired by words of 32 bits. (Above 8 is the caller's mistake, which the collapse reports.)
    if (options.max_leaf_blocks <= 8) options.max_leaf_blocks = std::min(options.max_leaf_blocks, 4);
    options.leaf_blocks = [&](std::span<const std::uint32_t> references) {
      return layouts::quad_blocks(references, mesh);
    };
  }
  auto wide = optimizers::collapse_to_wide(tree, options, executor);
  if (!wide) return wide.error();
  return quads ? layouts::encode_wide_quads(*wide, mesh, executor) : layouts::encode_wide(*wide, mesh, executor);
}

struct Accel::State {
  layouts::Layout layout;
  queries::BatchMethods robust, fast;
  std::string isa;
  std::shared_ptr<Executor> executor;
  std::size_t excluded = 0;
  /// By mode and question. On a line of their own, for calls write to them.
  alignas(64) mutable queries::FasterWay faster_ways[2][2];

  const queries::BatchMethods& methods(queries::Mode mode) const {
    return mode == queries::Mode::robust ? robust : fast;
  }
  const queries::Kernels& kernels(queries::Mode mode) const { return methods(mode).single; }

  /// Hands ranges of rays to `f`, each a whole number of packets, so that packets do not depend on the threads.
  template <class F>
  Status for_rays(std::size_t count, const queries::TraversalOptions& traversal, F f) const {
    using queries::Traversal;
    const bool has_size = traversal.traversal == Traversal::range || traversal.traversal == Traversal::partition;
    const std::size_t packet = has_size ? traversal.packet_size : 4;
    return for_chunks(count, packet * std::max<std::size_t>(1, kRaysPerChunk / packet), f);
  }
  template <class F>
  Status for_chunks(std::size_t count, std::size_t chunk, F f) const {
    try {
      executor->for_chunks(count, chunk,
                           [&](std::size_t, std::size_t begin, std::size_t end) { f(begin, end - begin); });
      return {};
    } catch (const std::bad_alloc&) {
      return {ErrorCode::out_of_memory, "not enough memory to trace " + std::to_string(count) + " rays"};
    }
  }
  /// Batches count nothing: with counts, and on layouts without batches, they are single rays.
  bool is_single(const queries::TraversalOptions& traversal, bool counted) const {
    if (traversal.is_single()) return true;
    return traversal.terminating && queries::is_batch(traversal.traversal) && (counted || !robust.has_batch);
  }
  Status batch(std::span<const Ray> rays, const queries::BatchAnswers& answers, queries::Mode mode,
               queries::Traversal traversal) const {
    const auto cut = queries::cut_batch(methods(mode), rays, traversal);
    queries::FasterWay& faster_way = faster_ways[mode == queries::Mode::fast][answers.any()];
    faster_way.begin_call(rays.size());
    return for_chunks(rays.size(), cut.chunk, [&](std::size_t begin, std::size_t n) {
      queries::trace_batch(methods(mode), layout, traversal, cut.row, faster_way, rays.subspan(begin, n),
                           answers.from(begin));
    });
  }
  Status closest(std::span<const Ray> rays, Hit* hits, Vec3* normals, queries::Counts* per_ray, queries::Mode mode,
                 const queries::TraversalOptions& traversal) const;
  Status any(std::span<const Ray> rays, std::uint8_t* occluded, queries::Counts* per_ray, queries::Mode mode,
             const queries::TraversalOptions& traversal) const;
};

Accel::Accel(std::unique_ptr<State> state) : state_(std::move(state)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

Result<Accel> Accel::build(const MeshView& mesh, const AccelOptions& options) {
  try {
    AccelOptions resolved = options;
    if (!resolved.executor) resolved.executor = std::make_shared<ThreadExecutor>();
    // Fail on a misspelt option before the work, not after it.
    if (auto layout = find_layout(options); !layout) return layout.error();
    if (auto isa = queries::choose_isa(options.isa); !isa) return isa.error();
    const auto plan = plan_tree(options.build, options.presplit, options.optimizer);
    if (!plan) return plan.error();
    TreeReport report;
    auto tree = build_tree(mesh, *plan, {*resolved.executor}, &report);
    if (!tree) return tree.error();
    auto accel = from_tree(mesh, *tree, resolved);
    if (accel) accel->state_->excluded = report.excluded;
    return accel;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "not enough memory to build over " + std::to_string(mesh.triangle_count) + " triangles"};
  }
}

Result<Accel> Accel::from_tree(const MeshView& mesh, const tree::BinaryTree& tree, const AccelOptions& options) {
  try {
    auto state = std::make_unique<State>();
    state->executor = options.executor ? options.executor : std::make_shared<ThreadExecutor>();
    auto id = find_layout(options);
    if (!id) return id.error();
    auto isa = queries::choose_isa(options.isa);
    if (!isa) return isa.error();
    auto robust = queries::select_batch(*id, queries::Mode::robust, *isa);
    auto fast = queries::select_batch(*id, queries::Mode::fast, *isa);
    if (!robust) return robust.error();
    if (!fast) return fast.error();
    optimizers::CollapseOptions collapse;
    collapse.node_cost = options.node_cost == 0 ? layouts::node_cost(*id) : options.node_cost;
    collapse.max_leaf_blocks = options.max_leaf_blocks;
    auto layout = encode_tree(*id, tree, mesh, std::move(collapse), *state->executor);
    if (!layout) return layout.error();
    state->layout = std::move(*layout);
    state->robust = *robust;
    state->fast = *fast;
    state->isa = *isa;
    return Accel(std::move(state));
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "not enough memory to encode a tree of " + std::to_string(tree.nodes.size()) + " nodes"};
  }
}

Result<OptimizedAccel> Accel::optimize(const RaySample& sample, const OptimizeOptions& options) const {
  try {
    const auto id = options.layout.empty() ? Result<layouts::LayoutId>(layout().id) : layouts::find(options.layout);
    if (!id) return id.error();
    auto robust = queries::select_batch(*id, queries::Mode::robust, isa());
    auto fast = queries::select_batch(*id, queries::Mode::fast, isa());
    if (!robust) return robust.error();
    if (!fast) return fast.error();
    auto optimized = optimize_layout(*this, sample, options, *id);
    if (!optimized) return optimized.error();
    auto state = std::make_unique<State>();
    state->layout = std::move(optimized->layout);
    state->robust = *robust;
    state->fast = *fast;
    state->isa = isa();
    state->executor = state_->executor;
    state->excluded = excluded_count();
    return OptimizedAccel{Accel(std::move(state)), optimized->report};
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "not enough memory to optimize a tree of " + std::to_string(reference_count()) + " references"};
  }
}

Hit Accel::closest_hit(const Ray& ray, queries::Mode mode) const {
  Hit hit;
  state_->kernels(mode).closest(state_->layout, &ray, 1, &hit, nullptr);
  return hit;
}

SurfaceHit Accel::closest_surface_hit(const Ray& ray, queries::Mode mode) const {
  SurfaceHit hit;
  state_->kernels(mode).closest(state_->layout, &ray, 1, &hit, &hit.normal);
  return hit;
}

bool Accel::any_hit(const Ray& ray, queries::Mode mode) const {
  std::uint8_t occluded = 0;
  state_->kernels(mode).any(state_->layout, &ray, 1, &occluded);
  return occluded != 0;
}

Status Accel::State::closest(std::span<const Ray> rays, Hit* hits, Vec3* normals, queries::Counts* per_ray,
                             queries::Mode mode, const queries::TraversalOptions& traversal) const {
  const auto at = [](auto* array, std::size_t begin) { return array ? array + begin : nullptr; };
  if (auto status = queries::check_traversal(layout.id, traversal); !status) return status;
  if (is_single(traversal, per_ray))
    return for_rays(rays.size(), traversal, [&](std::size_t begin, std::size_t n) {
      if (per_ray)
        kernels(mode).closest_counted(layout, rays.data() + begin, n, hits + begin, per_ray + begin);
      else
        kernels(mode).closest(layout, rays.data() + begin, n, hits + begin, at(normals, begin));
    });
  if (traversal.terminating && queries::is_batch(traversal.traversal))
    return batch(rays, {hits, normals, nullptr}, mode, traversal.traversal);
  const auto other = queries::select_traversal(layout.id, mode, traversal);
  if (!other) return other.error();
  return for_rays(rays.size(), traversal, [&](std::size_t begin, std::size_t n) {
    other->closest(layout, rays.data() + begin, n, traversal, hits + begin, at(normals, begin), at(per_ray, begin));
  });
}

Status Accel::State::any(std::span<const Ray> rays, std::uint8_t* occluded, queries::Counts* per_ray,
                         queries::Mode mode, const queries::TraversalOptions& traversal) const {
  if (auto status = queries::check_traversal(layout.id, traversal); !status) return status;
  if (is_single(traversal, per_ray))
    return for_rays(rays.size(), traversal, [&](std::size_t begin, std::size_t n) {
      if (per_ray)
        kernels(mode).any_counted(layout, rays.data() + begin, n, occluded + begin, per_ray + begin);
      else
        kernels(mode).any(layout, rays.data() + begin, n, occluded + begin);
    });
  if (traversal.terminating && queries::is_batch(traversal.traversal))
    return batch(rays, {nullptr, nullptr, occluded}, mode, traversal.traversal);
  const auto other = queries::select_traversal(layout.id, mode, traversal);
  if (!other) return other.error();
  return for_rays(rays.size(), traversal, [&](std::size_t begin, std::size_t n) {
    other->any(layout, rays.data() + begin, n, traversal, occluded + begin, per_ray ? per_ray + begin : nullptr);
  });
}

Status Accel::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, std::span<Vec3> normals, queries::Mode mode,
                           const queries::TraversalOptions& traversal) const {
  if (auto s = same_length(rays.size(), hits.size(), "hits"); !s) return s;
  if (!normals.empty())
    if (auto s = same_length(rays.size(), normals.size(), "normals"); !s) return s;
  return state_->closest(rays, hits.data(), normals.empty() ? nullptr : normals.data(), nullptr, mode, traversal);
}

Status Accel::any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, queries::Mode mode,
                       const queries::TraversalOptions& traversal) const {
  if (auto s = same_length(rays.size(), occluded.size(), "answers"); !s) return s;
  return state_->any(rays, occluded.data(), nullptr, mode, traversal);
}

Status Accel::closest_hits_counted(std::span<const Ray> rays, std::span<Hit> hits, std::span<queries::Counts> per_ray,
                                   queries::Mode mode, const queries::TraversalOptions& traversal) const {
  if (auto s = same_length(rays.size(), hits.size(), "hits"); !s) return s;
  if (auto s = same_length(rays.size(), per_ray.size(), "counts"); !s) return s;
  return state_->closest(rays, hits.data(), nullptr, per_ray.data(), mode, traversal);
}

Status Accel::any_hits_counted(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                               std::span<queries::Counts> per_ray, queries::Mode mode,
                               const queries::TraversalOptions& traversal) const {
  if (auto s = same_length(rays.size(), occluded.size(), "answers"); !s) return s;
  if (auto s = same_length(rays.size(), per_ray.size(), "counts"); !s) return s;
  return state_->any(rays, occluded.data(), per_ray.data(), mode, traversal);
}

Box Accel::bounds() const {
  return state_->layout.bounds;
}
std::size_t Accel::bytes() const {
  return sizeof(Accel) + sizeof(State) + state_->layout.bytes();
}
std::size_t Accel::reference_count() const {
  return state_->layout.reference_count;
}
std::size_t Accel::excluded_count() const {
  return state_->excluded;
}
const std::string& Accel::isa() const {
  return state_->isa;
}
const layouts::Layout& Accel::layout() const {
  return state_->layout;
}
Executor& Accel::executor() const {
  return *state_->executor;
}

}  // namespace boxwood
