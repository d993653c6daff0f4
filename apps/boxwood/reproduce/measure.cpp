#include "reproduce/measure.h"

#include <algorithm>

#include "boxwood/metrics.h"
#include "boxwood/render.h"
#include "text.h"

namespace boxwood::program::reproduce {
namespace {

/// Trees kept for the next question about them; the oldest goes first.
constexpr std::size_t kKeptBytes = std::size_t{3} << 30;

/// Triangles that end-point overlap is estimated from; clipping all of a large mesh takes minutes.
constexpr std::size_t kOverlapSamples = 20000;

/// Seconds; shorter traces are repeated, since one turn of another process would be all that is seen of them.
constexpr double kShortestTrace = 0.05;

/// Seconds; builds that take longer are not repeated in turns, and rounds of the others take about kTurnsTime.
constexpr double kShortBuild = 1, kTurnsTime = 10;
constexpr std::size_t kMostTurns = 15;

/// Seconds a million triangles take on two cores, measured; the builders that are not named take about three.
struct Rate {
  const char* builder;
  const char* key;  ///< with this option at this value
  const char* value;
  double seconds;
};
constexpr Rate kRates[] = {
    {"geometric", "grid.k", "4096", 60},
    {"geometric", "cost", "recursive", 80},
    {"geometric", "", "", 16},
    {"generic", "oracle.grid", "0", 18},
    {"generic", "", "", 42},
    {"spatial-split", "", "", 30},
    {"kd", "", "", 12},
};

double expected_seconds(const Subject& subject, const Method& method) {
  double rate = 3;
  for (const Rate& candidate : kRates) {
    if (method.builder != candidate.builder) continue;
    const auto setting = method.settings.find(candidate.key);
    if (*candidate.key && (setting == method.settings.end() || setting->second != candidate.value)) continue;
    rate = candidate.seconds;
    break;
  }
  return 1e-6 * rate * static_cast<double>(subject.input->mesh.triangles.size());
}

std::string subject_key(const Subject& subject) {
  return hash_text(subject.input->hash) + vector_text(subject.input->view.eye);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

}  // namespace

std::string Method::key() const {
  std::string key = builder + " " + presplit + " " + layout;
  for (const auto& [name, value] : settings) key += " " + name + "=" + value;
  return key;
}

Subject rotated(const Subject& subject, Vec3 degrees, Executor& executor) {
  auto input = std::make_shared<Input>(*subject.input);
  const Vec3 center = input->bounds.center();
  mesh::rotate(input->mesh, degrees, center);
  input->view = mesh::rotate(input->view, degrees, center);
  input->bounds = mesh::bounds(input->mesh, executor);
  input->hash = mesh::hash(input->mesh, executor);
  return {input, subject.label, subject.paper_scene};
}

std::string Laboratory::left_out(const Subject& subject, const Method& method) const {
  const builders::BuilderInfo* const info = builders::find(method.builder);
  const std::size_t count = subject.input->mesh.triangles.size();
  if (info && count > info->largest_sensible)
    return fmt::format("left out: takes at most {} triangles", with_thousands(info->largest_sensible));
  const double seconds = expected_seconds(subject, method);
  if (effort_.slow || seconds <= kSlowSeconds) return {};
  return fmt::format("left out: about {:.0f} min (--slow)", std::ceil(seconds / 60));
}

Result<const Laboratory::Tree*> Laboratory::tree(const Subject& subject, const Method& method) {
  const std::string key = subject_key(subject) + " " + method.key();
  for (const auto& tree : trees_)
    if (tree->key == key) return tree.get();
  const MeshView mesh = subject.input->mesh;
  const auto plan = plan_tree({method.builder, method.settings}, method.presplit);
  if (!plan) return plan.error();
  auto made = std::make_unique<Tree>();
  made->key = key;
  std::vector<double> milliseconds;
  const double begin = now();
  // Short builds are repeated; what takes seconds anyway is measured once.
  while (milliseconds.empty() ||
         (milliseconds.size() < static_cast<std::size_t>(effort_.repeat) && now() - begin < 2)) {
    const double start = now();
    auto tree = build_tree(mesh, *plan, {*session_.executor()});
    if (!tree) return tree.error();
    milliseconds.push_back(1e3 * (now() - start));
    made->tree = std::move(*tree);
  }
  const auto resolved = builders::resolve_options(plan->build.builder, plan->build.settings);
  if (!resolved) return resolved.error();
  AccelOptions options;
  options.layout = method.layout;
  options.executor = std::make_shared<SequentialExecutor>();
  auto accel = Accel::from_tree(mesh, made->tree, options);
  if (!accel) return accel.error();
  made->accel = std::move(*accel);
  BuildResult result;
  result.milliseconds = median(milliseconds);
  result.surface_area_cost = metrics::surface_area_cost(made->tree, resolved->cost());
  result.references = made->tree.references.size();
  result.primitives = mesh.triangle_count;
  result.bytes = made->accel->bytes();
  result.max_depth = tree::statistics(made->tree).max_depth;
  builds_.emplace(key, result);  // a tree made again after it went keeps its first time
  const auto held = [&] {
    std::size_t bytes = 0;
    for (const auto& tree : trees_) bytes += tree->tree.bytes() + tree->accel->bytes();
    return bytes;
  };
  while (!trees_.empty() && held() + made->tree.bytes() + made->accel->bytes() > kKeptBytes)
    trees_.erase(trees_.begin());
  trees_.push_back(std::move(made));
  return trees_.back().get();
}

Result<BuildResult> Laboratory::build(const Subject& subject, const Method& method) {
  if (const auto found = builds_.find(subject_key(subject) + " " + method.key()); found != builds_.end())
    return found->second;
  const auto made = tree(subject, method);
  if (!made) return made.error();
  return builds_.at((*made)->key);
}

Status Laboratory::time_builds_in_turns(const Subject& subject, const std::vector<Method>& methods) {
  struct Turn {
    TreePlan plan;
    BuildResult* result;
    std::vector<double> milliseconds;
  };
  std::vector<Turn> turns;
  double round = 0;  // seconds
  for (const Method& method : methods) {
    if (!left_out(subject, method).empty()) continue;
    if (const auto built = build(subject, method); !built) return built.error();
    BuildResult& result = builds_.at(subject_key(subject) + " " + method.key());
    auto plan = plan_tree({method.builder, method.settings}, method.presplit);
    if (!plan) return plan.error();
    if (result.milliseconds > 1e3 * kShortBuild) continue;
    turns.push_back({std::move(*plan), &result, {}});
    round += 1e-3 * result.milliseconds;
  }
  if (turns.empty()) return {};
  const auto fewest = static_cast<std::size_t>(effort_.repeat);
  const auto rounds = std::max(fewest, std::min(static_cast<std::size_t>(kTurnsTime / round), kMostTurns));
  for (std::size_t i = 0; i < rounds; ++i) {
    for (Turn& turn : turns) {
      const double start = now();
      if (const auto tree = build_tree(subject.input->mesh, turn.plan, {*session_.executor()}); !tree)
        return tree.error();
      turn.milliseconds.push_back(1e3 * (now() - start));
    }
    std::reverse(turns.begin(), turns.end());
  }
  for (Turn& turn : turns) turn.result->milliseconds = median(turn.milliseconds);
  return {};
}

Result<double> Laboratory::end_point_overlap(const Subject& subject, const Method& method) {
  const std::string key = subject_key(subject) + " " + method.key();
  if (const auto found = overlaps_.find(key); found != overlaps_.end()) return found->second;
  const auto made = tree(subject, method);
  if (!made) return made.error();
  const auto resolved = builders::resolve_options(method.builder, method.settings);
  if (!resolved) return resolved.error();
  return overlaps_[key] = metrics::end_point_overlap((*made)->tree, subject.input->mesh, resolved->cost(),
                                                     kOverlapSamples, *session_.executor())
                              .value;
}

Result<std::vector<Ray>> Laboratory::make_rays(const Subject& subject, Rays rays) const {
  switch (rays) {
    case Rays::primary:
      return render::primary_rays(subject.input->view, effort_.width, effort_.height);
    case Rays::random:
      return render::random_rays(subject.input->bounds, effort_.random_rays, effort_.seed);
    case Rays::lines:
      break;
  }
  return render::line_rays(subject.input->bounds, effort_.random_rays, effort_.seed);
}

Result<TraceResult> Laboratory::trace(const Subject& subject, const Method& method, Rays rays,
                                      const queries::TraversalOptions& traversal) {
  const std::string rays_key = fmt::format("{} {}", subject_key(subject), static_cast<int>(rays));
  const std::string key = fmt::format("{} {} {} {} {}", rays_key, method.key(), queries::name(traversal.traversal),
                                      traversal.packet_size, traversal.terminating);
  if (const auto found = traces_.find(key); found != traces_.end()) return found->second;
  const auto made = tree(subject, method);
  if (!made) return made.error();
  if (rays_key_ != rays_key) {
    auto set = make_rays(subject, rays);
    if (!set) return set.error();
    rays_ = std::move(*set);
    rays_key_ = rays_key;
  }
  const Accel& accel = *(*made)->accel;
  std::vector<Hit> hits(rays_.size());
  std::vector<queries::Counts> counts(rays_.size());
  constexpr auto kMode = queries::Mode::robust;
  if (Status status = accel.closest_hits_counted(rays_, hits, counts, kMode, traversal); !status) return status.error();
  queries::Counts total;
  for (const queries::Counts& count : counts) total += count;
  std::vector<double> mrays;
  for (int i = 0; i < effort_.repeat; ++i) {
    const double start = now();
    std::size_t passes = 0;
    do {
      if (Status status = accel.closest_hits(rays_, hits, {}, kMode, traversal); !status) return status.error();
      ++passes;
    } while (now() - start < kShortestTrace);
    mrays.push_back(1e-6 * static_cast<double>(passes * rays_.size()) / (now() - start));
  }
  const double n = static_cast<double>(rays_.size());
  return traces_[key] = {static_cast<double>(total.nodes) / n, static_cast<double>(total.primitives) / n,
                         median(mrays)};
}

}  // namespace boxwood::program::reproduce
