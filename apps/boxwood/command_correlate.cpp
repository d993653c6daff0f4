// boxwood correlate: how well the measures of a tree predict what its rays cost, over builders (Popov, Georgiev, Dimov
// and Slusallek 2009, table 1; Aila, Karras and Laine 2013).
#include <algorithm>

#include "bench_plan.h"
#include "bench_report.h"
#include "commands.h"
#include "correlation.h"
#include "table.h"
#include "text.h"

namespace boxwood::program {
namespace {

using Value = std::function<double(const Subject&)>;

struct Target {
  const char* key;
  const char* row;
  Value value;
};
const Target kTargets[] = {
    {"cost", "r with cost/ray", [](const Subject& s) { return s.cost_per_ray(); }},
    {"time", "r with ns/ray", [](const Subject& s) { return s.nanoseconds_per_ray(); }},
};

std::string group_table(const Group& group) {
  Table table;
  table.column("builder", Table::Align::left);
  for (const Measure& measure : measures()) {
    const bool is_overlap = std::string_view(measure.key).starts_with("sibling_overlap");
    table.column(measure.head, Table::Align::right, is_overlap ? "sibling overlap" : "");
  }
  table.column("ns/ray");
  for (const Subject& subject : group.subjects) {
    std::vector<std::string> cells{subject.contestant->builder};
    for (const Measure& measure : measures())
      cells.push_back(fmt::format("{:.{}f}", measure.value(subject), measure.decimals));
    cells.push_back(fmt::format("{:.1f}", subject.nanoseconds_per_ray()));
    table.row(std::move(cells));
  }
  for (const Target& target : kTargets) {
    std::vector<std::string> cells{target.row};
    for (const auto& r : group.correlations(target.value)) cells.push_back(r ? fmt::format("{:.3f}", *r) : "-");
    cells.push_back("");
    table.row(std::move(cells));
  }
  return group.title() + "\n" + table.text();
}

void add_correlations(const BenchResult& result, const Group& group, Json& list) {
  for (const Target& target : kTargets) {
    const auto values = group.correlations(target.value);
    for (std::size_t i = 0; i < values.size(); ++i)
      list.push_back({{"scene", result.input->mesh.name},
                      {"input", result.input->text},
                      {"layout", group.layout},
                      {"mode", queries::name(group.mode)},
                      {"rays", name(group.kind)},
                      {"terminating", group.terminating},
                      {"builders", group.subjects.size()},
                      {"measure", measures()[i].key},
                      {"with", target.key},
                      {"pearson", values[i] ? Json(*values[i]) : Json()}});
  }
}

/// The rows of bench with what is correlated.
void add_rows(const BenchPlan& plan, const BenchResult& result, Json& list) {
  Json rows = rows_json(plan, result);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Subject subject{result.rows[i].contestant, &result.rows[i]};
    rows[i]["cost_per_ray"] = subject.cost_per_ray();
    rows[i]["ns_per_ray"] = subject.nanoseconds_per_ray();
    list.push_back(std::move(rows[i]));
  }
}

Status run_correlate(const BenchOptions& options) {
  const Session session("correlate", options.common, options.csv == "-");
  for (const std::string& path : {options.csv, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  auto plan = make_plan(options, session);
  if (!plan) return plan.error();
  plan->measures_trees = true;
  plan->thread_counts = {session.threads()};
  // Where hits end no ray is something only the linear layout has; the others go without.
  if (std::find(plan->layouts.begin(), plan->layouts.end(), "linear") != plan->layouts.end())
    plan->traversals.push_back({queries::Traversal::single, options.packet_size, false});
  const auto isa = queries::choose_isa();
  if (!isa) return isa.error();
  note_plan(*plan, *isa, session);

  Json report = session.report(*isa);
  report["seed"] = plan->seed;
  report["options"] = plan_json(*plan);
  for (const char* key : {"inputs", "correlations", "rows"}) report[key] = Json::array();
  for (const std::string& text : options.inputs) {
    const auto input = load_bench_input(text, options, session);
    if (!input) return input.error();
    const auto fitted = fitted_plan(*plan, options, *input, session);
    if (!fitted) return fitted.error();
    const auto result = run_input(*fitted, *input, session);
    if (!result) return result.error();
    session.note("\n{}\ncamera: --camera {}\n", input->line(), camera_text(result->view));
    for (const Group& group : groups(*result)) {
      session.result("\n{}", group_table(group));
      add_correlations(*result, group, report["correlations"]);
    }
    std::fflush(stdout);
    report["inputs"].push_back(input_json(*result));
    add_rows(*fitted, *result, report["rows"]);
  }
  if (Status status = write_csv(options, report["correlations"]); !status) return status;
  return session.finish(report);
}

}  // namespace

void add_correlate_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<BenchOptions>();
  options->layouts = {"linear"};
  CLI::App& command = *program.add_subcommand("correlate", "How well measures of trees predict what rays cost");
  options->add_to(command);
  add_list(command, "-l,--layouts", options->layouts, "linear (the default), wide4, wide8, wide16, or all");
  command.footer(
      "\nExamples:\n"
      "  boxwood correlate bunny.ply --rays primary,random\n"
      "  boxwood correlate scene:atrium --layouts linear,wide8 --csv correlations.csv\n\n"
      "Builds with every builder, measures the trees and traces; then gives Pearson's correlation, over the builders, "
      "of\n"
      "each measure with the counted cost (C_T * inner nodes + C_I * triangles) and with the time of a ray. On the "
      "layout\n"
      "linear also for rays that hits do not end.");
  command.callback([options, &run] {
    if (options->csv == "-" && options->common.json == "-")
      throw CLI::ValidationError("--csv and --json can't both go to standard output");
    run = [options] { return run_correlate(*options); };
  });
}

}  // namespace boxwood::program
