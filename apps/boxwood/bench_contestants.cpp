#include "bench_contestants.h"

#include <algorithm>

#include "boxwood/metrics.h"
#include "pipeline.h"

namespace boxwood::program {
namespace {

/// A tree with its layouts, or a rival with its modes: what is built in one go, then traced by several contestants.
struct Own {
  std::string name;  // of the builder or quality level
  TreePlan tree;
  std::vector<std::shared_ptr<BuildFigures>> figures;  // per layout
  std::vector<std::shared_ptr<const Accel>> accels;    // per layout
};
struct Rival {
  const rivals::RivalInfo* info;
  queries::Mode mode;
  std::shared_ptr<BuildFigures> figures;
  std::shared_ptr<const rivals::Rival> rival;
};

std::shared_ptr<BuildFigures> make_figures(const BenchPlan& plan) {
  auto figures = std::make_shared<BuildFigures>();
  figures->milliseconds.resize(plan.thread_counts.size());
  return figures;
}

void describe(BuildFigures& figures, const tree::BinaryTree& tree, const Accel& accel, const tree::CostModel& cost) {
  const tree::Statistics shape = tree::statistics(tree);
  figures.surface_area_cost = metrics::surface_area_cost(tree, cost);
  figures.cost = cost;
  figures.nodes = shape.nodes;
  figures.leaves = shape.leaves;
  figures.references = shape.references;
  figures.max_depth = shape.max_depth;
  figures.max_leaf = shape.max_leaf;
  figures.bytes = accel.bytes();
  figures.hash = tree::hash(tree);
}

Status build_own(Own& own, bool is_first_tree, const BenchPlan& plan, const Input& input, std::size_t thread_index,
                 BenchExecutors& executors, const Session& session) {
  executors.choose(thread_index);
  TreeReport report;
  const auto built = build_tree(input.mesh, own.tree, {*executors.chosen}, &report);
  if (!built) return built.error();
  const bool is_first = own.accels.empty();
  if (is_first && is_first_tree) warn_excluded(input, report.excluded, session);
  for (std::size_t i = 0; i < plan.layouts.size(); ++i) {
    auto encoded = encode_tree(input.mesh, *built, plan.layouts[i], executors.chosen);
    if (!encoded) return encoded.error();
    BuildFigures& figures = *own.figures[i];
    figures.milliseconds[thread_index].push_back(1e3 * (report.seconds() + encoded->encode_seconds));
    if (is_first) {
      describe(figures, *built, encoded->accel, own.tree.cost);
      if (plan.measures_trees)
        figures.measures =
            i > 0 ? own.figures[0]->measures : measure_tree(*built, input.mesh, own.tree.cost, 0, *executors.chosen);
      own.accels.push_back(std::make_shared<const Accel>(std::move(encoded->accel)));
    }
  }
  if (tree::hash(*built) != own.figures[0]->hash)
    return {ErrorCode::malformed, fmt::format("{} built a different tree over {} with {} threads than before", own.name,
                                              input.mesh.name, plan.thread_counts[thread_index])};
  return {};
}

/// Builds that take long are measured once: their spread is small beside what repeating them costs.
constexpr double kLongBuildMilliseconds = 2000;

bool is_long_build(const Own& own, std::size_t thread_index) {
  const std::vector<double>& measured = own.figures[0]->milliseconds[thread_index];
  return !measured.empty() && measured[0] > kLongBuildMilliseconds;
}

Status build_rival(Rival& rival, const BenchPlan& plan, const Input& input, std::size_t thread_index) {
  auto opened = rivals::open(input.mesh, rival.info->id, rival.mode == queries::Mode::robust);
  if (!opened) return opened.error();
  const auto seconds = (*opened)->build(plan.thread_counts[thread_index]);
  if (!seconds) return seconds.error();
  rival.figures->milliseconds[thread_index].push_back(1e3 * *seconds);
  rival.figures->bytes = (*opened)->bytes();
  if (!rival.rival) rival.rival = std::move(*opened);
  return {};
}

std::vector<Contestant> list_contestants(const BenchPlan& plan, const std::vector<Own>& own,
                                         const std::vector<Rival>& rivals) {
  std::vector<Contestant> contestants;
  for (const Own& o : own)
    for (std::size_t i = 0; i < plan.layouts.size(); ++i)
      for (const queries::Mode mode : plan.modes)
        for (const queries::TraversalOptions& traversal : plan.traversals)
          if (queries::check_traversal(o.accels[i]->layout().id, traversal))
            contestants.push_back({o.name, o.tree.presplit.text(), o.tree.optimizer.text(), plan.layouts[i], mode,
                                   o.figures[i], o.accels[i], nullptr, traversal});
  for (const Rival& r : rivals)
    for (const RivalChoice& choice : plan.rivals)
      if (choice.rival == r.info)
        contestants.push_back({choice.id(),
                               "",
                               "",
                               std::string(choice.rival->id, choice.id().find(':')),
                               r.mode,
                               r.figures,
                               nullptr,
                               r.rival,
                               {},
                               choice.calls});
  return contestants;
}

}  // namespace

std::size_t Contestant::packet_size() const {
  switch (traversal.traversal) {
    case queries::Traversal::single:
      return 1;
    case queries::Traversal::packet4:
      return 4;
    case queries::Traversal::range:
    case queries::Traversal::partition:
      return traversal.packet_size;
    default:
      return 0;  // of no fixed size
  }
}

BenchExecutors make_executors(const BenchPlan& plan, const Session& session) {
  BenchExecutors executors;
  for (const int threads : plan.thread_counts) executors.by_thread_count.push_back(session.make_executor(threads));
  executors.chosen = std::make_shared<SwitchedExecutor>(executors.by_thread_count.back());
  return executors;
}

Result<std::vector<Contestant>> build_contestants(const BenchPlan& plan, const Input& input, BenchExecutors& executors,
                                                  const Session& session, Progress& progress) {
  std::vector<Own> own;
  for (const auto& options : plan.builders)
    for (const std::string& presplit : plan.presplits)
      for (const std::string& optimizer : plan.optimizers) {
        auto tree = plan_tree(options, presplit, optimizer);
        if (!tree) return tree.error();
        own.push_back({options.builder, std::move(*tree), {}, {}});
        for (std::size_t i = 0; i < plan.layouts.size(); ++i) own.back().figures.push_back(make_figures(plan));
      }
  std::vector<Rival> rivals;
  for (const RivalChoice& choice : plan.rivals)
    for (const queries::Mode mode : plan.modes) {
      const bool is_there = std::any_of(rivals.begin(), rivals.end(),
                                        [&](const Rival& r) { return r.info == choice.rival && r.mode == mode; });
      if (!is_there && (mode == queries::Mode::fast || choice.rival->has_robust))
        rivals.push_back({choice.rival, mode, make_figures(plan), nullptr});
    }

  const auto steps = static_cast<double>(plan.repeat) * static_cast<double>(plan.thread_counts.size()) *
                     static_cast<double>(own.size() + rivals.size());
  double done = 0;
  for (int repeat = 0; repeat < plan.repeat; ++repeat) {
    for (std::size_t t = 0; t < plan.thread_counts.size(); ++t) {
      for (Own& o : own) {
        progress.label(fmt::format("{}: building {}", input.mesh.name, o.name));
        if (!is_long_build(o, t))
          if (Status status = build_own(o, &o == &own[0], plan, input, t, executors, session); !status)
            return status.error();
        progress.update(++done / steps);
      }
      for (Rival& r : rivals) {
        progress.label(fmt::format("{}: building {}", input.mesh.name, r.info->id));
        if (Status status = build_rival(r, plan, input, t); !status) return status.error();
        progress.update(++done / steps);
      }
    }
  }
  return list_contestants(plan, own, rivals);
}

}  // namespace boxwood::program
