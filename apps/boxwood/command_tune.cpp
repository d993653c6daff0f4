// boxwood tune: which builder, options, pre-split and layout trace these rays fastest, found by trying.
#include <algorithm>

#include "boxwood/render.h"
#include "camera.h"
#include "commands.h"
#include "ray_file.h"
#include "table.h"
#include "text.h"
#include "tune_search.h"

namespace boxwood::program {
namespace {

struct TuneOptions {
  CommonOptions common;
  InputOptions input_options;
  std::string input, rays = "diffuse", query = "closest", mode = "robust", camera, size = "512x512";
  double seconds = 60;
  std::uint64_t seed = 1;
};

constexpr const char* kKinds[] = {"primary", "random", "diffuse", "occlusion"};

bool is_file(const std::string& rays) {
  return rays.ends_with(".npy");
}

Result<std::vector<std::string>> read_kinds(const TuneOptions& options) {
  std::vector<std::string> kinds = split(options.rays, ',');
  for (const std::string& kind : kinds)
    if (std::find(std::begin(kKinds), std::end(kKinds), kind) == std::end(kKinds))
      return {ErrorCode::unknown_name,
              fmt::format("there are no rays '{}'; there are primary, random, diffuse and occlusion, several with "
                          "commas, or a file FILE.npy",
                          kind)};
  return kinds;
}

/// Every other ray is to be tuned for, the others are to be measured with.
void deal_out(std::span<const Ray> rays, bool any, TuneRaySets& sets) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    TuneRays& half = i % 2 == 0 ? sets.trained : sets.tested;
    (any ? half.any : half.closest).push_back(rays[i]);
  }
}

Status make_rays(const TuneOptions& options, const Input& input, const Session& session, TuneRaySets& sets) {
  const auto kinds = read_kinds(options);
  if (!kinds) return kinds.error();
  const auto size = parse_size(options.size);
  if (!size) return size.error();
  View view = input.view;
  if (!options.camera.empty()) {
    const auto camera = parse_camera(options.camera);
    if (!camera) return camera.error();
    view = camera->over(view);
  }
  const auto primary = render::primary_rays(input.turned(view), size->first, size->second);
  if (!primary) return primary.error();
  AccelOptions accel_options;
  accel_options.executor = session.executor();
  const auto accel = Accel::build(input.mesh, accel_options);
  if (!accel) return accel.error();
  for (const std::string& kind : *kinds) {
    const auto rays = kind == "primary"   ? *primary
                      : kind == "random"  ? render::random_rays(input.bounds, primary->size(), options.seed)
                      : kind == "diffuse" ? render::diffuse_rays(*accel, *primary, options.seed)
                                          : render::occlusion_rays(*accel, *primary, options.seed);
    if (rays.size() < 2)
      return {ErrorCode::invalid_argument,
              fmt::format("{}: no primary ray meets the mesh, so there are no {} rays; give another --camera",
                          input.mesh.name, kind)};
    deal_out(rays, kind == "occlusion", sets);
  }
  session.note("camera: --camera {}\n", camera_text(view));
  return {};
}

std::string table_of(const std::vector<TuneResult>& results, bool front_only) {
  Table table;
  table.column("builder", Table::Align::left);
  table.column("pre-split", Table::Align::left);
  table.column("optimizer", Table::Align::left);
  table.column("layout", Table::Align::left);
  table.column("for the rays", Table::Align::left);
  for (const char* head : {"build ms", "Mrays/s", "ratio", "MiB"}) table.column(head);
  std::vector<const TuneResult*> rows;
  for (const TuneResult& r : results)
    if (r.is_on_front || !front_only) rows.push_back(&r);
  std::stable_sort(rows.begin(), rows.end(), [](auto* a, auto* b) { return a->build_seconds < b->build_seconds; });
  for (const TuneResult* r : rows) {
    std::string builder = r->choice.build.builder;
    for (const auto& [key, value] : r->choice.build.settings) builder += fmt::format(" {}={}", key, value);
    const auto or_dash = [](const std::string& text) { return text.empty() ? std::string("-") : text; };
    table.row({builder, or_dash(r->choice.presplit), or_dash(r->choice.optimizer), r->choice.layout,
               r->choice.optimized ? "optimized" : "-", fmt::format("{:.1f}", 1e3 * r->build_seconds),
               fmt::format("{:.2f}", r->mrays), fmt::format("{:.2f}", r->ratio),
               fmt::format("{:.1f}", double(r->bytes) / (1 << 20))});
  }
  return table.text();
}

std::string sentence_of(const TuneResult& best, const TuneResult& first) {
  if (&best == &first)
    return "Keep the default, " + first.choice.text() + ": nothing that was tried traces these rays much faster.";
  return fmt::format(
      "Take {}: {:.2f} times as fast as the default on rays it has not seen, built in {:.2f} s ({:.2f} s), {:.1f} MiB "
      "({:.1f} MiB).",
      best.choice.text(), best.ratio, best.build_seconds, first.build_seconds, double(best.bytes) / (1 << 20),
      double(first.bytes) / (1 << 20));
}

