#include "duel/fighters.h"

#include <algorithm>

namespace boxwood::program::duel {
namespace {

constexpr double kLongBuild = 2;  // seconds

/// Copying the mesh in is not part of the time.
Result<double> build(Theirs& theirs, const Input& input, int threads) {
  auto rival = rivals::open(input.mesh, theirs.id, theirs.robust);
  if (!rival) return rival.error();
  const auto seconds = (*rival)->build(threads);
  if (!seconds) return seconds.error();
  theirs.rival = std::move(*rival);
  return *seconds;
}

/// The two in turns with one number of threads, after a warm-up that tells whether they take long.
Result<Cell> measure_pair(Own& own, Theirs& theirs, int threads, const Plan& plan, const Input& input,
                          Fighters& fighters) {
  fighters.executor->set(threads == 1 ? fighters.one : fighters.all);
  const auto warm_up = build(own, input, fighters.executor);
  if (!warm_up) return warm_up.error();
  std::vector<TimedCell> timed{{[&] { return build(own, input, fighters.executor); }, {}, threads, *warm_up}};
  if (!plan.embree.empty()) timed.push_back({[&] { return build(theirs, input, threads); }, {}, threads, *warm_up});
  if (Status status = measure_in_turns(timed, *warm_up > kLongBuild ? 1 : plan.repeat); !status) return status.error();
  Cell cell;
  cell.scene = input.mesh.name;
  cell.rays = fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
  cell.ours = own.name, cell.rival = theirs.id;
  cell.triangles = input.mesh.triangles.size();
  const double millions = 1e-6 * static_cast<double>(cell.triangles);
  cell.our_value = millions / spread_of(timed[0].seconds).median;
  for (const TimedCell& t : timed) cell.repeated += t.repeated, cell.disturbed += t.disturbed;
  if (timed.size() < 2) return cell;
  cell.rival_value = millions / spread_of(timed[1].seconds).median;
  cell.values = ratios(timed[1].seconds, timed[0].seconds);
  return cell;
}

Cell memory_cell(const Fighters& fighters, const Input& input) {
  Cell cell;
  cell.group = "bytes", cell.scene = input.mesh.name, cell.rays = "-";
  cell.ours = fighters.balanced.name, cell.rival = fighters.medium.id;
  cell.triangles = input.mesh.triangles.size();
  const auto per_triangle = [&](std::size_t bytes) {
    return static_cast<double>(bytes) / static_cast<double>(cell.triangles);
  };
  cell.our_value = per_triangle(fighters.balanced.accel->bytes());
  cell.values = {cell.our_value};
  if (fighters.medium.rival) cell.rival_value = per_triangle(fighters.medium.rival->bytes());
  return cell;
}

}  // namespace

Result<double> build(Own& own, const Input& input, const std::shared_ptr<Executor>& executor) {
  AccelOptions options = own.options;
  options.executor = executor;
  const double start = now();
  auto accel = Accel::build(input.mesh, options);
  const double seconds = now() - start;
  if (!accel) return accel.error();
  own.accel = std::make_shared<const Accel>(std::move(*accel));
  return seconds;
}

Result<Fighters> build_fighters(const Plan& plan, const Input& input, const Session& session,
                                std::vector<Cell>& cells) {
  Fighters fighters;
  fighters.one = session.make_executor(1);
  fighters.all = session.make_executor(plan.thread_counts.back());
  fighters.executor = std::make_shared<SwitchedExecutor>(fighters.all);
  for (const auto& [own, builder] :
       {std::pair{&fighters.fast, plan.fast}, {&fighters.balanced, plan.balanced}, {&fighters.best, plan.best}}) {
    own->name = own->options.build.builder = builder;
    own->options.layout = plan.layout;
  }
  struct {
    const char* group;
    Own* own;
    Theirs* theirs;
  } pairs[] = {{"build-balanced", &fighters.balanced, &fighters.medium}, {"build-fast", &fighters.fast, &fighters.low}};
  for (const auto& [group, own, theirs] : pairs) {
    for (const int threads : plan.thread_counts) {
      auto cell = measure_pair(*own, *theirs, threads, plan, input, fighters);
      if (!cell) return cell.error();
      cell->group = group;
      cells.push_back(std::move(*cell));
    }
  }
  cells.push_back(memory_cell(fighters, input));
  if (const auto built = build(fighters.best, input, fighters.executor); !built) return built.error();
  if (!plan.embree.empty())
    for (Theirs* theirs : {&fighters.high, &fighters.robust})
      if (const auto built = build(*theirs, input, plan.thread_counts.back()); !built) return built.error();
  return fighters;
}

}  // namespace boxwood::program::duel
