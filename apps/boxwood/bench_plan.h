// The options that benchmarks share and the plan made of them; building and tracing by that plan.
#pragma once

#include "bench_types.h"

namespace CLI {
class App;
}

namespace boxwood::program {

struct BenchOptions {
  CommonOptions common;
  InputOptions input_options;
  std::vector<std::string> inputs, presplits, optimizers;
  std::vector<std::string> builders{"all"}, layouts{AccelOptions{}.layout}, modes{"robust"}, rivals, settings;
  std::vector<std::string> kinds{"primary", "random", "diffuse", "occlusion"}, traversals{"single"};
  std::string camera, size = "1024x1024", csv;
  int repeat = 3;
  std::uint64_t random_rays = 0, seed = 1;
  std::uint32_t packet_size = queries::TraversalOptions{}.packet_size;
  bool non_terminating = false;

  /// Those that every benchmark has: INPUT, builders, rays, repeats, --csv and the common ones.
  void add_to(CLI::App& command);
};

/// One word or several with commas, each time the option is given.
void add_list(CLI::App& command, const std::string& flag, std::vector<std::string>& list, const char* help);

Result<BenchPlan> make_plan(const BenchOptions& options, const Session& session);

/// Without the builders that are not meant for a mesh of this size; only those that were not asked for by name go. An
/// error when none is left.
Result<BenchPlan> fitted_plan(const BenchPlan& plan, const BenchOptions& options, const Input& input,
                              const Session& session);

/// Builds, makes the rays, traces.
Result<BenchResult> run_input(const BenchPlan& plan, const Input& input, const Session& session);

/// What has been asked for, with what the input turned out to be, as JSON.
Json plan_json(const BenchPlan& plan);
Json input_json(const BenchResult& result);
void note_plan(const BenchPlan& plan, const std::string& isa, const Session& session);
/// Writes rows as CSV to where --csv says, if anywhere.
Status write_csv(const BenchOptions& options, const Json& rows);

}  // namespace boxwood::program
