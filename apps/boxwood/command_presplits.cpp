// boxwood presplits: the registry of pre-splits.
#include <algorithm>

#include "boxwood/refs.h"
#include "commands.h"
#include "session.h"

namespace boxwood::program {
namespace {

Json presplit_json(const refs::PresplitInfo& presplit) {
  Json json;
  json["id"] = presplit.id;
  json["summary"] = presplit.summary;
  json["paper"] = presplit.paper;
  json["subdivides"] = presplit.subdivides;
  json["options"] = Json::array();
  for (const auto& option : presplit.options)
    json["options"].push_back({{"key", option.key},
                               {"description", option.description},
                               {"default", option.default_value},
                               {"lowest", option.lowest},
                               {"highest", option.highest}});
  return json;
}

Status run_presplits(const CommonOptions& options) {
  const Session session("presplits", options);
  Json report = Json::array();
  std::size_t width = 0;
  for (const auto& presplit : refs::presplits()) width = std::max(width, std::string(presplit.id).size());
  for (const auto& presplit : refs::presplits()) {
    session.result("{:<{}}  {}\n", presplit.id, width, presplit.summary);
    for (const auto& option : presplit.options)
      session.result("    {:<8} {} ({} to {}; default {})\n", option.key, option.description, option.lowest,
                     option.highest, option.default_value);
    report.push_back(presplit_json(presplit));
  }
  return session.finish(report);
}

}  // namespace

void add_presplits_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App& command = *program.add_subcommand("presplits", "List the pre-splits");
  options->add_to(command);
  command.footer(
      "\nExamples:\n  boxwood presplits\n"
      "  boxwood build scene:atrium,rotate=30:40:20 --builder sweep-sah --presplit evh:t=14");
  command.callback([options, &run] { run = [options] { return run_presplits(*options); }; });
}

}  // namespace boxwood::program
