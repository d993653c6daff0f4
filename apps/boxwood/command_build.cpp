// boxwood build: build, validate, measure.
#include <algorithm>
#include <optional>
#include <vector>

#include "boxwood/layouts.h"
#include "boxwood/metrics.h"
#include "boxwood/tree.h"
#include "commands.h"
#include "input.h"
#include "pipeline.h"
#include "progress.h"
#include "session.h"
#include "text.h"
#include "tree_measures.h"

namespace boxwood::program {
namespace {

struct BuildOptions {
  CommonOptions common;
  PipelineOptions pipeline;
  InputOptions input_options;
  std::string input;
  bool skip_validation = false, measures = false;
  std::size_t overlap_samples = 0;
};

/// All that is reported of one build.
struct Outcome {
  std::string built_by;  ///< builder whose tree was kept
  tree::BinaryTree tree;
  TreeReport built;
  double encode_seconds = 0, validate_seconds = 0;
  std::size_t bytes = 0, layout_nodes = 0;
  std::string isa;
  tree::Statistics statistics;
  double cost = 0;
  std::optional<TreeMeasures> measures;
  double measure_seconds = 0;
  Status valid;

  double build_seconds() const { return built.seconds() + encode_seconds; }
};

Status validate(const Input& input, const tree::BinaryTree& tree, const layouts::Layout& layout) {
  std::vector<Box> boxes(input.mesh.triangles.size());
  const MeshView mesh = input.mesh;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    if (mesh::is_usable(triangle)) boxes[i] = triangle.bounds();
  }
  tree::Expectation expectation;
  expectation.primitive_boxes = boxes;
  if (Status status = tree::validate(tree, expectation); !status) return status;
  return layouts::validate(layout, tree.references.span(), tree.splits_references, mesh);
}

Result<Outcome> build_and_measure(const BuildOptions& options, const TreePlan& plan, const Input& input,
                                  const Session& session) {
  Outcome outcome;
  Progress progress("building " + options.pipeline.builder, session.shows_progress());
  auto built = build_tree(
      input.mesh, plan, {*session.executor(), [&](double share) { progress.update(share); }, nullptr}, &outcome.built);
  if (!built) return built.error();
  outcome.tree = std::move(*built);
  outcome.built_by = outcome.built.kept_second_tree() ? plan.second.builder : plan.build.builder;
  const tree::BinaryTree& tree = outcome.tree;
  progress.update(-1);
  progress.label("encoding " + options.pipeline.layout);
  const auto encoded = encode_tree(input.mesh, tree, options.pipeline.layout, session.executor());
  if (!encoded) return encoded.error();
  outcome.encode_seconds = encoded->encode_seconds;
  outcome.bytes = encoded->accel.bytes();
  outcome.layout_nodes = encoded->accel.layout().node_count;
  outcome.isa = encoded->accel.isa();
  outcome.statistics = tree::statistics(tree);
  outcome.cost = metrics::surface_area_cost(tree, plan.cost);
  if (options.measures) {
    progress.label("measuring the tree");
    const double start = now();
    outcome.measures = measure_tree(tree, input.mesh, plan.cost, options.overlap_samples, *session.executor());
    outcome.measure_seconds = now() - start;
  }
  if (!options.skip_validation) {
    progress.label("validating");
    const double start = now();
    outcome.valid = validate(input, tree, encoded->accel.layout());
    outcome.validate_seconds = now() - start;
  }
  return outcome;
}

Json presplit_json(const Echo& echo, const refs::PresplitReport& presplit) {
  const auto is_presplit = [](const auto& entry) { return entry.first == "presplit"; };
  Json json;
  json["method"] = std::find_if(echo.begin(), echo.end(), is_presplit)->second;
  json["references_before"] = presplit.references_before;
  json["references_after"] = presplit.references_after;
  json["area_reduction"] = presplit.area_reduction();
  json["cuts"] = presplit.splits;
  json["best_factor"] = presplit.best_factor;
  json["average_factor"] = presplit.average_factor;
  json["worst_factor"] = presplit.worst_factor;
  json["threshold"] = presplit.threshold;
  json["t"] = presplit.t;
  return json;
}

Json build_json(const BuildOptions& options, const Session& session, const Input& input, const Echo& echo,
                const Outcome& outcome) {
  const tree::Statistics& shape = outcome.statistics;
  Json report = session.report(outcome.isa);
  report["mesh"] = input.json();
  report["options"] = options_json(echo);
  report["builder"] = options.pipeline.builder;
  report["built_by"] = outcome.built_by;
  report["layout"] = options.pipeline.layout;
  report["presplit"] = presplit_json(echo, outcome.built.presplit);
  report["surface_area_cost"] = outcome.cost;
  report["build_ms"] = 1e3 * outcome.build_seconds();
  report["times_ms"] = {{"references", 1e3 * outcome.built.reference_seconds},
                        {"presplit", 1e3 * outcome.built.presplit_seconds},
                        {"tree", 1e3 * outcome.built.builder_seconds},
                        {"optimizer", 1e3 * outcome.built.optimizer_seconds},
                        {"encode", 1e3 * outcome.encode_seconds}};
  report["nodes"] = shape.nodes;
  report["leaves"] = shape.leaves;
  report["references"] = shape.references;
  report["excluded"] = outcome.built.excluded;
  report["max_depth"] = shape.max_depth;
  report["max_leaf"] = shape.max_leaf;
  report["average_leaf"] = shape.average_leaf;
  report["average_leaf_depth"] = shape.average_leaf_depth;
  report["leaf_histogram"] = shape.leaf_histogram;
  report["layout_nodes"] = outcome.layout_nodes;
  if (outcome.measures) {
    report.update(measures_json(*outcome.measures));
    report["measure_ms"] = 1e3 * outcome.measure_seconds;
  }
  report["bytes"] = outcome.bytes;
  report["tree_bytes"] = outcome.tree.bytes();
  report["notes"] = Json::object();
  for (const auto& [name, value] : outcome.tree.notes) report["notes"][name] = value;
  report["hash"] = hash_text(tree::hash(outcome.tree));
  report["valid"] = options.skip_validation ? Json() : Json(outcome.valid.has_value());
  if (!outcome.valid) report["invalid_because"] = outcome.valid.error().message;
  report["peak_memory_bytes"] = peak_memory_bytes();
  return report;
}

/// What went in and came out of the pre-split, and how much box area it saved (Dammertz and Keller 2008, Table 1).
template <class Line>
void print_presplit(const Line& line, const refs::PresplitReport& presplit) {
  const double before = static_cast<double>(std::max<std::size_t>(presplit.references_before, 1));
  line("presplit",
       fmt::format("{} references to {} ({:+.2f} %), box area x {:.4f}", with_thousands(presplit.references_before),
                   with_thousands(presplit.references_after),
                   100 * (static_cast<double>(presplit.references_after) / before - 1), presplit.area_reduction()));
  line("", fmt::format("{} cuts; area of a part over the whole: best {:.3f}, average {:.3f}, worst {:.3f}{}",
                       with_thousands(presplit.splits), presplit.best_factor, presplit.average_factor,
                       presplit.worst_factor, presplit.t > 0 ? fmt::format("; t = {}", presplit.t) : ""));
}

void print_measures(const Session& session, const Outcome& outcome) {
  const TreeMeasures& m = *outcome.measures;
  const auto line = [&](const char* key, const std::string& value) { session.result("  {:<16} {}\n", key, value); };
  const auto text = [](const metrics::Estimate& e) {
    return e.error > 0 ? fmt::format("{:.4f} +- {:.4f}", e.value, e.error) : fmt::format("{:.4f}", e.value);
  };
  line("EPO", fmt::format("{} (end-point overlap)", text(m.end_point_overlap)));
  line("LCV", fmt::format("{} (leaf count variability over random lines)", text(m.leaf_count_variability)));
  line("sibling overlap",
       fmt::format("{:.4f} of the area, {:.4f} of the volume", m.sibling_overlap.area, m.sibling_overlap.volume));
  line("per triangle", fmt::format("{:.4f} references", m.references_per_primitive));
}

void print_build(const BuildOptions& options, const Session& session, const Outcome& outcome) {
  const auto line = [&](const char* key, const std::string& value) { session.result("  {:<16} {}\n", key, value); };
  const tree::Statistics& shape = outcome.statistics;
  const double triangles = static_cast<double>(outcome.tree.primitive_count);
  session.result("{} -> {}\n", options.pipeline.builder, options.pipeline.layout);
  line("build", fmt::format("{:.1f} ms: references {:.1f}, presplit {:.1f}, tree {:.1f}, optimizer {:.1f}, "
                            "encode {:.1f} ({:.2f} Mtriangles/s)",
                            1e3 * outcome.build_seconds(), 1e3 * outcome.built.reference_seconds,
                            1e3 * outcome.built.presplit_seconds, 1e3 * outcome.built.builder_seconds,
                            1e3 * outcome.built.optimizer_seconds, 1e3 * outcome.encode_seconds,
                            1e-6 * triangles / outcome.build_seconds()));
  if (outcome.built.presplit.splits > 0) print_presplit(line, outcome.built.presplit);
  if (outcome.built.second_tree_cost > 0)
    line("kept", fmt::format("the tree of {}; whole triangles cost {:.3f} times as much as split ones",
                             outcome.built_by, outcome.built.second_tree_cost));
  line("Exp(T)", fmt::format("{:.4f}", outcome.cost));
  line("nodes", fmt::format("{}, {} of them leaves", with_thousands(shape.nodes), with_thousands(shape.leaves)));
  line("references", with_thousands(shape.references));
  line("depth", fmt::format("at most {}, leaves at {:.1f} on average", shape.max_depth, shape.average_leaf_depth));
  line("leaf size", fmt::format("at most {}, {:.2f} on average", shape.max_leaf, shape.average_leaf));
  if (outcome.measures) print_measures(session, outcome);
  line("memory", fmt::format("{:.1f} MiB in {} {} nodes; peak of the process {:.0f} MiB",
                             static_cast<double>(outcome.bytes) / (1 << 20), with_thousands(outcome.layout_nodes),
                             options.pipeline.layout, static_cast<double>(peak_memory_bytes()) / (1 << 20)));
  for (const auto& [name, value] : outcome.tree.notes) line("note", fmt::format("{}: {}", name, value));
  line("hash", hash_text(tree::hash(outcome.tree)));
  line("valid", options.skip_validation ? "not checked"
                : outcome.valid ? fmt::format("yes, tree and layout ({:.1f} ms)", 1e3 * outcome.validate_seconds)
                                : "no");
}

Status run_build(const BuildOptions& options) {
  const Session session("build", options.common);
  if (Status status = check_output_folder(options.common.json); !status) return status;
  const auto plan = options.pipeline.plan();
  if (!plan) return plan.error();
  const Echo echo = echo_options(*plan, options.pipeline.layout);
  if (const auto layout = layouts::find(options.pipeline.layout); !layout) return layout.error();
  const auto input = load_usable_input(options.input, options.input_options, session);
  if (!input) return input.error();
  const auto outcome = build_and_measure(options, *plan, *input, session);
  if (!outcome) return outcome.error();
  session.note("{}\n{}\n{}\n", session.environment_line(outcome->isa), input->line(), options_line(echo));
  print_build(options, session, *outcome);
  warn_excluded(*input, outcome->built.excluded, session);
  if (Status status = session.finish(build_json(options, session, *input, echo, *outcome)); !status) return status;
  if (!outcome->valid)
    return Error{outcome->valid.error().code, "the tree is not valid: " + outcome->valid.error().message};
  return {};
}

}  // namespace

void add_build_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App& command = *program.add_subcommand("build", "Build a tree, check it and measure it");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  options->pipeline.add_to(command);
  command.add_flag("--no-validate", options->skip_validation, "Do not check the tree and its layout");
  command.add_flag("--metrics", options->measures,
                   "Also end-point overlap, leaf count variability, sibling overlap, references per triangle");
  command
      .add_option("--overlap-samples", options->overlap_samples,
                  "Triangles to sample for end-point overlap; 0 = all of them, exactly (with --metrics)")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1} << 28).description(""))
      ->type_name("N")
      ->needs("--metrics")
      ->capture_default_str();
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood build bunny.ply\n"
      "  boxwood build bunny.ply --metrics\n"
      "  boxwood build bunny.ply --builder sweep-sah --set cost.traversal=2 --set cost.intersection=3\n"
      "  boxwood build scene:city,triangles=2000000 --builder hlbvh --layout wide4 --json report.json");
  command.callback([options, &run] { run = [options] { return run_build(*options); }; });
}

}  // namespace boxwood::program
