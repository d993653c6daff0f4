#include "duel/tracing.h"

#include "boxwood/render.h"

namespace boxwood::program::duel {

std::string Tracer::name() const {
  if (own) return own->name + (way == Way::batch ? " batch" : " single");
  return theirs->id + (theirs->robust ? " robust" : "") + (way == Way::packets ? ":packets" : "");
}

Result<double> trace(const Tracer& tracer, const Set& set, Executor& executor, Answers& answers) {
  const std::size_t count = set.rays.size();
  answers.hits.resize(set.any ? 0 : count), answers.occluded.resize(set.any ? count : 0);
  const double start = now();
  Status status;
  if (tracer.theirs) {
    const auto calls = tracer.way == Way::packets ? rivals::Calls::packets : rivals::Calls::single;
    if (set.any)
      tracer.theirs->rival->any_hits(set.rays, answers.occluded, calls, executor);
    else
      tracer.theirs->rival->closest_hits(set.rays, answers.hits, calls, executor);
  } else if (const Accel& accel = *tracer.own->accel; tracer.way == Way::batch) {
    status = set.any ? accel.any_hits(set.rays, answers.occluded, tracer.mode)
                     : accel.closest_hits(set.rays, answers.hits, {}, tracer.mode);
  } else if (set.any) {
    for (std::size_t i = 0; i < count; ++i) answers.occluded[i] = accel.any_hit(set.rays[i], tracer.mode);
  } else {
    for (std::size_t i = 0; i < count; ++i) answers.hits[i] = accel.closest_hit(set.rays[i], tracer.mode);
  }
  const double seconds = now() - start;
  if (!status) return status.error();
  return seconds;
}

Status measure(const Set& set, std::span<Tracer* const> tracers, int rounds, Executor& executor) {
  Answers answers;
  std::vector<TimedCell> cells;
  for (const Tracer* tracer : tracers) {
    const auto warm_up = trace(*tracer, set, executor, answers);
    if (!warm_up) return warm_up.error();
    cells.push_back({[&, tracer] { return trace(*tracer, set, executor, answers); }, {}, 1, *warm_up});
  }
  if (Status status = measure_in_turns(cells, rounds); !status) return status;
  for (std::size_t i = 0; i < tracers.size(); ++i) {
    tracers[i]->seconds = std::move(cells[i].seconds);
    tracers[i]->repeated = cells[i].repeated, tracers[i]->disturbed = cells[i].disturbed;
  }
  return {};
}

Result<Sets> make_sets(const Plan& plan, const Input& input, const Accel& accel, const Session& session) {
  Sets sets;
  auto primary = render::primary_rays(input.turned(input.view), plan.width, plan.height);
  if (!primary) return primary.error();
  sets.primary.rays = std::move(*primary);
  sets.random.rays = render::random_rays(input.bounds, sets.primary.rays.size(), plan.seed);
  sets.diffuse.rays = render::diffuse_rays(accel, sets.primary.rays, plan.seed);
  sets.occlusion.rays = render::occlusion_rays(accel, sets.primary.rays, plan.seed);
  if (sets.diffuse.rays.empty())
    session.warn(fmt::format("{}: no primary ray meets the mesh, so there are no diffuse and no occlusion rays",
                             input.mesh.name));
  return sets;
}

// Fisher and Yates with the generator splitmix64.
void shuffle(std::vector<Ray>& rays, std::uint64_t state) {
  for (std::size_t i = rays.size(); i > 1; --i) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u, z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    std::swap(rays[i - 1], rays[(z ^ z >> 31) % i]);
  }
}

}  // namespace boxwood::program::duel
