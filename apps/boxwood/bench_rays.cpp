#include "bench_rays.h"

#include <algorithm>
#include <cmath>

#include "text.h"

namespace boxwood::program {
namespace {

constexpr float kTolerance = 1e-5f;  // of t, where two programs name different triangles

/// What one contestant said of one ray set; only one of the two is in use.
struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint8_t> occluded;

  Answers(std::size_t count, bool any) : hits(any ? 0 : count), occluded(any ? count : 0) {}
  std::size_t hit_count() const {
    return static_cast<std::size_t>(
        std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.is_hit(); }) +
        std::count_if(occluded.begin(), occluded.end(), [](std::uint8_t o) { return o != 0; }));
  }
};

/// Seconds for the whole set on the chosen executor.
Result<double> trace(const Contestant& contestant, const RaySet& set, BenchExecutors& executors, Answers& answers) {
  const bool any = asks_any(set.kind);
  const double start = now();
  Status status;
  if (contestant.is_rival()) {
    if (any)
      contestant.rival->any_hits(set.rays, answers.occluded, contestant.calls, *executors.chosen);
    else
      contestant.rival->closest_hits(set.rays, answers.hits, contestant.calls, *executors.chosen);
  } else {
    status = any ? contestant.accel->any_hits(set.rays, answers.occluded, contestant.mode, contestant.traversal)
                 : contestant.accel->closest_hits(set.rays, answers.hits, {}, contestant.mode, contestant.traversal);
  }
  const double seconds = now() - start;
  if (!status) return status.error();
  return seconds;
}

Result<queries::Counts> count_work(const Contestant& contestant, const RaySet& set) {
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  const bool any = asks_any(set.kind);
  queries::Counts total;
  std::vector<queries::Counts> per_ray(std::min(kBlock, set.rays.size()));
  Answers answers(per_ray.size(), any);
  for (std::size_t begin = 0; begin < set.rays.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, set.rays.size() - begin);
    const auto rays = std::span(set.rays).subspan(begin, count);
    const auto counts = std::span(per_ray).first(count);
    const Status status = any ? contestant.accel->any_hits_counted(rays, std::span(answers.occluded).first(count),
                                                                   counts, contestant.mode, contestant.traversal)
                              : contestant.accel->closest_hits_counted(rays, std::span(answers.hits).first(count),
                                                                       counts, contestant.mode, contestant.traversal);
    if (!status) return status.error();
    for (const queries::Counts& c : counts) total += c;
  }
  return total;
}

std::string hit_text(const Hit& hit) {
  return hit ? fmt::format("triangle {} at t = {}", hit.primitive, hit.t) : "a miss";
}

bool agree(const Hit& a, const Hit& b) {
  if (a.primitive == b.primitive) return true;
  if (!a || !b) return false;
  return std::abs(a.t - b.t) <= kTolerance * std::max(std::abs(a.t), std::abs(b.t));
}

/// Counts rays on which `answers` and `reference` disagree and describes the first.
void compare(const Answers& answers, const Answers& reference, const std::string& reference_name, Row& row) {
  const std::size_t count = std::max(answers.hits.size(), answers.occluded.size());
  for (std::size_t i = 0; i < count; ++i) {
    const bool any = answers.hits.empty();
    if (any ? (answers.occluded[i] != 0) == (reference.occluded[i] != 0) : agree(answers.hits[i], reference.hits[i]))
      continue;
    if (row.disagreements++ != 0) continue;
    row.first_disagreement =
        any ? fmt::format("ray {}: {}, while {} says {}", i, answers.occluded[i] ? "a hit" : "a miss", reference_name,
                          reference.occluded[i] ? "a hit" : "a miss")
            : fmt::format("ray {}: {}, while {} says {}", i, hit_text(answers.hits[i]), reference_name,
                          hit_text(reference.hits[i]));
  }
}

/// Counts, warms up and compares: everything of a contestant's rows but the speed.
Result<Row> prepare(const Contestant& contestant, const RaySet& set, BenchExecutors& executors, Answers& answers,
                    const Contestant& reference, const Answers* reference_answers) {
  Row row;
  row.contestant = &contestant;
  row.kind = set.kind;
  row.rays = set.rays.size();
  if (!contestant.is_rival()) {
    const auto counts = count_work(contestant, set);
    if (!counts) return counts.error();
    row.nodes_per_ray = static_cast<double>(counts->nodes) / static_cast<double>(row.rays);
    row.packet_nodes_per_ray = static_cast<double>(counts->packet_nodes) / static_cast<double>(row.rays);
    row.primitives_per_ray = static_cast<double>(counts->primitives) / static_cast<double>(row.rays);
  }
  const auto warm_up = trace(contestant, set, executors, answers);
  if (!warm_up) return warm_up.error();
  row.hits = answers.hit_count();
  row.seconds.push_back(*warm_up);
  if (reference_answers)
    compare(answers, *reference_answers, fmt::format("{} {}", reference.builder, reference.layout), row);
  return row;
}

