// boxwood subdivide: the mesh itself cut where the Edge Volume Heuristic would cut references, for other ray tracers.
#include "boxwood/io.h"
#include "boxwood/refs.h"
#include "commands.h"
#include "input.h"
#include "pipeline.h"
#include "progress.h"
#include "session.h"
#include "text.h"

namespace boxwood::program {
namespace {

struct SubdivideOptions {
  CommonOptions common;
  InputOptions input_options;
  std::string input, output;
  std::string presplit = "evh";
};

Json subdivide_json(const Session& session, const Input& input, const SubdivideOptions& options,
                    const refs::Presplit& presplit, const refs::Subdivision& subdivision, double seconds) {
  Json report = session.report({});
  report["mesh"] = input.json();
  report["options"] = {{"presplit", presplit.text()}};
  report["triangles_before"] = input.mesh.triangles.size();
  report["triangles_after"] = subdivision.mesh.triangles.size();
  report["triangles_cut"] = subdivision.split;
  report["excluded"] = subdivision.left_out;
  report["vertices_before"] = input.mesh.vertices.size();
  report["vertices_after"] = subdivision.mesh.vertices.size();
  report["open_edges_before"] = subdivision.open_edges_before;
  report["open_edges_expected"] = subdivision.open_edges_expected;
  report["open_edges_after"] = subdivision.open_edges_after;
  report["watertightness_kept"] = subdivision.open_edges_after <= subdivision.open_edges_expected;
  report["subdivide_ms"] = 1e3 * seconds;
  report["output"] = options.output;
  return report;
}

void print_subdivision(const Session& session, const Input& input, const SubdivideOptions& options,
                       const refs::Subdivision& subdivision) {
  const auto line = [&](const char* key, const std::string& value) { session.result("  {:<12} {}\n", key, value); };
  session.result("{} written\n", options.output);
  line("triangles", fmt::format("{} to {}; {} were cut", with_thousands(input.mesh.triangles.size()),
                                with_thousands(subdivision.mesh.triangles.size()), with_thousands(subdivision.split)));
  line("vertices", fmt::format("{} to {}", with_thousands(input.mesh.vertices.size()),
                               with_thousands(subdivision.mesh.vertices.size())));
  line("open edges",
       fmt::format("{}, cut into {}; found {}", with_thousands(subdivision.open_edges_before),
                   with_thousands(subdivision.open_edges_expected), with_thousands(subdivision.open_edges_after)));
}

Status run_subdivide(const SubdivideOptions& options) {
  const Session session("subdivide", options.common);
  const auto presplit = refs::parse_presplit(options.presplit);
  if (!presplit) return presplit.error();
  for (const std::string& path : {options.output, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  const auto input = load_usable_input(options.input, options.input_options, session);
  if (!input) return input.error();
  const double start = now();
  const auto subdivision = [&] {
    const Progress progress("subdividing " + input->mesh.name, session.shows_progress());
    return refs::subdivide(input->mesh, *presplit, *session.executor());
  }();
  if (!subdivision) return subdivision.error();
  const double seconds = now() - start;
  if (Status status = io::write_ply(options.output, subdivision->mesh); !status) return status;
  session.note("{}\n{}\npresplit={}\n", session.environment_line({}), input->line(), presplit->text());
  print_subdivision(session, *input, options, *subdivision);
  warn_excluded(*input, subdivision->left_out, session);
  if (Status status = session.finish(subdivide_json(session, *input, options, *presplit, *subdivision, seconds));
      !status)
    return status;
  if (subdivision->open_edges_after > subdivision->open_edges_expected)
    return {ErrorCode::malformed,
            fmt::format("{} edges are open where {} pieces of open edges were expected: the subdivision leaks",
                        subdivision->open_edges_after, subdivision->open_edges_expected)};
  return {};
}

}  // namespace

void add_subdivide_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<SubdivideOptions>();
  CLI::App& command = *program.add_subcommand("subdivide", "Cut a mesh's triangles as the edge volume heuristic does");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  command.add_option("-o,--output", options->output, "Mesh to write, binary PLY")->type_name("OUT.ply")->required();
  add_presplit_option(command, options->presplit);
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood subdivide sponza.ply -o subdivided.ply\n"
      "  boxwood subdivide scene:spaceship -o ship.ply --presplit evh:t=16\n\n"
      "Closed meshes stay closed: triangles that share an edge are cut at the same points of it.");
  command.callback([options, &run] { run = [options] { return run_subdivide(*options); }; });
}

}  // namespace boxwood::program
