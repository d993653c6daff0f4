// boxwood builders: what --builder takes, the quality levels and the registry of builders.
#include "boxwood/accel.h"
#include "boxwood/builders.h"
#include "commands.h"
#include "session.h"
#include "table.h"

namespace boxwood::program {
namespace {

struct BuildersOptions {
  CommonOptions common;
  bool show_settings = false;
};

std::string range_text(const builders::OptionSpec& spec) {
  if (spec.choices.empty()) return fmt::format("{} to {}", spec.lowest, spec.highest);
  std::string words;
  for (const char* choice : spec.choices) words += (words.empty() ? "" : ", ") + std::string(choice);
  return words;
}

std::string default_text(const builders::OptionSpec& spec) {
  return spec.choices.empty() ? fmt::format("{}", spec.default_value) : std::string(spec.choices[0]);
}

Json spec_json(const builders::OptionSpec& spec) {
  Json json;
  json["key"] = spec.key;
  json["description"] = spec.description;
  if (spec.choices.empty()) {
    json["default"] = spec.integer ? Json(static_cast<std::int64_t>(spec.default_value)) : Json(spec.default_value);
    json["lowest"] = spec.lowest;
    json["highest"] = spec.highest;
    json["integer"] = spec.integer;
  } else {
    json["default"] = spec.choices[0];
    json["choices"] = std::vector<std::string>(spec.choices.begin(), spec.choices.end());
  }
  return json;
}

Json builder_json(const builders::BuilderInfo& builder) {
  Json json;
  json["id"] = builder.id;
  json["name"] = builder.name;
  json["summary"] = builder.summary;
  json["paper"] = builder.paper;
  json["cost_class"] = builder.cost_class;
  json["splits_references"] = builder.splits_references;
  json["largest_sensible"] = builder.largest_sensible;
  json["options"] = Json::array();
  for (const auto& spec : builder.options) json["options"].push_back(spec_json(spec));
  for (const auto& spec : builders::common_options()) json["options"].push_back(spec_json(spec));
  return json;
}

void print_settings(const Session& session, std::span<const builders::OptionSpec> specs) {
  for (const auto& spec : specs)
    session.result("    {:<22} {} ({}; default {})\n", spec.key, spec.description, range_text(spec),
                   default_text(spec));
}

std::string stands_for(const QualityLevel& level) {
  std::string text = level.builder;
  if (std::string_view(level.presplit) != "none") text = std::string(level.presplit) + " + " + text;
  if (std::string_view(level.optimizer) != "none") text += std::string(" + ") + level.optimizer;
  if (level.second_builder) text += std::string(", or the same over ") + level.second_builder;
  return text;
}

Status run_builders(const BuildersOptions& options) {
  const Session session("builders", options.common);
  Json report = Json::array();
  std::size_t width = 0;
  for (const auto& builder : builders::registry()) width = std::max(width, std::string(builder.id).size());
  for (const QualityLevel& level : quality_levels())
    session.result("{:<{}}  quality level, {}: {}\n", level.id, width, level.summary, stands_for(level));
  for (const auto& builder : builders::registry()) {
    session.result("{:<{}}  {}\n", builder.id, width, builder.summary);
    if (options.show_settings) print_settings(session, builder.options);
    report.push_back(builder_json(builder));
  }
  if (options.show_settings) {
    session.result("every builder\n");
    print_settings(session, builders::common_options());
  }
  return session.finish(report);
}

}  // namespace

void add_builders_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<BuildersOptions>();
  CLI::App& command = *program.add_subcommand("builders", "List the quality levels and the builders");
  command.add_flag("--settings", options->show_settings, "List each builder's options for --set too");
  options->common.add_to(command);
  command.footer("\nExamples:\n  boxwood builders\n  boxwood builders --settings\n  boxwood builders --json -");
  command.callback([options, &run] { run = [options] { return run_builders(*options); }; });
}

}  // namespace boxwood::program
