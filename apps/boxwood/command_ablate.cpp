// boxwood ablate: what each technique is worth, by leaving it out alone.
#include "boxwood/io.h"
#include "camera.h"
#include "camera_file.h"
#include "commands.h"
#include "duel/ablation.h"
#include "pipeline.h"
#include "table.h"
#include "text.h"

namespace boxwood::program {
namespace {

struct AblateOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  InputOptions input;
  PipelineOptions pipeline;
  std::string cameras, size = "512x512", markdown, csv;
  duel::Plan plan;
};

Table table_of(const duel::AblationResult& result) {
  Table table;
  table.column("without", Table::Align::left);
  table.column("build");
  table.column("memory");
  for (const auto& ray : result.rows.front().rays) table.column(ray.rays);
  for (const duel::AblationRow& row : result.rows) {
    std::vector<std::string> cells{row.technique, fmt::format("{:+.0f}", row.build_cost),
                                   fmt::format("{:+.0f}", row.memory_cost)};
    for (const auto& ray : row.rays)
      cells.push_back(fmt::format("{:+.0f} ({:+.0f} to {:+.0f})", ray.cost.median, ray.cost.lowest, ray.cost.highest));
    table.row(std::move(cells));
  }
  return table;
}

Json rows_json(const std::vector<duel::AblationResult>& results) {
  Json rows = Json::array();
  for (const duel::AblationResult& result : results)
    for (const duel::AblationRow& row : result.rows)
      for (const auto& ray : row.rays)
        rows.push_back({{"scene", result.scene},
                        {"triangles", result.triangles},
                        {"without", row.technique},
                        {"build_cost", row.build_cost},
                        {"memory_cost", row.memory_cost},
                        {"rays", ray.rays},
                        {"ray_cost", ray.cost.median},
                        {"ray_cost_min", ray.cost.lowest},
                        {"ray_cost_max", ray.cost.highest}});
  return rows;
}

std::string csv_text(const Json& rows) {
  std::string text = "scene,triangles,without,build_cost,memory_cost,rays,ray_cost,ray_cost_min,ray_cost_max\n";
  for (const Json& row : rows) {
    std::string line;
    for (const auto& [key, value] : row.items())
      line += (line.empty() ? "" : ",") + (value.is_string() ? csv_field(value.get<std::string>()) : value.dump());
    text += line + "\n";
  }
  return text;
}

Status run_ablate(AblateOptions& options) {
  const Session session("ablate", options.common, options.csv == "-" || options.markdown == "-");
  for (const std::string& path : {options.csv, options.markdown, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  const auto size = parse_size(options.size);
  if (!size) return size.error();
  std::tie(options.plan.width, options.plan.height) = *size;
  if (const auto plan = options.pipeline.plan(); !plan) return plan.error();
  AccelOptions whole{.build = {options.pipeline.builder, *parse_settings(options.pipeline.settings)},
                     .presplit = options.pipeline.presplit,
                     .optimizer = options.pipeline.optimizer,
                     .layout = options.pipeline.layout};
  if (const auto accel = Accel::build(MeshView{}, whole); !accel) return accel.error();
  const auto isa = queries::choose_isa();
  if (!isa) return isa.error();
  session.note("{}, {} rounds\n", session.environment_line(*isa), options.plan.repeat);

  std::vector<duel::AblationResult> results;
  std::string markdown;
  for (const std::string& text : options.inputs) {
    auto input = load_usable_input(text, options.input, session);
    if (!input) return input.error();
    if (Status status = apply_camera_file(options.cameras, *input, session); !status) return status;
    auto result = duel::ablate(options.plan, whole, *input, session);
    if (!result) return result.error();
    const std::string title = fmt::format("{}, {} triangles: cost in per cent of leaving one thing out", result->scene,
                                          with_thousands(result->triangles));
    const Table table = table_of(*result);
    session.result("\n{}\n{}", title, table.text());
    markdown += fmt::format("\n**{}**\n\n{}", title, table.markdown());
    for (const std::string& sentence : result->left_out) session.note("left out: {}\n", sentence);
    std::fflush(stdout);
    results.push_back(std::move(*result));
  }
  const Json rows = rows_json(results);
  for (const auto& [path, text] : {std::pair{options.markdown, markdown}, {options.csv, csv_text(rows)}}) {
    if (path == "-")
      fmt::print("{}", text);
    else if (!path.empty())
      if (Status status = io::write_file(path, text); !status) return status;
  }
  Json report = session.report(*isa);
  report["options"] = {{"builder", whole.build.builder}, {"presplit", whole.presplit}, {"optimizer", whole.optimizer},
                       {"layout", whole.layout},         {"size", options.size},       {"repeat", options.plan.repeat},
                       {"seed", options.plan.seed}};
  report["rows"] = rows;
  return session.finish(report);
}

}  // namespace

void add_ablate_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<AblateOptions>();
  options->pipeline.builder = "best";
  CLI::App& command = *program.add_subcommand("ablate", "What each technique is worth, by leaving it out alone");
  command.add_option("INPUT", options->inputs, kInputHelp)->required()->type_name("");
  options->pipeline.add_to(command);
  add_size_option(command, options->size);
  add_cameras_option(command, options->cameras);
  command.add_option("--repeat", options->plan.repeat, "Rounds, in each of which everyone has one pass")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", options->plan.seed, "Seed of rays")->type_name("S")->capture_default_str();
  command.add_option("--markdown", options->markdown, "Write the tables as Markdown to FILE, or '-'")
      ->type_name("FILE");
  command.add_option("--csv", options->csv, "Write the rows as CSV to FILE, or '-'")->type_name("FILE");
  options->input.add_to(command);
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood ablate scene:atrium,triangles=250000\n\n"
      "+10 under a ray kind: without it these rays take a tenth longer. In brackets the lowest and highest round.");
  command.callback([options, &run] {
    if ((options->csv == "-") + (options->common.json == "-") + (options->markdown == "-") > 1)
      throw CLI::ValidationError("only one of --csv, --json and --markdown can go to standard output");
    run = [options] { return run_ablate(*options); };
  });
}

}  // namespace boxwood::program
