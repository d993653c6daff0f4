#include "bench_plan.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <set>
#include <tuple>

#include "bench_contestants.h"
#include "bench_rays.h"
#include "bench_report.h"
#include "boxwood/io.h"
#include "commands.h"
#include "pipeline.h"
#include "text.h"

namespace boxwood::program {
namespace {

constexpr RayKind kKinds[] = {RayKind::primary, RayKind::random, RayKind::diffuse, RayKind::occlusion, RayKind::lines};

template <class T, class Same>
void drop_repeats(std::vector<T>& values, Same same) {
  std::vector<T> kept;
  for (const T& value : values)
    if (std::none_of(kept.begin(), kept.end(), [&](const T& k) { return same(k, value); })) kept.push_back(value);
  values = std::move(kept);
}

bool has_option(const builders::BuilderInfo& builder, const std::string& key) {
  const auto is_key = [&](const builders::OptionSpec& spec) { return key == spec.key; };
  const auto common = builders::common_options();
  return std::any_of(builder.options.begin(), builder.options.end(), is_key) ||
         std::any_of(common.begin(), common.end(), is_key);
}

/// The builder that a quality level or the id of a builder stands for; null: there is none.
const builders::BuilderInfo* builder_of(const std::string& id) {
  const QualityLevel* const level = find_quality_level(id);
  return builders::find(level ? level->builder : id);
}

/// With several builders a setting goes to those that have it; one that none has goes to all, so that the library
/// refuses it in its own words.
Status add_builders(const BenchOptions& options, BenchPlan& plan) {
  const auto settings = parse_settings(options.settings);
  if (!settings) return Error{settings.error().code, "--set: " + settings.error().message};
  std::vector<std::string> ids;
  for (const std::string& id : options.builders) {
    if (id == "all")
      for (const auto& builder : builders::registry()) ids.emplace_back(builder.id);
    else
      ids.push_back(id);
  }
  std::set<std::string> known_keys;
  for (const std::string& id : ids)
    for (const auto& [key, value] : *settings)
      if (const auto* builder = builder_of(id); builder && has_option(*builder, key)) known_keys.insert(key);
  std::set<std::string> seen;
  for (const std::string& id : ids) {
    if (!seen.insert(id).second) continue;
    builders::BuildOptions build{id, {}};
    const auto* builder = builder_of(id);
    for (const auto& [key, value] : *settings)
      if (!known_keys.contains(key) || (builder && has_option(*builder, key))) build.settings[key] = value;
    if (const auto tree = plan_tree(build); !tree) return tree.error();
    plan.builders.push_back(std::move(build));
  }
  return {};
}

Status add_layouts_and_modes(const BenchOptions& options, BenchPlan& plan) {
  for (const std::string& name : options.layouts) {
    if (name == "all") {
      for (const auto& layout : layouts::registry()) plan.layouts.emplace_back(layout.name);
      continue;
    }
    if (const auto layout = layouts::find(name); !layout) return layout.error();
    plan.layouts.push_back(name);
  }
  for (const std::string& name : options.modes) {
    const auto mode = queries::find_mode(name);
    if (!mode) return mode.error();
    plan.modes.push_back(*mode);
  }
  return {};
}

/// Each text as it is written out; "the quality level's" (empty) where none is given.
template <class Parse>
Status add_methods(const std::vector<std::string>& texts, Parse parse, std::vector<std::string>& list) {
  for (const std::string& text : texts) {
    const auto method = parse(text);
    if (!method) return method.error();
    list.push_back(method->text());
  }
  if (list.empty()) list.emplace_back();
  drop_repeats(list, std::equal_to<>());
  return {};
}

Status add_presplits_and_optimizers(const BenchOptions& options, BenchPlan& plan) {
  if (Status status = add_methods(options.presplits, &refs::parse_presplit, plan.presplits); !status) return status;
  return add_methods(options.optimizers, &optimizers::parse_optimizer, plan.optimizers);
}

/// Single rays, terminating, are what every layout has; each other choice needs a layout in the plan that has it.
Status add_traversals(const BenchOptions& options, BenchPlan& plan) {
  std::vector<queries::Traversal> traversals;
  for (const std::string& word : options.traversals) {
    const auto traversal = queries::find_traversal(word);
    if (!traversal) return traversal.error();
    traversals.push_back(*traversal);
  }
  drop_repeats(traversals, std::equal_to<>());
  for (const bool terminating : {true, false}) {
    if (!terminating && !options.non_terminating) continue;
    for (const queries::Traversal traversal : traversals)
      plan.traversals.push_back({traversal, options.packet_size, terminating});
  }
  for (const auto& traversal : plan.traversals) {
    Status possible;
    for (const std::string& layout : plan.layouts)
      if (possible = queries::check_traversal(*layouts::find(layout), traversal); possible) break;
    if (!possible) return Error{possible.error().code, possible.error().message + " (--layouts linear)"};
  }
  return {};
}

Status add_kinds(const BenchOptions& options, BenchPlan& plan) {
  for (const std::string& word : options.kinds) {
    const auto* kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](RayKind k) { return word == name(k); });
    if (kind == std::end(kKinds))
      return {ErrorCode::unknown_name,
              fmt::format("there is no ray kind '{}'; there are primary, random, diffuse, occlusion and lines", word)};
    plan.kinds.push_back(*kind);
  }
  return {};
}

