// boxwood duel: is it faster than Embree on this machine? Ours and Embree in turns on the same rays, target by target.
#include <ctime>

#include "boxwood/io.h"
#include "camera.h"
#include "camera_file.h"
#include "commands.h"
#include "duel/duel_report.h"
#include "text.h"

namespace boxwood::program {
namespace {

constexpr std::size_t kSceneTriangles = 250'000;

struct DuelOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  InputOptions input;
  bool procedural = false;
  std::string cameras, size = "1024x1024", markdown, csv;
  duel::Plan plan;
};

/// What --procedural adds, and what a duel without INPUT is fought over.
std::vector<std::string> procedural_scenes() {
  std::vector<std::string> list;
  for (const auto& scene : mesh::scenes())
    list.push_back(fmt::format("scene:{},triangles={}", scene.id, kSceneTriangles));
  return list;
}

std::string command_line(const DuelOptions& options) {
  std::string line = "boxwood duel";
  for (const std::string& input : options.inputs) line += " " + input.substr(input.rfind('/') + 1);
  if (options.procedural) line += " --procedural";
  line += fmt::format(" --size {} --repeat {} --seed {}", options.size, options.plan.repeat, options.plan.seed);
  if (!options.cameras.empty()) line += " --cameras " + options.cameras.substr(options.cameras.rfind('/') + 1);
  return line;
}

std::string markdown(const DuelOptions& options, const std::vector<duel::SceneResult>& results, const Session& session,
                     const std::string& isa, double seconds) {
  std::time_t time = std::time(nullptr);
  char day[32];
  std::strftime(day, sizeof day, "%Y-%m-%d", std::gmtime(&time));
  std::string text = fmt::format("Made by `{}` on {}: {}; rival: {}. It took {:.0f} minutes.\n", command_line(options),
                                 day, session.environment_line(isa),
                                 options.plan.embree.empty() ? "none" : options.plan.embree, std::ceil(seconds / 60));
  for (const duel::ReportTable& table : duel::report_tables(results)) {
    if (table.is_detail) continue;
    text += fmt::format("\n**{}**\n\n{}", table.title, table.table.markdown());
    for (const std::string& note : table.notes) text += "\n" + note + "\n";
  }
  return text;
}

Status write_outputs(const DuelOptions& options, const std::string& markdown_text, const Json& cells) {
  for (const auto& [path, text] : {std::pair{options.markdown, markdown_text}, {options.csv, duel::cells_csv(cells)}}) {
    if (path == "-")
      fmt::print("{}", text);
    else if (!path.empty())
      if (Status status = io::write_file(path, text); !status) return status;
  }
  return {};
}

/// Checks the options before anything is built.
Status complete(DuelOptions& options, const Session& session) {
  duel::Plan& plan = options.plan;
  const auto size = parse_size(options.size);
  if (!size) return size.error();
  std::tie(plan.width, plan.height) = *size;
  for (const std::string& builder : {plan.fast, plan.balanced, plan.best})
    if (const auto accel = Accel::build(MeshView{}, {.build = {builder, {}}, .layout = plan.layout}); !accel)
      return accel.error();
  if (const auto embree = rivals::libraries()[0].version(); embree) plan.embree = *embree;
  plan.thread_counts = {1};
  if (session.threads() > 1) plan.thread_counts.push_back(session.threads());
  if (options.inputs.empty()) options.procedural = true;
  return {};
}

Status run_duel(DuelOptions& options) {
  const Session session("duel", options.common, options.csv == "-" || options.markdown == "-");
  for (const std::string& path : {options.csv, options.markdown, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  if (Status status = complete(options, session); !status) return status;
  const auto isa = queries::choose_isa();
  if (!isa) return isa.error();
  std::vector<std::string> inputs = options.inputs;
  if (options.procedural)
    for (const std::string& scene : procedural_scenes()) inputs.push_back(scene);

  session.note("{}\n{}\n", session.environment_line(*isa), command_line(options));
  std::vector<duel::SceneResult> results;
  Json report = session.report(*isa);
  report["inputs"] = Json::array();
  const double start = now();
  for (const std::string& text : inputs) {
    auto input = load_usable_input(text, options.input, session);
    if (!input) return input.error();
    if (Status status = apply_camera_file(options.cameras, *input, session); !status) return status;
    if (results.empty() && options.plan.embree.empty())
      session.warn(rivals::libraries()[0].version().error().message + ". Ours is measured alone");
    auto result = duel::fight(options.plan, *input, session);
    if (!result) return Error{result.error().code, fmt::format("{}: {}", text, result.error().message)};
    session.note("{}: {:.0f} s\n", input->line(), result->seconds);
    Json json = input->json();
    json["camera"] = result->camera, json["seconds"] = result->seconds;
    report["inputs"].push_back(std::move(json));
    results.push_back(std::move(*result));
  }
  const double seconds = now() - start;
  for (const duel::ReportTable& table : duel::report_tables(results)) {
    session.result("\n{}\n{}", table.title, table.table.text());
    for (const std::string& note : table.notes) session.result("{}\n", note);
  }
  report["rival_version"] = options.plan.embree.empty() ? Json() : Json(options.plan.embree);
  report["options"] = {{"fast", options.plan.fast}, {"balanced", options.plan.balanced},
                       {"best", options.plan.best}, {"layout", options.plan.layout},
                       {"size", options.size},      {"repeat", options.plan.repeat},
                       {"seed", options.plan.seed}, {"judge", options.plan.most_judged}};
  report["contests"] = duel::contests_json(results);
  report["cells"] = duel::cells_json(results);
  report["agreements"] = duel::agreements_json(results);
  report["seconds"] = seconds;
  if (Status status = write_outputs(options, markdown(options, results, session, *isa, seconds), report["cells"]);
      !status)
    return status;
  return session.finish(report);
}

}  // namespace

void add_duel_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<DuelOptions>();
  duel::Plan& plan = options->plan;
  plan.fast = "fast", plan.balanced = "balanced", plan.best = "best";
  plan.layout = queries::default_layout(), plan.most_judged = 100;
  CLI::App& command = *program.add_subcommand("duel", "Is it faster than Embree on this machine?");
  command.add_option("INPUT", options->inputs, kInputHelp)->type_name("");
  command.add_flag("--procedural", options->procedural,
                   fmt::format("Also every procedural scene with {} triangles; these alone without INPUT",
                               with_thousands(kSceneTriangles)));
  for (const auto& [flag, builder, rival] : {std::tuple{"--fast", &plan.fast, "LOW"},
                                             {"--balanced", &plan.balanced, "MEDIUM"},
                                             {"--best", &plan.best, "the better of MEDIUM and HIGH"}})
    command.add_option(flag, *builder, fmt::format("Builder that goes against Embree's {}", rival))
        ->type_name("ID")
        ->capture_default_str();
  command.add_option("-l,--layout", plan.layout, "Node layout")->type_name("NAME")->capture_default_str();
  add_size_option(command, options->size);
  add_cameras_option(command, options->cameras);
  command.add_option("--repeat", plan.repeat, "Rounds, in each of which everyone has one pass")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", plan.seed, "Seed of rays")->type_name("S")->capture_default_str();
  command.add_option("--judge", plan.most_judged, "Rays per set that differ and that brute force decides")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--markdown", options->markdown, "Write the tables as Markdown to FILE, or '-'")
      ->type_name("FILE");
  command.add_option("--csv", options->csv, "Write the cells as CSV to FILE, or '-'")->type_name("FILE");
  options->input.add_to(command);
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood duel\n"
      "  boxwood duel bunny.ply sponza.ply --cameras cameras.json --procedural --markdown duel.md\n\n"
      "Rays are traced with one thread. Ratios are above 1 where ours is faster; each is the median over the rounds.");
  command.callback([options, &run] {
    if ((options->csv == "-") + (options->common.json == "-") + (options->markdown == "-") > 1)
      throw CLI::ValidationError("only one of --csv, --json and --markdown can go to standard output");
    run = [options] { return run_duel(*options); };
  });
}

}  // namespace boxwood::program
