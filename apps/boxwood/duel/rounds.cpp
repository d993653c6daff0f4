#include "duel/rounds.h"

#include <algorithm>

#include "camera.h"
#include "duel/tracing.h"
#include "progress.h"

namespace boxwood::program::duel {
namespace {

using queries::Mode;

class Rounds {
 public:
  Rounds(const Plan& plan, const Input& input, Fighters& fighters, SceneResult& result)
      : plan_(plan), input_(input), fighters_(fighters), result_(result) {}

  Status measure_those_there(const Set& set, std::vector<Tracer*> tracers) {
    std::erase_if(tracers, [](const Tracer* t) { return !t->exists(); });
    fighters_.executor->set(fighters_.one);
    return measure(set, tracers, plan_.repeat, *fighters_.one);
  }

  /// A cell from what was measured: ours against the fastest of the rivals.
  void add(const char* group, const Set& set, const Tracer& ours, std::initializer_list<const Tracer*> rivals) {
    const auto speed = [&](const Tracer& t) {
      return 1e-6 * static_cast<double>(set.rays.size()) / spread_of(t.seconds).median;
    };
    const Tracer* fastest = nullptr;
    for (const Tracer* rival : rivals)
      if (rival->exists() && (!fastest || speed(*rival) > speed(*fastest))) fastest = rival;
    Cell cell;
    cell.group = group, cell.scene = input_.mesh.name, cell.rays = set.name;
    cell.ours = ours.name(), cell.rival = (*rivals.begin())->name();
    cell.triangles = input_.mesh.triangles.size(), cell.ray_count = set.rays.size();
    cell.our_value = speed(ours);
    cell.repeated = ours.repeated, cell.disturbed = ours.disturbed;
    if (fastest) {
      cell.rival = fastest->name();
      cell.rival_value = speed(*fastest);
      cell.values = ratios(fastest->seconds, ours.seconds);
      cell.repeated += fastest->repeated, cell.disturbed += fastest->disturbed;
    }
    result_.cells.push_back(std::move(cell));
  }

  /// Robust mode against ROBUST, with all threads, not timed.
  Status compare(const Set& set) {
    const Tracer theirs{nullptr, &fighters_.robust};
    if (!theirs.exists()) return {};
    fighters_.executor->set(fighters_.all);
    const Tracer ours{&fighters_.best, nullptr, Way::batch, Mode::robust};
    Answers a, b;
    for (const auto& [tracer, answers] : {std::pair{&ours, &a}, {&theirs, &b}})
      if (const auto seconds = trace(*tracer, set, *fighters_.all, *answers); !seconds) return seconds.error();
    const Accel& accel = *fighters_.best.accel;
    result_.agreements.push_back(
        {input_.mesh.name, set.name, set.any,
         set.any ? rivals::compare_any(
                       input_.mesh, set.rays, a.occluded, b.occluded,
                       [&](const Ray& ray) { return accel.closest_hit(ray); }, *fighters_.all, plan_.most_judged)
                 : rivals::compare_closest(input_.mesh, set.rays, a.hits, b.hits, *fighters_.all, plan_.most_judged)});
    return {};
  }

  /// Closest hits in the order given; with `batch` also the batch of the contest of that name.
  Status closest(const Set& set, const char* batch) {
    Fighters& f = fighters_;
    Tracer best{&f.best}, balanced{&f.balanced}, fast{&f.fast}, robust{&f.best, nullptr, Way::single, Mode::robust};
    Tracer together{&f.best, nullptr, Way::batch};
    Tracer low{nullptr, &f.low}, medium{nullptr, &f.medium}, high{nullptr, &f.high}, their_robust{nullptr, &f.robust};
    std::vector<Tracer*> all{&best, &high, &balanced, &medium, &robust, &their_robust, &fast, &low};
    if (batch) all.push_back(&together);
    if (Status status = measure_those_there(set, all); !status) return status;
    add("closest-fast", set, best, {&high, &medium});
    add("closest-robust", set, robust, {&their_robust});
    add("trace-balanced", set, balanced, {&medium});
    add("trace-fast", set, fast, {&low});
    if (batch) add(batch, set, together, {&high, &medium});
    return compare(set);
  }