Json json_of(const TuneResult& r) {
  Json json;
  json["builder"] = r.choice.build.builder;
  json["settings"] = Json::object();
  for (const auto& [key, value] : r.choice.build.settings) json["settings"][key] = value;
  json["presplit"] = r.choice.presplit;
  json["optimizer"] = r.choice.optimizer;
  json["layout"] = r.choice.layout;
  json["optimized"] = r.choice.optimized;
  json["build_ms"] = 1e3 * r.build_seconds;
  json["mrays"] = r.mrays;
  json["ratio"] = r.ratio;
  json["bytes"] = r.bytes;
  json["on_front"] = r.is_on_front;
  return json;
}

Json report_of(const TuneOptions& options, const Input& input, const TuneRaySets& rays, const Session& session,
               const std::string& isa) {
  Json report = session.report(isa);
  report["mesh"] = input.json();
  report["options"] = {{"rays", options.rays},       {"query", options.query}, {"mode", options.mode},
                       {"seconds", options.seconds}, {"size", options.size},   {"seed", options.seed}};
  report["trained_rays"] = rays.trained.size();
  report["tested_rays"] = rays.tested.size();
  return report;
}

Status run_tune(const TuneOptions& options) {
  const Session session("tune", options.common);
  if (Status status = check_output_folder(options.common.json); !status) return status;
  const auto mode = queries::find_mode(options.mode);
  if (!mode) return mode.error();
  const auto isa = queries::choose_isa();
  if (!isa) return isa.error();
  TuneRaySets rays;
  if (is_file(options.rays)) {
    const auto read = read_ray_file(options.rays);
    if (!read) return read.error();
    if (read->size() < 2)
      return {ErrorCode::invalid_argument,
              fmt::format("{} has {} rays; it takes at least 2, to tune for and to measure with", options.rays,
                          read->size())};
    deal_out(*read, options.query == "any", rays);
  } else if (const auto kinds = read_kinds(options); !kinds) {
    return kinds.error();
  }
  const auto input = load_usable_input(options.input, options.input_options, session);
  if (!input) return input.error();
  session.note("{}\n{}\n", session.environment_line(*isa), input->line());
  if (!is_file(options.rays))
    if (Status status = make_rays(options, *input, session, rays); !status) return status;
  session.note("rays: {}, {} to tune for, {} to measure with\n", options.rays, with_thousands(rays.trained.size()),
               with_thousands(rays.tested.size()));

  const auto results = search(*input, rays, {options.seconds, *mode}, session);
  if (!results) return results.error();
  const TuneResult& best = (*results)[recommended(*results)];
  const std::string sentence = sentence_of(best, results->front());
  session.note("\nAll {} that were tried\n{}", results->size(), table_of(*results, false));
  session.result("\nNo other builds as fast, traces as fast and is as small (ratio: to the default)\n{}",
                 table_of(*results, true));
  session.result("\n{}\n  command line: {}\n  C++: {}\n", sentence, best.choice.command_line(), best.choice.code());
  Json report = report_of(options, *input, rays, session, *isa);
  report["candidates"] = Json::array();
  for (const TuneResult& r : *results) report["candidates"].push_back(json_of(r));
  report["recommendation"] = json_of(best);
  report["recommendation"]["sentence"] = sentence;
  report["recommendation"]["command_line"] = best.choice.command_line();
  report["recommendation"]["code"] = best.choice.code();
  return session.finish(report);
}

}  // namespace

void add_tune_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<TuneOptions>();
  CLI::App& command = *program.add_subcommand("tune", "Find builder, options and layout for a mesh and its rays");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  command
      .add_option("-r,--rays", options->rays,
                  "primary, random, diffuse or occlusion, several with commas; or a file as boxwood trace reads it")
      ->type_name("KINDS|RAYS.npy")
      ->capture_default_str();
  command.add_option("--query", options->query, "What the rays of a file ask: closest or any hit")
      ->check(CLI::IsMember({"closest", "any"}))
      ->capture_default_str();
  command.add_option("--mode", options->mode, "robust (watertight) or fast")
      ->check(CLI::IsMember({"robust", "fast"}))
      ->capture_default_str();
  command.add_option("--seconds", options->seconds, "Nothing new is begun after so long, 0 to 86400")
      ->check(CLI::Range(0.0, 86400.0).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_camera_option(command, options->camera);
  add_size_option(command, options->size);
  command.add_option("--seed", options->seed, "Of random, diffuse and occlusion rays")
      ->type_name("N")
      ->capture_default_str();
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood tune bunny.ply --rays diffuse,occlusion --seconds 120\n"
      "  boxwood tune scene:atrium --rays rays.npy --query any --json tuned.json\n\n"
      "Every other ray is for optimizing trees, the rest for measuring. What is tried depends on the time there is "
      "and\n"
      "what is found on the machine; every tree and every hit does not.");
  command.callback([options, &run] { run = [options] { return run_tune(*options); }; });
}

}  // namespace boxwood::program
