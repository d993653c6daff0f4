// The boxwood program: sub-commands over the library's public headers. Exit codes: 0 done, 1 failed, 2 wrong usage.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "boxwood/base.h"
#include "commands.h"
#include "text.h"

namespace {

using namespace boxwood;

enum ExitCode { kDone = 0, kFailed = 1, kWrongUsage = 2 };

constexpr const char* kExamples = R"(
Examples:
  boxwood info bunny.ply
  boxwood build bunny.ply --builder sweep-sah --set cost.traversal=2 --set cost.intersection=3
  boxwood bench scene:atrium,triangles=100000 --builders all --size 512x512
  boxwood render scene:city -o city.png --size 1280x720 --shade ao
  boxwood trace bunny.ply --rays rays.npy -o hits.npy --json -

INPUT is a mesh file (PLY, OBJ, STL, glTF, ...) or a procedural scene,
scene:NAME[,triangles=N][,seed=S][,rotate=X:Y:Z]...
The environment variable BOXWOOD_ISA forces an instruction set: avx512, avx2, sse4 or scalar.
)";

int fail(const std::string& sentence, ExitCode code) {
  std::fflush(stdout);
  fmt::print(stderr, "boxwood: {}\n", program::one_line(sentence));
  return code;
}

/// CLI11 says of an unknown sub-command only that one is required; people want to know which word it was.
std::string usage_sentence(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  std::string sentence = program::one_line(error.what());
  const std::string first = argc > 1 ? argv[1] : "";
  if (app.get_subcommands().empty() && !first.empty() && first[0] != '-') {
    std::string commands;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      commands += (commands.empty() ? "" : ", ") + command->get_name();
    sentence = fmt::format("there is no sub-command '{}'; there are {}", first, commands);
  }
  return sentence + " (boxwood --help tells more)";
}

int run_program(int argc, char** argv) {
  CLI::App app("Bounding volume hierarchies over triangle meshes: build, check, trace, measure, draw.", "boxwood");
  app.set_version_flag("--version", std::string("boxwood ") + version());
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(1);
  app.footer(kExamples);
  program::Run run;
  program::add_builders_command(app, run);
  program::add_presplits_command(app, run);
  program::add_optimizers_command(app, run);
  program::add_levels_command(app, run);
  program::add_scenes_command(app, run);
  program::add_info_command(app, run);
  program::add_build_command(app, run);
  program::add_subdivide_command(app, run);
  program::add_trace_command(app, run);
  program::add_bench_command(app, run);
  program::add_duel_command(app, run);
  program::add_ablate_command(app, run);
  program::add_tune_command(app, run);
  program::add_correlate_command(app, run);
  program::add_render_command(app, run);
  program::add_reproduce_command(app, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // help or version
    app.exit(success, std::cout, std::cerr);
    return kDone;
  } catch (const CLI::ParseError& error) {
    return fail(usage_sentence(app, error, argc, argv), kWrongUsage);
  }
  const Status status = run();
  if (!status) return fail(status.error().message, kFailed);
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) return fail("standard output can't be written", kFailed);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail("out of memory", kFailed);
  } catch (const std::exception& exception) {
    return fail(std::string("unexpected error: ") + exception.what(), kFailed);
  }
}
