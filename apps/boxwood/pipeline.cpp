#include "pipeline.h"

#include "progress.h"
#include "text.h"

namespace boxwood::program {

void add_settings_option(CLI::App& command, std::vector<std::string>& settings) {
  command.add_option("--set", settings, "Option of the builder, key=value; repeatable (boxwood builders lists them)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        const auto setting = parse_setting(text);
        return setting ? std::string() : setting.error().message;
      });
}

void PipelineOptions::add_to(CLI::App& command) {
  command.add_option("-b,--builder", builder, "Builder (boxwood builders lists them)")
      ->type_name("ID")
      ->capture_default_str();
  add_settings_option(command, settings);
  command.add_option("-l,--layout", layout, "Node layout: linear, wide4, wide8 or wide8-quads")
      ->type_name("NAME")
      ->capture_default_str();
}

Result<builders::BuildOptions> PipelineOptions::build_options() const {
  auto parsed = parse_settings(settings);
  if (!parsed) return Error{parsed.error().code, "--set: " + parsed.error().message};
  return builders::BuildOptions{builder, std::move(*parsed)};
}

Result<BuiltTree> build_tree(const MeshView& mesh, const builders::BuildOptions& options, Executor& executor,
                             const std::function<void(double)>& progress) {
  BuiltTree built;
  const double start = now();
  auto references = refs::make_references(mesh, executor);
  if (!references) return references.error();
  built.excluded = references->excluded;
  built.reference_seconds = now() - start;
  auto tree = builders::build(std::move(*references), options, builders::BuildContext{executor, progress, nullptr});
  if (!tree) return tree.error();
  built.tree = std::move(*tree);
  built.tree_seconds = now() - start - built.reference_seconds;
  return built;
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

Result<std::vector<std::pair<std::string, std::string>>> echo_options(const builders::BuildOptions& options,
                                                                      const std::string& layout) {
  const auto resolved = builders::resolve_options(options.builder, options.settings);
  if (!resolved) return resolved.error();
  std::vector<std::pair<std::string, std::string>> echo{{"builder", options.builder}};
  if (!layout.empty()) echo.emplace_back("layout", layout);
  for (auto& entry : resolved->echo()) echo.push_back(entry);
  return echo;
}

Result<Pipeline> run_pipeline(const Input& input, const PipelineOptions& options, const Session& session) {
  const auto build_options = options.build_options();
  if (!build_options) return build_options.error();
  auto echo = echo_options(*build_options, options.layout);
  if (!echo) return echo.error();
  if (const auto layout = layouts::find(options.layout); !layout) return layout.error();

  Progress progress("building " + options.builder, session.shows_progress());
  auto built =
      build_tree(input.mesh, *build_options, *session.executor(), [&](double share) { progress.update(share); });
  if (!built) return built.error();
  auto encoded = encode_tree(input.mesh, built->tree, options.layout, session.executor());
  if (!encoded) return encoded.error();
  warn_excluded(input, built->excluded, session);
  const double seconds = built->reference_seconds + built->tree_seconds + encoded->encode_seconds;
  session.note("{}\n{}\n{}\nbuilt in {:.1f} ms\n", session.environment_line(encoded->accel.isa()), input.line(),
               options_line(*echo), 1e3 * seconds);
  return Pipeline{std::move(encoded->accel), built->excluded, seconds, std::move(*echo)};
}

}  // namespace boxwood::program
