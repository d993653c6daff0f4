// boxwood info: what a mesh looks like before anything is built over it.
#include "boxwood/mesh.h"
#include "commands.h"
#include "input.h"
#include "progress.h"
#include "session.h"
#include "text.h"

namespace boxwood::program {
namespace {

struct InfoOptions {
  CommonOptions common;
  InputOptions input_options;
  std::string input;
};

Json vector_json(Vec3 v) {
  return {v.x, v.y, v.z};
}

Json info_json(const Session& session, const Input& input, const mesh::Report& mesh) {
  Json report = session.report({});
  report["mesh"] = input.json();
  report["vertices"] = mesh.vertices;
  report["triangles"] = mesh.triangles;
  report["bounds"] = mesh.bounds.is_empty()
                         ? Json()
                         : Json{{"lower", vector_json(mesh.bounds.lower)}, {"upper", vector_json(mesh.bounds.upper)}};
  report["surface_area"] = mesh.surface_area;
  report["non_finite"] = mesh.non_finite;
  report["degenerate"] = mesh.degenerate;
  report["duplicate"] = mesh.duplicate;
  report["components"] = mesh.components;
  report["boundary_edges"] = mesh.boundary_edges;
  report["non_manifold_edges"] = mesh.non_manifold_edges;
  report["closed"] = mesh.closed;
  report["manifold"] = mesh.manifold;
  report["keeps_file_order"] = input.keeps_file_order;
  report["order_note"] = input.order_note;
  report["polygons_triangulated"] = input.polygons_triangulated;
  report["lines_and_points_skipped"] = input.lines_and_points_skipped;
  report["hash"] = hash_text(input.hash);
  report["read_ms"] = 1e3 * input.read_seconds;
  return report;
}

void print_info(const Session& session, const Input& input, const mesh::Report& mesh) {
  const auto line = [&](const char* key, const std::string& value) { session.result("  {:<20} {}\n", key, value); };
  session.result("{}\n", input.mesh.name);
  line("triangles", with_thousands(mesh.triangles));
  line("vertices", with_thousands(mesh.vertices));
  if (mesh.bounds.is_empty()) {
    line("bounds", "none: no usable triangle");
  } else {
    line("bounds, lower", vector_text(mesh.bounds.lower));
    line("bounds, upper", vector_text(mesh.bounds.upper));
    line("extent", vector_text(mesh.bounds.extent()));
  }
  line("surface area", fmt::format("{:.6g}", mesh.surface_area));
  line("non-finite", with_thousands(mesh.non_finite));
  line("degenerate", with_thousands(mesh.degenerate));
  line("duplicate", with_thousands(mesh.duplicate));
  line("components", with_thousands(mesh.components));
  line("closed", mesh.closed ? "yes" : fmt::format("no, {} boundary edges", with_thousands(mesh.boundary_edges)));
  line("manifold",
       mesh.manifold ? "yes"
                     : fmt::format("no, {} edges on more than two triangles", with_thousands(mesh.non_manifold_edges)));
  if (!input.is_scene) {
    line("file order", input.keeps_file_order ? "kept" : one_line(input.order_note));
    if (input.polygons_triangulated) line("polygons cut", with_thousands(input.polygons_triangulated));
    if (input.lines_and_points_skipped)
      line("lines and points", with_thousands(input.lines_and_points_skipped) + " skipped");
  }
  line("hash", hash_text(input.hash));
  line(input.is_scene ? "made in" : "read in", fmt::format("{:.1f} ms", 1e3 * input.read_seconds));
}

Status run_info(const InfoOptions& options) {
  const Session session("info", options.common);
  const auto input = load_input(options.input, options.input_options, session);
  if (!input) return input.error();
  const mesh::Report report = [&] {
    const Progress progress("inspecting " + input->mesh.name, session.shows_progress());
    return mesh::inspect(input->mesh, *session.executor());
  }();
  session.note("{}\n", session.environment_line({}));
  print_info(session, *input, report);
  warn_excluded(*input, report.non_finite, session);
  return session.finish(info_json(session, *input, report));
}

}  // namespace

void add_info_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App& command = *program.add_subcommand("info", "Count, measure and check a mesh");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  options->common.add_to(command);
  command.footer("\nExamples:\n  boxwood info bunny.ply\n  boxwood info scene:shells,triangles=5000 --json -");
  command.callback([options, &run] { run = [options] { return run_info(*options); }; });
}

}  // namespace boxwood::program
