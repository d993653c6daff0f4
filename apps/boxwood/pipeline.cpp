#include "pipeline.h"

#include <algorithm>

#include "progress.h"
#include "text.h"

namespace boxwood::program {
namespace {

constexpr const char* kPresplitHelp =
    "Split references before building: none, evh:t=14, esc:k=1000, ... (boxwood presplits lists them; default: the "
    "quality level's, or none)";
constexpr const char* kOptimizerHelp =
    "Better the tree: none, reinsertion, reinsertion:passes=4 (boxwood builders lists them; default: the quality "
    "level's, or none)";

/// Makes an option refuse what can't be read as wrong usage.
template <class Parse>
void check_method(CLI::Option* option, Parse parse) {
  option->type_name("ID[:KEY=VALUE,...]")->check([parse](const std::string& text) {
    const auto parsed = parse(text);
    return parsed ? std::string() : parsed.error().message;
  });
}

}  // namespace

void add_settings_option(CLI::App& command, std::vector<std::string>& settings) {
  command.add_option("--set", settings, "Option of the builder, key=value; repeatable (boxwood builders lists them)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        const auto setting = parse_setting(text);
        return setting ? std::string() : setting.error().message;
      });
}

void add_presplit_option(CLI::App& command, std::string& presplit) {
  check_method(command.add_option("--presplit", presplit, kPresplitHelp), &refs::parse_presplit);
}

void add_presplit_option(CLI::App& command, std::vector<std::string>& presplits) {
  check_method(
      command.add_option("--presplit", presplits, std::string(kPresplitHelp) + "; repeatable")->allow_extra_args(false),
      &refs::parse_presplit);
}

void add_optimizer_option(CLI::App& command, std::string& optimizer) {
  check_method(command.add_option("--optimizer", optimizer, kOptimizerHelp), &optimizers::parse_optimizer);
}

void add_optimizer_option(CLI::App& command, std::vector<std::string>& optimizers) {
  check_method(command.add_option("--optimizer", optimizers, std::string(kOptimizerHelp) + "; repeatable")
                   ->allow_extra_args(false),
               &optimizers::parse_optimizer);
}

void PipelineOptions::add_to(CLI::App& command) {
  command.add_option("-b,--builder", builder, "Quality level or builder (boxwood builders lists them)")
      ->type_name("ID")
      ->capture_default_str();
  add_settings_option(command, settings);
  add_presplit_option(command, presplit);
  add_optimizer_option(command, optimizer);
  command.add_option("-l,--layout", layout, "Node layout: linear, wide4, wide8, wide8-quads or wide16")
      ->type_name("NAME")
      ->capture_default_str();
}

Result<TreePlan> PipelineOptions::plan() const {
  auto parsed = parse_settings(settings);
  if (!parsed) return Error{parsed.error().code, "--set: " + parsed.error().message};
  return plan_tree({builder, std::move(*parsed)}, presplit, optimizer);
}

Result<BuiltAccel> encode_tree(const MeshView& mesh, const tree::BinaryTree& tree, const std::string& layout,
                               const std::shared_ptr<Executor>& executor) {
  AccelOptions options;
  options.layout = layout;
  options.executor = executor;
  const double start = now();
  auto accel = Accel::from_tree(mesh, tree, options);
  if (!accel) return accel.error();
  const double seconds = now() - start;
  return BuiltAccel{std::move(*accel), seconds};
}

Echo echo_options(const TreePlan& plan, const std::string& layout) {
  Echo echo = plan.echo();
  const auto optimizer = std::find_if(echo.begin(), echo.end(), [](const auto& e) { return e.first == "optimizer"; });
  echo.insert(optimizer + 1, {"layout", layout});
  return echo;
}

Result<Pipeline> run_pipeline(const Input& input, const PipelineOptions& options, const Session& session,
                              std::vector<std::uint32_t>* split) {
  const auto plan = options.plan();
  if (!plan) return plan.error();
  Echo echo = echo_options(*plan, options.layout);
  if (const auto layout = layouts::find(options.layout); !layout) return layout.error();

  Progress progress("building " + options.builder, session.shows_progress());
  TreeReport report;
  auto tree = build_tree(input.mesh, *plan,
                         {*session.executor(), [&](double share) { progress.update(share); }, nullptr}, &report, split);
  if (!tree) return tree.error();
  auto encoded = encode_tree(input.mesh, *tree, options.layout, session.executor());
  if (!encoded) return encoded.error();
  warn_excluded(input, report.excluded, session);
  const double seconds = report.seconds() + encoded->encode_seconds;
  session.note("{}\n{}\n{}\nbuilt in {:.1f} ms\n", session.environment_line(encoded->accel.isa()), input.line(),
               options_line(echo), 1e3 * seconds);
  return Pipeline{std::move(encoded->accel), report.excluded, report.presplit, seconds,
                  std::move(echo),           std::move(*tree)};
}

}  // namespace boxwood::program