  /// Of the best tree, against all that Embree's two better qualities do the same way.
  Status best_against(const char* group, const Set& set, Way ours, Way theirs) {
    Tracer best{&fighters_.best, nullptr, ours}, medium{nullptr, &fighters_.medium, theirs},
        high{nullptr, &fighters_.high, theirs};
    if (Status status = measure_those_there(set, {&best, &high, &medium}); !status) return status;
    add(group, set, best, {&high, &medium});
    return {};
  }

  /// Every other ray of all sets teaches Accel::optimize, the others are timed: no decision about the tree saw them.
  Status optimized(std::span<const Set* const> sets) {
    std::vector<Ray> closest, any;
    std::vector<Set> held_out;
    for (const Set* set : sets) {
      held_out.push_back({set->name, set->any, {}});
      for (std::size_t i = 0; i < set->rays.size(); ++i)
        (i % 2 ? held_out.back().rays : set->any ? any : closest).push_back(set->rays[i]);
    }
    fighters_.executor->set(fighters_.all);
    auto result = fighters_.best.accel->optimize({.closest_hit = closest, .any_hit = any});
    if (!result) return result.error();
    const Own optimized{"optimized", {}, std::make_shared<const Accel>(std::move(result->accel))};
    for (const Set& set : held_out) {
      if (set.rays.empty()) continue;
      Tracer ours{&optimized}, best{&fighters_.best};
      if (Status status = measure_those_there(set, {&ours, &best}); !status) return status;
      add("optimize", set, ours, {&best});
    }
    return {};
  }

 private:
  const Plan& plan_;
  const Input& input_;
  Fighters& fighters_;
  SceneResult& result_;
};

Status trace_all(const Plan& plan, const Input& input, Fighters& fighters, SceneResult& result, Progress& progress,
                 const Session& session) {
  fighters.executor->set(fighters.all);
  auto sets = make_sets(plan, input, *fighters.best.accel, session);
  if (!sets) return sets.error();
  auto& [primary, random, diffuse, occlusion] = *sets;
  Rounds rounds(plan, input, fighters, result);
  const auto step = [&](const char* what) { progress.label(fmt::format("{}: {} rays", input.mesh.name, what)); };
  step("primary");
  if (Status status = rounds.closest(primary, "batch-coherent"); !status) return status;
  step("random");
  if (Status status = rounds.closest(random, "batch-incoherent"); !status) return status;
  if (!diffuse.rays.empty()) {
    step("diffuse");
    if (Status status = rounds.closest(diffuse, nullptr); !status) return status;
  }
  step("optimize");
  const Set* const all[] = {&primary, &random, &diffuse, &occlusion};
  if (Status status = rounds.optimized(all); !status) return status;
  if (!diffuse.rays.empty()) {
    step("diffuse, shuffled");
    diffuse.name = "diffuse, shuffled";
    shuffle(diffuse.rays, plan.seed);
    if (Status status = rounds.best_against("batch-incoherent", diffuse, Way::batch, Way::single); !status)
      return status;
    step("occlusion");
    if (Status status = rounds.best_against("any-hit", occlusion, Way::single, Way::single); !status) return status;
    if (Status status = rounds.compare(occlusion); !status) return status;
  }
  step("primary, any hit");
  primary.any = true;
  if (Status status = rounds.best_against("batch-coherent-any", primary, Way::batch, Way::packets); !status)
    return status;
  return rounds.compare(primary);
}

}  // namespace

Result<SceneResult> fight(const Plan& plan, const Input& input, const Session& session) {
  const double start = now();
  SceneResult result;
  result.scene = input.mesh.name, result.input = input.text, result.camera = camera_text(input.view);
  result.triangles = input.mesh.triangles.size();
  Progress progress(input.mesh.name + ": building", session.shows_progress());
  auto fighters = build_fighters(plan, input, session, result.cells);
  if (!fighters) return fighters.error();
  if (Status status = trace_all(plan, input, *fighters, result, progress, session); !status) return status.error();
  result.seconds = now() - start;
  return result;
}

}  // namespace boxwood::program::duel
