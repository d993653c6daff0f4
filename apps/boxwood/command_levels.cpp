// boxwood levels, boxwood optimizers: the quality levels and the registry of optimizers.
#include <algorithm>

#include "boxwood/accel.h"
#include "commands.h"
#include "session.h"

namespace boxwood::program {
namespace {

template <class Rows>
std::size_t id_width(const Rows& rows) {
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, std::string(row.id).size());
  return width;
}

Json level_json(const QualityLevel& level) {
  Json json;
  json["id"] = level.id;
  json["summary"] = level.summary;
  json["presplit"] = level.presplit;
  json["builder"] = level.builder;
  json["settings"] = Json::object();
  for (const auto& [key, value] : level.settings) json["settings"][key] = value;
  json["optimizer"] = level.optimizer;
  json["second_builder"] = level.second_builder ? Json(level.second_builder) : Json(nullptr);
  json["build_cost"] = level.build_cost;
  json["memory"] = level.memory;
  return json;
}

Status run_levels(const CommonOptions& options) {
  const Session session("levels", options);
  Json report = Json::array();
  const std::size_t width = id_width(quality_levels());
  for (const QualityLevel& level : quality_levels()) {
    session.result("{:<{}}  {}\n", level.id, width, level.summary);
    std::string stands_for = std::string("--builder ") + level.builder;
    for (const auto& [key, value] : level.settings) stands_for += fmt::format(" --set {}={}", key, value);
    session.result("    {} --presplit {} --optimizer {}\n", stands_for, level.presplit, level.optimizer);
    if (level.second_builder)
      session.result("    or --builder {}, whose triangles stay whole, where that costs at most {} times as much\n",
                     level.second_builder, kSecondTreeAllowance);
    session.result("    build time against balanced: {}; memory: {}\n", level.build_cost, level.memory);
    report.push_back(level_json(level));
  }
  return session.finish(report);
}

Status run_optimizers(const CommonOptions& options) {
  const Session session("optimizers", options);
  Json report = Json::array();
  const std::size_t width = id_width(optimizers::optimizer_registry());
  for (const auto& optimizer : optimizers::optimizer_registry()) {
    session.result("{:<{}}  {}\n", optimizer.id, width, optimizer.summary);
    Json json;
    json["id"] = optimizer.id;
    json["summary"] = optimizer.summary;
    json["paper"] = optimizer.paper;
    json["options"] = Json::array();
    for (const auto& option : optimizer.options) {
      session.result("    {:<8} {} ({} to {}; default {})\n", option.key, option.description, option.lowest,
                     option.highest, option.default_value);
      json["options"].push_back({{"key", option.key},
                                 {"description", option.description},
                                 {"default", option.default_value},
                                 {"lowest", option.lowest},
                                 {"highest", option.highest},
                                 {"integer", option.integer}});
    }
    report.push_back(std::move(json));
  }
  return session.finish(report);
}

}  // namespace

void add_levels_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App& command = *program.add_subcommand("levels", "List the quality levels and what they stand for");
  options->add_to(command);
  command.footer("\nExamples:\n  boxwood levels\n  boxwood build bunny.ply --builder best");
  command.callback([options, &run] { run = [options] { return run_levels(*options); }; });
}

void add_optimizers_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App& command = *program.add_subcommand("optimizers", "List the optimizers of trees");
  options->add_to(command);
  command.footer(
      "\nExamples:\n  boxwood optimizers\n  boxwood build bunny.ply --builder binned-sah --optimizer "
      "reinsertion:passes=4");
  command.callback([options, &run] { run = [options] { return run_optimizers(*options); }; });
}

}  // namespace boxwood::program