Status add_rivals(const BenchOptions& options, BenchPlan& plan) {
  using rivals::EmbreeQuality;
  for (const std::string& word : options.rivals) {
    bool is_known = false;
    for (const EmbreeQuality quality : {EmbreeQuality::medium, EmbreeQuality::high, EmbreeQuality::low}) {
      const std::string id = std::string("embree:") + rivals::name(quality);
      if (word != "embree" && word != id) continue;
      is_known = true;
      plan.rivals.push_back({quality});
    }
    if (!is_known && !word.starts_with("embree"))
      return {ErrorCode::unknown_name,
              fmt::format("there is no rival '{}'; there is embree, or one of embree:low, embree:medium, embree:high",
                          word)};
    const auto version = rivals::embree_version();
    if (!version) return version.error();
    plan.rival_version = *version;
    if (!is_known)
      return {ErrorCode::unknown_name,
              fmt::format("there is no rival '{}'; Embree's qualities are low, medium and high", word)};
  }
  return {};
}

}  // namespace

Result<BenchPlan> make_plan(const BenchOptions& options, const Session& session) {
  BenchPlan plan;
  for (const auto add :
       {add_builders, add_presplits_and_optimizers, add_layouts_and_modes, add_traversals, add_kinds, add_rivals})
    if (Status status = add(options, plan); !status) return status.error();
  drop_repeats(plan.layouts, std::equal_to<>());
  drop_repeats(plan.modes, std::equal_to<>());
  drop_repeats(plan.kinds, std::equal_to<>());
  drop_repeats(plan.rivals, [](const RivalChoice& a, const RivalChoice& b) { return a.quality == b.quality; });
  const auto size = parse_size(options.size);
  if (!size) return size.error();
  std::tie(plan.width, plan.height) = *size;
  plan.random_rays = options.random_rays ? options.random_rays
                                         : static_cast<std::size_t>(plan.width) * static_cast<std::size_t>(plan.height);
  if (!options.camera.empty()) {
    const auto camera = parse_camera(options.camera);
    if (!camera) return camera.error();
    plan.camera = *camera;
  }
  plan.seed = options.seed;
  plan.repeat = options.repeat;
  plan.thread_counts.push_back(1);
  if (session.threads() > 1) plan.thread_counts.push_back(session.threads());
  return plan;
}

Result<BenchPlan> fitted_plan(const BenchPlan& plan, const BenchOptions& options, const Input& input,
                              const Session& session) {
  BenchPlan fitted = plan;
  std::erase_if(fitted.builders, [&](const builders::BuildOptions& build) {
    const auto* builder = builder_of(build.builder);
    const bool named =
        std::find(options.builders.begin(), options.builders.end(), build.builder) != options.builders.end();
    if (named || input.mesh.triangles.size() <= builder->largest_sensible) return false;
    session.warn(fmt::format("{} is left out: it takes up to {} triangles and {} has {}", build.builder,
                             with_thousands(builder->largest_sensible), input.mesh.name,
                             with_thousands(input.mesh.triangles.size())));
    return true;
  });
  if (fitted.builders.empty())
    return {ErrorCode::too_large, fmt::format("no builder is left that takes the {} triangles of {}",
                                              with_thousands(input.mesh.triangles.size()), input.mesh.name)};
  return fitted;
}

Result<BenchResult> run_input(const BenchPlan& plan, const Input& input, const Session& session) {
  BenchResult result;
  result.input = &input;
  result.view = plan.camera ? plan.camera->over(input.view) : input.view;
  BenchExecutors executors = make_executors(plan, session);
  Progress progress(input.mesh.name, session.shows_progress());
  auto contestants = build_contestants(plan, input, executors, session, progress);
  if (!contestants) return contestants.error();
  result.contestants = std::move(*contestants);
  executors.choose(plan.thread_counts.size() - 1);
  auto sets = make_ray_sets(plan, input, input.turned(result.view), *result.contestants.front().accel, session);
  if (!sets) return sets.error();
  result.ray_sets = std::move(*sets);
  for (const RaySet& set : result.ray_sets) {
    progress.update(-1);
    progress.label(fmt::format("{}: tracing {} rays", input.mesh.name, name(set.kind)));
    auto rows = measure(plan, set, result.contestants, executors, progress);
    if (!rows) return rows.error();
    result.rows.insert(result.rows.end(), rows->begin(), rows->end());
  }
  return result;
}

