// boxwood scenes: the registry of procedural scenes.
#include "boxwood/mesh.h"
#include "commands.h"
#include "session.h"
#include "text.h"

namespace boxwood::program {
namespace {

Status run_scenes(const CommonOptions& options) {
  const Session session("scenes", options);
  Json report = Json::array();
  std::size_t width = 0;
  for (const auto& scene : mesh::scenes()) width = std::max(width, std::string(scene.id).size());
  for (const auto& scene : mesh::scenes()) {
    session.result("{:<{}}  {} (default: {} triangles)\n", scene.id, width, scene.summary,
                   with_thousands(scene.default_triangles));
    Json json;
    json["id"] = scene.id;
    json["summary"] = scene.summary;
    json["paper"] = scene.paper;
    json["default_triangles"] = scene.default_triangles;
    report.push_back(json);
  }
  return session.finish(report);
}

}  // namespace

void add_scenes_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App& command = *program.add_subcommand("scenes", "List the procedural scenes");
  options->add_to(command);
  command.footer(
      "\nExamples:\n  boxwood scenes\n  boxwood render scene:foliage,triangles=500000,seed=7 -o foliage.png");
  command.callback([options, &run] { run = [options] { return run_scenes(*options); }; });
}

}  // namespace boxwood::program