/// Times over those of the first rival of the same mode and thread count, round by round.
void set_ratios(std::vector<Row>& rows) {
  for (Row& row : rows) {
    const auto rival = std::find_if(rows.begin(), rows.end(), [&](const Row& other) {
      return other.contestant->is_rival() && other.contestant->mode == row.contestant->mode &&
             other.thread_index == row.thread_index;
    });
    if (rival != rows.end()) row.ratio = spread_of(ratios(rival->seconds, row.seconds));
  }
}

}  // namespace

Result<std::vector<RaySet>> make_ray_sets(const BenchPlan& plan, const Input& input, const View& view,
                                          const Accel& accel, const Session& session) {
  auto primary = render::primary_rays(view, plan.width, plan.height);
  if (!primary) return primary.error();
  std::vector<RaySet> sets;
  for (const RayKind kind : plan.kinds) {
    RaySet set{kind, {}, 0};
    switch (kind) {
      case RayKind::primary:
        set.rays = *primary;
        break;
      case RayKind::random:
        set.rays = render::random_rays(input.bounds, plan.random_rays, plan.seed);
        break;
      case RayKind::diffuse:
        set.rays = render::diffuse_rays(accel, *primary, plan.seed);
        break;
      case RayKind::occlusion:
        set.rays = render::occlusion_rays(accel, *primary, plan.seed);
        break;
      case RayKind::lines:
        set.rays = render::line_rays(input.bounds, plan.random_rays, plan.seed);
        break;
    }
    set.hash = render::hash(set.rays);
    if (set.rays.empty())
      session.warn(fmt::format("{}: no primary ray meets the mesh, so there are no {} rays; give another --camera",
                               input.mesh.name, name(kind)));
    else
      sets.push_back(std::move(set));
  }
  return sets;
}

Result<std::vector<Row>> measure(const BenchPlan& plan, const RaySet& set, const std::vector<Contestant>& contestants,
                                 BenchExecutors& executors, Progress& progress) {
  const std::size_t thread_counts = plan.thread_counts.size();
  executors.choose(thread_counts - 1);
  std::vector<Row> rows;  // contestant-major
  // The first of ours in each mode is what all others of that mode are compared with.
  std::vector<std::pair<const Contestant*, Answers>> references;
  Answers answers(set.rays.size(), asks_any(set.kind));
  for (const Contestant& contestant : contestants) {
    const auto reference = std::find_if(references.begin(), references.end(),
                                        [&](const auto& r) { return r.first->mode == contestant.mode; });
    const bool has_reference = reference != references.end();
    const auto row = prepare(contestant, set, executors, answers, has_reference ? *reference->first : contestant,
                             has_reference ? &reference->second : nullptr);
    if (!row) return row.error();
    if (!has_reference) references.emplace_back(&contestant, answers);
    for (std::size_t t = 0; t < thread_counts; ++t) rows.push_back(*row), rows.back().thread_index = t;
  }

  // The warm-up ran with all threads; with one it takes up to that many times as long, which only makes passes longer.
  std::vector<TimedCell> cells;
  for (const Row& row : rows) {
    const auto run = [&, contestant = row.contestant] { return trace(*contestant, set, executors, answers); };
    cells.push_back({run, [&executors, t = row.thread_index] { executors.choose(t); },
                     plan.thread_counts[row.thread_index], row.seconds[0]});
  }
  const Status status = measure_in_turns(cells, plan.repeat, [&](double share) { progress.update(share); });
  if (!status) return status.error();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<double> mrays;
    for (const double seconds : cells[r].seconds)
      mrays.push_back(1e-6 * static_cast<double>(set.rays.size()) / std::max(seconds, 1e-12));
    rows[r].mrays = spread_of(mrays);
    rows[r].repeated = cells[r].repeated, rows[r].disturbed = cells[r].disturbed;
    rows[r].seconds = std::move(cells[r].seconds);
  }
  set_ratios(rows);
  return rows;
}

}  // namespace boxwood::program
