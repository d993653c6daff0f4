// boxwood bench: builders, layouts, modes and rivals against each other on the same rays.
#include "bench_plan.h"
#include "bench_report.h"
#include "commands.h"
#include "text.h"

namespace boxwood::program {
namespace {

struct BenchCommand : BenchOptions {
  std::string table = "full";
};

Status run_bench(const BenchCommand& options) {
  const Session session("bench", options.common, options.csv == "-");
  for (const std::string& path : {options.csv, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  const auto plan = make_plan(options, session);
  if (!plan) return plan.error();
  const auto isa = queries::choose_isa();
  if (!isa) return isa.error();
  note_plan(*plan, *isa, session);

  Json report = session.report(*isa);
  report["seed"] = plan->seed;
  report["options"] = plan_json(*plan);
  if (!plan->rivals.empty()) report["rival_version"] = plan->rival_version;
  report["inputs"] = Json::array();
  report["rows"] = Json::array();
  for (const std::string& text : options.inputs) {
    const auto input = load_bench_input(text, options, session);
    if (!input) return input.error();
    const auto fitted = fitted_plan(*plan, options, *input, session);
    if (!fitted) return fitted.error();
    const auto result = run_input(*fitted, *input, session);
    if (!result) return result.error();
    session.note("\n{}\ncamera: --camera {}\n", input->line(), camera_text(result->view));
    session.result("\n{}", tables(*fitted, *result, options.table == "full"));
    std::fflush(stdout);
    report["inputs"].push_back(input_json(*result));
    for (auto& row : rows_json(*fitted, *result)) report["rows"].push_back(std::move(row));
  }
  report["peak_memory_bytes"] = peak_memory_bytes();
  if (Status status = write_csv(options, report["rows"]); !status) return status;
  return session.finish(report);
}

}  // namespace

void add_bench_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<BenchCommand>();
  CLI::App& command = *program.add_subcommand("bench", "Measure builders, layouts and rivals on the same rays");
  options->add_to(command);
  add_list(command, "-l,--layouts", options->layouts, "linear, wide4, wide8, wide8-quads, wide16, or all");
  add_list(
      command, "--rivals", options->rivals,
      "embree, embree:low, embree:medium, embree:high, with :packets behind; tinybvh, madmann; all that are installed");
  command.add_option("--table", options->table, "full, or summary: only the lines that sum it up")
      ->check(CLI::IsMember({"full", "summary"}))
      ->capture_default_str();
  add_list(command, "--traversals", options->traversals,
           "single (the default), batch; coherent, interleaved, sorted for wide8, wide8-quads and wide16; "
           "packet4, range, partition for linear");
  command.add_option("--packet-size", options->packet_size, "Rays in a packet of range and partition, 16 to 1024")
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--non-terminating", options->non_terminating,
                   "Also with rays that hits do not end, as the cost model has them (layout linear)");
  command.footer(
      "\nExamples:\n"
      "  boxwood bench bunny.ply\n"
      "  boxwood bench scene:atrium scene:foliage --builders binned-sah,sweep-sah --layouts all --csv rows.csv\n"
      "  boxwood bench bunny.ply --builders sweep-sah --modes robust,fast --rivals embree --json report.json\n\n"
      "Primary, random and diffuse rays ask for the closest hit, occlusion rays for any. Contestants trace in turns;\n"
      "each Mrays/s is the median over the repeats. 'differ' counts rays whose answer is not that of the first line "
      "of\n"
      "the same mode.");
  command.callback([options, &run] {
    if (options->csv == "-" && options->common.json == "-")
      throw CLI::ValidationError("--csv and --json can't both go to standard output");
    run = [options] { return run_bench(*options); };
  });
}

}  // namespace boxwood::program
