// The ray sets of a benchmark and the measuring of who traces them how fast.
#pragma once

#include "bench_contestants.h"
#include "bench_types.h"

namespace boxwood::program {

/// The plan's ray kinds over one mesh. `accel` answers where diffuse and occlusion rays start; any builder gives the
/// same rays. Kinds that end up without rays (a camera that sees nothing) are warned about and left out.
Result<std::vector<RaySet>> make_ray_sets(const BenchPlan& plan, const Input& input, const View& view,
                                          const Accel& accel, const Session& session);

/// For one ray set: counts work, warms up, compares answers, then lets the contestants trace in turns, each with each
/// number of threads, `repeat` times.
Result<std::vector<Row>> measure(const BenchPlan& plan, const RaySet& set, const std::vector<Contestant>& contestants,
                                 BenchExecutors& executors, Progress& progress);

}  // namespace boxwood::program