namespace {

/// What a builder is echoed with: its settings, behind what its quality level stands for.
Echo settings_of(const TreePlan& tree) {
  Echo echo = tree.echo();
  if (!tree.level) echo.erase(echo.begin(), echo.begin() + 3);
  return echo;
}

/// Methods that all builders share; "level" where each quality level has its own.
Json method_list(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(text.empty() ? "level" : text);
  return list;
}

}  // namespace

Json plan_json(const BenchPlan& plan) {
  Json json;
  json["builders"] = Json::object();
  for (const auto& build : plan.builders)
    if (const auto tree = plan_tree(build)) json["builders"][build.builder] = options_json(settings_of(*tree));
  json["presplits"] = method_list(plan.presplits);
  json["optimizers"] = method_list(plan.optimizers);
  json["layouts"] = plan.layouts;
  json["modes"] = Json::array();
  for (const auto mode : plan.modes) json["modes"].push_back(queries::name(mode));
  json["traversals"] = Json::array();
  for (const auto& traversal : plan.traversals)
    if (traversal.terminating) json["traversals"].push_back(queries::name(traversal.traversal));
  json["packet_size"] = plan.traversals.front().packet_size;
  json["non_terminating"] = !plan.traversals.back().terminating;
  json["rays"] = Json::array();
  for (const RayKind kind : plan.kinds) json["rays"].push_back(name(kind));
  json["rivals"] = Json::array();
  for (const RivalChoice& rival : plan.rivals)
    json["rivals"].push_back(std::string("embree:") + rivals::name(rival.quality));
  json["size"] = fmt::format("{}x{}", plan.width, plan.height);
  json["random_rays"] = plan.random_rays;
  json["repeat"] = plan.repeat;
  return json;
}

Json input_json(const BenchResult& result) {
  Json json = result.input->json();
  json["camera"] = camera_text(result.view);
  json["ray_sets"] = Json::array();
  for (const RaySet& set : result.ray_sets)
    json["ray_sets"].push_back({{"rays", name(set.kind)}, {"count", set.rays.size()}, {"hash", hash_text(set.hash)}});
  return json;
}

void note_plan(const BenchPlan& plan, const std::string& isa, const Session& session) {
  session.note("{}, ray seed {}, {} {} after a warm-up\n", session.environment_line(isa), plan.seed, plan.repeat,
               plan.repeat == 1 ? "repeat" : "repeats in turns");
  for (const auto& build : plan.builders)
    if (const auto tree = plan_tree(build)) session.note("  {}: {}\n", build.builder, options_line(settings_of(*tree)));
  if (plan.presplits.size() == 1 && !plan.presplits[0].empty())
    session.note("  pre-split before each: {}\n", plan.presplits[0]);
  if (plan.optimizers.size() == 1 && !plan.optimizers[0].empty())
    session.note("  optimizer after each: {}\n", plan.optimizers[0]);
  if (!plan.rivals.empty())
    session.note("  rival: {}, rtcIntersect1 and rtcOccluded1 in a loop; fast = default scene flags, robust = ROBUST\n",
                 plan.rival_version);
}

Status write_csv(const BenchOptions& options, const Json& rows) {
  if (options.csv.empty()) return {};
  const std::string text = csv(rows);
  if (options.csv != "-") return io::write_file(options.csv, text);
  fmt::print("{}", text);
  return {};
}

/// One word or several with commas, each time the option is given.
void add_list(CLI::App& command, const std::string& flag, std::vector<std::string>& list, const char* help) {
  command.add_option(flag, list, help)->delimiter(',')->allow_extra_args(false)->type_name("A,B");
}

void BenchOptions::add_to(CLI::App& command) {
  command.add_option("INPUT", inputs, kInputHelp)->required()->type_name("");
  input_options.add_to(command);
  add_presplit_option(command, presplits);
  add_optimizer_option(command, optimizers);
  add_list(command, "-b,--builders", builders, "Quality levels and builders, or all builders (the default: all)");
  add_settings_option(command, settings);
  add_list(command, "--modes", modes, "robust (the default), fast");
  add_list(command, "--rays", kinds, "primary, random, diffuse, occlusion (these by default), lines");
  add_size_option(command, size);
  add_camera_option(command, camera);
  command.add_option("--random-rays", random_rays, "How many random rays and lines (default: as many as pixels)")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 28).description(""))
      ->type_name("N");
  command.add_option("--seed", seed, "Seed of random, diffuse and occlusion rays and of lines")
      ->type_name("S")
      ->capture_default_str();
  command.add_option("--repeat", repeat, "Measurements of each trace, and of each build that takes under two seconds")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--csv", csv, "Write the rows as CSV to FILE, or '-' for standard output")->type_name("FILE");
  common.add_to(command);
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  if (n == 0) return {};
  return {n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]), values.front(), values.back()};
}

const char* name(RayKind kind) {
  switch (kind) {
    case RayKind::primary:
      return "primary";
    case RayKind::random:
      return "random";
    case RayKind::diffuse:
      return "diffuse";
    case RayKind::occlusion:
      return "occlusion";
    case RayKind::lines:
      break;
  }
  return "lines";
}

}  // namespace boxwood::program
