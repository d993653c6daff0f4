// Builds every contestant of a benchmark, each several times and with each number of threads, in turns.
#pragma once

#include "bench_types.h"
#include "progress.h"

namespace boxwood::program {

/// The executors of the plan's thread counts and the switch between them that every Accel here runs on.
struct BenchExecutors {
  std::vector<std::shared_ptr<Executor>> by_thread_count;
  std::shared_ptr<SwitchedExecutor> chosen;

  void choose(std::size_t thread_index) { chosen->set(by_thread_count[thread_index]); }
};
BenchExecutors make_executors(const BenchPlan& plan, const Session& session);

/// Ours first, in the plan's order (builder, layout, mode), then rivals. Also an error: a builder whose trees differ
/// between thread counts.
Result<std::vector<Contestant>> build_contestants(const BenchPlan& plan, const Input& input, BenchExecutors& executors,
                                                  const Session& session, Progress& progress);

}  // namespace boxwood::program
