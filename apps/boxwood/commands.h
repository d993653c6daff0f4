// The sub-commands. Each `add_*` declares one and, when it is the one chosen, sets `run` to what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "boxwood/base.h"

namespace boxwood::program {

using Run = std::function<Status()>;

void add_builders_command(CLI::App& program, Run& run);
void add_presplits_command(CLI::App& program, Run& run);
void add_levels_command(CLI::App& program, Run& run);
void add_optimizers_command(CLI::App& program, Run& run);
void add_scenes_command(CLI::App& program, Run& run);
void add_info_command(CLI::App& program, Run& run);
void add_build_command(CLI::App& program, Run& run);
void add_subdivide_command(CLI::App& program, Run& run);
void add_trace_command(CLI::App& program, Run& run);
void add_bench_command(CLI::App& program, Run& run);
void add_duel_command(CLI::App& program, Run& run);
void add_ablate_command(CLI::App& program, Run& run);
void add_tune_command(CLI::App& program, Run& run);
void add_correlate_command(CLI::App& program, Run& run);
void add_render_command(CLI::App& program, Run& run);
void add_reproduce_command(CLI::App& program, Run& run);

}  // namespace boxwood::program
