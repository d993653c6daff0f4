// boxwood reproduce: the papers' tables and figures, our values beside theirs.
#include <ctime>

#include "boxwood/io.h"
#include "camera.h"
#include "camera_file.h"
#include "commands.h"
#include "reproduce/paper_scenes.h"
#include "reproduce/tables.h"
#include "text.h"

namespace boxwood::program {
namespace {

using namespace reproduce;

struct ReproduceOptions {
  CommonOptions common;
  std::string table, size = "512x512", markdown, csv, charts, cameras;
  std::vector<std::string> inputs;
  InputOptions input;
  Effort effort;
  std::uint64_t random_rays = Effort{}.random_rays;
};

std::string table_list() {
  std::string list;
  for (const TableInfo& table : tables()) list += std::string(list.empty() ? "" : ", ") + table.id;
  return list;
}

std::string today() {
  const std::time_t time = std::time(nullptr);
  char text[32];
  return std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&time)) ? text : "";
}

std::string command_line(const ReproduceOptions& options) {
  std::string line = "boxwood reproduce " + options.table;
  for (const std::string& input : options.inputs) line += " " + input.substr(input.rfind('/') + 1);
  line += fmt::format(" --size {} --random-rays {} --repeat {} --seed {}", options.size, options.random_rays,
                      options.effort.repeat, options.effort.seed);
  if (!options.input.rotate.empty()) line += " --rotate " + options.input.rotate;
  if (!options.cameras.empty()) line += " --cameras " + options.cameras.substr(options.cameras.rfind('/') + 1);
  return line + (options.effort.slow ? " --slow" : "");
}

struct Outputs {
  std::string markdown, csv;
  std::vector<std::pair<std::string, std::string>> charts;
};

Status write_outputs(const ReproduceOptions& options, const Outputs& outputs) {
  for (const auto& [name, text] : outputs.charts)
    if (Status status = io::write_file(fmt::format("{}/{}.svg", options.charts, name), text); !status) return status;
  for (const auto& [path, text] : {std::pair{options.markdown, outputs.markdown}, {options.csv, outputs.csv}}) {
    if (path == "-")
      fmt::print("{}", text);
    else if (!path.empty())
      if (Status status = io::write_file(path, text); !status) return status;
  }
  return {};
}

Status run_reproduce(ReproduceOptions& options) {
  const Session session("reproduce", options.common, options.csv == "-" || options.markdown == "-");
  for (const std::string& path : {options.csv, options.markdown, options.common.json,
                                  options.charts.empty() ? std::string() : options.charts + "/chart.svg"})
    if (Status status = check_output_folder(path); !status) return status;
  if (options.table != "all" && !find_table(options.table))
    return {ErrorCode::unknown_name,
            fmt::format("there is no table '{}'; there are {} and all", options.table, table_list())};
  const auto size = parse_size(options.size);
  if (!size) return size.error();
  std::tie(options.effort.width, options.effort.height) = *size;
  options.effort.random_rays = options.random_rays;
  const auto isa = queries::choose_isa();
  if (!isa) return isa.error();

  std::vector<std::shared_ptr<const Input>> inputs;
  for (const std::string& text : options.inputs) {
    auto input = load_usable_input(text, options.input, session);
    if (!input) return input.error();
    if (Status status = apply_camera_file(options.cameras, *input, session); !status) return status;
    inputs.push_back(std::make_shared<Input>(std::move(*input)));
  }

  session.note("{}\n{}\n", session.environment_line(*isa), command_line(options));
  Json report = session.report(*isa);
  report["tables"] = Json::array();
  Outputs outputs;
  outputs.markdown = fmt::format("# The papers' tables, made again\n\nMade by `{}` on {}: {}.\n", command_line(options),
                                 today(), session.environment_line(*isa));
  Laboratory laboratory(session, options.effort);
  std::map<std::string, std::vector<Subject>> by_paper;
  const double start = now();
  for (const TableInfo& info : tables()) {
    if (options.table != "all" && options.table != info.id) continue;
    if (!by_paper.contains(info.paper)) {
      auto list = subjects(info.paper, inputs, session);
      if (!list) return list.error();
      by_paper[info.paper] = std::move(*list);
    }
    const double begin = now();
    const auto result = info.make(laboratory, by_paper[info.paper]);
    if (!result) return Error{result.error().code, fmt::format("{}: {}", info.id, result.error().message)};
    session.result("\n{}", text(result->table));
    session.note("({} took {:.0f} s)\n", info.id, now() - begin);
    std::fflush(stdout);
    outputs.markdown += "\n" + markdown(result->table);
    outputs.csv += csv(result->table, outputs.csv.empty());
    report["tables"].push_back(json(result->table));
    for (const Chart& chart : result->charts) {
      if (options.charts.empty()) continue;
      outputs.charts.emplace_back(chart.name, svg(chart));
      outputs.markdown += fmt::format("\n![{}](images/{}.svg)\n", chart.title, chart.name);
    }
  }
  outputs.markdown += fmt::format("\nAll of it took {:.0f} minutes.\n", std::ceil((now() - start) / 60));
  if (Status status = write_outputs(options, outputs); !status) return status;
  report["seconds"] = now() - start;
  return session.finish(report);
}

}  // namespace

void add_reproduce_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<ReproduceOptions>();
  CLI::App& command = *program.add_subcommand("reproduce", "Make the papers' tables again, our values beside theirs");
  command.add_option("TABLE", options->table, "all, or one of: " + table_list())->required()->type_name("");
  command.add_option("INPUT", options->inputs, "Meshes or scenes instead of the procedural stand-ins")->type_name("");
  command.add_flag("--slow", options->effort.slow, "Also the cells that take more than five minutes each");
  add_size_option(command, options->size);
  add_cameras_option(command, options->cameras);
  command.add_option("--random-rays", options->random_rays, "How many random rays")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 28).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--repeat", options->effort.repeat, "Measurements of each trace and each short build")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", options->effort.seed, "Seed of random rays")->type_name("S")->capture_default_str();
  command.add_option("--markdown", options->markdown, "Write the tables as Markdown to FILE, or '-'")
      ->type_name("FILE");
  command.add_option("--csv", options->csv, "Write the cells as CSV to FILE, or '-'")->type_name("FILE");
  command.add_option("--charts", options->charts, "Folder that exists, for the figures as SVG")->type_name("FOLDER");
  options->input.add_to(command);
  options->common.add_to(command);
  std::string list = "\nTables:\n";
  for (const TableInfo& table : tables()) list += fmt::format("  {:<9} {}\n", table.id, table.summary);
  command.footer(
      list +
      "\nExamples:\n"
      "  boxwood reproduce popov-4\n"
      "  boxwood reproduce popov-4 bunny.ply sponza.ply --csv cells.csv\n"
      "  boxwood reproduce all --markdown tables.md --charts images\n"
      "  boxwood reproduce all bunny.ply sponza.ply --cameras cameras.json --size 384x384 --random-rays 131072");
  command.callback([options, &run] {
    if ((options->csv == "-") + (options->common.json == "-") + (options->markdown == "-") > 1)
      throw CLI::ValidationError("only one of --csv, --json and --markdown can go to standard output");
    run = [options] { return run_reproduce(*options); };
  });
}

}  // namespace boxwood::program
