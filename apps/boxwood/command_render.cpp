// boxwood render: a picture of a mesh, or of the work its rays cost.
#include "boxwood/io.h"
#include "boxwood/render.h"
#include "camera.h"
#include "commands.h"
#include "input.h"
#include "pipeline.h"
#include "progress.h"
#include "session.h"
#include "text.h"

namespace boxwood::program {
namespace {

struct Options {
  CommonOptions common;
  PipelineOptions pipeline;
  InputOptions input_options;
  std::string input, output, camera;
  std::string size = "1024x1024";
  std::string shade = "normals";
};

Status run_render(const Options& options) {
  const Session session("render", options.common);
  const auto shade = render::find_shade(options.shade);
  if (!shade) return shade.error();
  const auto size = parse_size(options.size);
  if (!size) return size.error();
  const int width = size->first, height = size->second;
  for (const std::string& path : {options.output, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  const auto input = load_usable_input(options.input, options.input_options, session);
  if (!input) return input.error();
  View view = input->view;
  if (!options.camera.empty()) {
    const auto camera = parse_camera(options.camera);
    if (!camera) return camera.error();
    view = camera->over(view);
  }
  std::vector<std::uint8_t> split;
  const auto pipeline =
      run_pipeline(*input, options.pipeline, session, *shade == render::Shade::subdivided ? &split : nullptr);
  if (!pipeline) return pipeline.error();

  const double start = now();
  auto image = [&] {
    const Progress progress(fmt::format("rendering {}x{}", width, height), session.shows_progress());
    return render::render(pipeline->accel, input->turned(view), width, height, *shade, split);
  }();
  if (!image) return image.error();
  const double seconds = now() - start;
  if (Status status = io::write_png(options.output, *image); !status) return status;

  const std::size_t rays = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const double mrays = 1e-6 * static_cast<double>(rays) / seconds;
  session.note("camera: --camera {}\n", camera_text(view));
  session.result("{}: {}x{} {}, {} primary rays in {:.1f} ms ({:.2f} Mrays/s, shading included)\n", options.output,
                 width, height, options.shade, with_thousands(rays), 1e3 * seconds, mrays);
  Json report = session.report(pipeline->accel.isa());
  report["mesh"] = input->json();
  report["options"] = options_json(pipeline->echo);
  report["options"]["shade"] = options.shade;
  report["options"]["size"] = options.size;
  report["camera"] = camera_text(view);
  report["excluded"] = pipeline->excluded;
  report["references"] = pipeline->accel.reference_count();
  report["build_ms"] = 1e3 * pipeline->build_seconds;
  report["primary_rays"] = rays;
  report["render_ms"] = 1e3 * seconds;
  report["mrays"] = mrays;
  report["output"] = options.output;
  return session.finish(report);
}

}  // namespace

void add_render_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<Options>();
  CLI::App& command = *program.add_subcommand("render", "Draw a mesh, or a heat map of what its rays cost, as PNG");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  command.add_option("-o,--output", options->output, "Picture to write")->type_name("OUT.png")->required();
  command.add_option("--shade", options->shade, "normals, ao, depth, nodes, primitives, ids or subdivided")
      ->type_name("NAME")
      ->capture_default_str();
  add_size_option(command, options->size);
  add_camera_option(command, options->camera);
  options->pipeline.add_to(command);
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood render bunny.ply -o bunny.png --shade ao\n"
      "  boxwood render scene:atrium -o visits.png --shade nodes --size 1280x720 --builder lbvh\n"
      "  boxwood render scene:spaceship -o split.png --shade subdivided --presplit evh:t=14\n"
      "  boxwood render bunny.ply -o left.png --camera eye=-1:0.2:0,look_at=0:0.1:0,fov=30");
  command.callback([options, &run] { run = [options] { return run_render(*options); }; });
}

}  // namespace boxwood::program
