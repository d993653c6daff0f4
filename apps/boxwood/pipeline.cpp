#include "pipeline.h"

#include "progress.h"
#include "text.h"

namespace boxwood::program {
namespace {

constexpr const char* kPresplitHelp =
    "Split references before building: none, evh:t=14, esc:k=1000, ... (boxwood presplits lists them)";

void check_presplit(CLI::Option* option) {
  option->type_name("ID[:KEY=VALUE,...]")->check([](const std::string& text) {
    const auto parsed = refs::parse_presplit(text);
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
  check_presplit(command.add_option("--presplit", presplit, kPresplitHelp)->capture_default_str());
}

void add_presplit_option(CLI::App& command, std::vector<std::string>& presplits) {
  check_presplit(command.add_option("--presplit", presplits, std::string(kPresplitHelp) + "; repeatable")
                     ->allow_extra_args(false));
}

void PipelineOptions::add_to(CLI::App& command) {
  command.add_option("-b,--builder", builder, "Builder (boxwood builders lists them)")
      ->type_name("ID")
      ->capture_default_str();
  add_settings_option(command, settings);
  add_presplit_option(command, presplit);
  command.add_option("-l,--layout", layout, "Node layout: linear, wide4, wide8, wide8-quads, wide16 or wide16-quads")
      ->type_name("NAME")
      ->capture_default_str();
}

Result<builders::BuildOptions> PipelineOptions::build_options() const {
  auto parsed = parse_settings(settings);
  if (!parsed) return Error{parsed.error().code, "--set: " + parsed.error().message};
  return builders::BuildOptions{builder, std::move(*parsed)};
}

Result<BuiltTree> build_tree(const MeshView& mesh, const refs::Presplit& presplit,
                             const builders::BuildOptions& options, Executor& executor,
                             const std::function<void(double)>& progress, std::vector<std::uint32_t>* split) {
  BuiltTree built;
  const double start = now();
  auto references = refs::make_references(mesh, executor);
  if (!references) return references.error();
  built.excluded = references->excluded;
  built.reference_seconds = now() - start;
  references = refs::apply_presplit(std::move(*references), mesh, presplit, executor, &built.presplit);
  if (!references) return references.error();
  built.presplit_seconds = now() - start - built.reference_seconds;
  std::vector<std::uint32_t> seen(split ? references->primitive_count : 0), repeated = seen;
  const auto mark = [&](std::uint32_t primitive) { (seen[primitive] ? repeated : seen)[primitive] = 1; };
  if (split)
    for (const refs::Reference& reference : references->references) mark(reference.primitive);
  auto tree = builders::build(std::move(*references), options, builders::BuildContext{executor, progress, nullptr});
  if (!tree) return tree.error();
  built.tree = std::move(*tree);
  if (split) {
    seen.assign(seen.size(), 0);
    for (const std::uint32_t primitive : built.tree.references) mark(primitive);
    *split = std::move(repeated);
  }
  built.tree_seconds = now() - start - built.reference_seconds - built.presplit_seconds;
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
                                                                      const refs::Presplit& presplit,
                                                                      const std::string& layout) {
  const auto resolved = builders::resolve_options(options.builder, options.settings);
  if (!resolved) return resolved.error();
  std::vector<std::pair<std::string, std::string>> echo{
      {"builder", options.builder}, {"presplit", presplit.text()}, {"layout", layout}};
  for (auto& entry : resolved->echo()) echo.push_back(entry);
  return echo;
}

Result<Pipeline> run_pipeline(const Input& input, const PipelineOptions& options, const Session& session,
                              std::vector<std::uint32_t>* split) {
  const auto build_options = options.build_options();
  if (!build_options) return build_options.error();
  const auto presplit = refs::parse_presplit(options.presplit);
  if (!presplit) return presplit.error();
  auto echo = echo_options(*build_options, *presplit, options.layout);
  if (!echo) return echo.error();
  if (const auto layout = layouts::find(options.layout); !layout) return layout.error();

  Progress progress("building " + options.builder, session.shows_progress());
  auto built = build_tree(
      input.mesh, *presplit, *build_options, *session.executor(), [&](double share) { progress.update(share); }, split);
  if (!built) return built.error();
  auto encoded = encode_tree(input.mesh, built->tree, options.layout, session.executor());
  if (!encoded) return encoded.error();
  warn_excluded(input, built->excluded, session);
  const double seconds = built->seconds() + encoded->encode_seconds;
  session.note("{}\n{}\n{}\nbuilt in {:.1f} ms\n", session.environment_line(encoded->accel.isa()), input.line(),
               options_line(*echo), 1e3 * seconds);
  return Pipeline{std::move(encoded->accel), built->excluded,       built->presplit, seconds,
                  std::move(*echo),          std::move(built->tree)};
}

}  // namespace boxwood::program
