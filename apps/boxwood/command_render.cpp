// boxwood render: a picture of a mesh, or of the work its rays cost.
#include <optional>

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

struct RenderOptions {
  CommonOptions common;
  PipelineOptions pipeline;
  InputOptions input_options;
  std::string input, output, camera;
  std::string size = "1024x1024";
  std::string shade = "normals";
  std::optional<std::uint32_t> rounds, node;
};

/// The numbers of shade `children`: bit 0 for what is below the node's first child, bit 1 for the second.
Result<std::vector<std::uint32_t>> numbers_of_children(const tree::BinaryTree& tree, std::uint32_t node) {
  if (node >= tree.nodes.size())
    return {ErrorCode::out_of_range, fmt::format("there is no node {}; the tree has {}", node, tree.nodes.size())};
  if (tree.nodes[node].is_leaf())
    return {ErrorCode::invalid_argument, fmt::format("node {} is a leaf and has no children to show", node)};
  // A subtree's references are one range, from its leftmost leaf to its rightmost.
  const auto edge = [&](std::uint32_t at, std::uint32_t side) {
    while (!tree.nodes[at].is_leaf()) at = tree.nodes[at].first + side;
    return tree.nodes[at];
  };
  std::vector<std::uint32_t> numbers(tree.primitive_count);
  for (const std::uint32_t side : {0u, 1u}) {
    const std::uint32_t child = tree.nodes[node].first + side;
    const tree::Node last = edge(child, 1);
    for (std::uint32_t i = edge(child, 0).first; i < last.first + last.count; ++i)
      numbers[tree.references[i]] |= 1u << side;
  }
  return numbers;
}

/// What the shade shows of each triangle besides its hits.
Result<std::vector<std::uint32_t>> numbers_of(const RenderOptions& options, render::Shade shade, const Input& input,
                                              const Pipeline& pipeline, std::vector<std::uint32_t>&& split,
                                              const Session& session) {
  if (shade == render::Shade::children) return numbers_of_children(pipeline.tree, options.node.value_or(0));
  if (shade != render::Shade::clusters) return std::move(split);
  const auto references = refs::make_references(input.mesh, *session.executor());
  if (!references) return references.error();
  return builders::edge_clusters(*references, options.rounds.value_or(1), mesh::Weld::position, {*session.executor()});
}

Status run_render(const RenderOptions& options) {
  const Session session("render", options.common);
  const auto shade = render::find_shade(options.shade);
  if (!shade) return shade.error();
  if (options.rounds && *shade != render::Shade::clusters)
    return {ErrorCode::invalid_argument, "--rounds is for --shade clusters only"};
  if (options.node && *shade != render::Shade::children)
    return {ErrorCode::invalid_argument, "--node is for --shade children only"};
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
  std::vector<std::uint32_t> split;
  const auto pipeline =
      run_pipeline(*input, options.pipeline, session, *shade == render::Shade::subdivided ? &split : nullptr);
  if (!pipeline) return pipeline.error();

  const auto numbers = numbers_of(options, *shade, *input, *pipeline, std::move(split), session);
  if (!numbers) return numbers.error();
  const double start = now();
  auto image = [&] {
    const Progress progress(fmt::format("rendering {}x{}", width, height), session.shows_progress());
    return render::render(pipeline->accel, input->turned(view), width, height, *shade, *numbers);
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
  if (*shade == render::Shade::clusters) report["options"]["rounds"] = options.rounds.value_or(1);
  if (*shade == render::Shade::children) report["options"]["node"] = options.node.value_or(0);
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
  auto options = std::make_shared<RenderOptions>();
  CLI::App& command = *program.add_subcommand("render", "Draw a mesh, or a heat map of what its rays cost, as PNG");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  command.add_option("-o,--output", options->output, "Picture to write")->type_name("OUT.png")->required();
  command
      .add_option("--shade", options->shade,
                  "normals, ao, depth, nodes, primitives, ids, subdivided, clusters or children")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--rounds", options->rounds,
                  "Rounds of merging triangles over shared edges, for --shade clusters (default 1)")
      ->type_name("K");
  command
      .add_option("--node", options->node,
                  "Node of the binary tree, numbered depth first, for --shade children (default 0, the root)")
      ->type_name("N");
  add_size_option(command, options->size);
  add_camera_option(command, options->camera);
  options->pipeline.add_to(command);
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood render bunny.ply -o bunny.png --shade ao\n"
      "  boxwood render scene:atrium -o visits.png --shade nodes --size 1280x720 --builder lbvh\n"
      "  boxwood render scene:spaceship -o split.png --shade subdivided --presplit evh:t=14\n"
      "  boxwood render bunny.ply -o clusters.png --shade clusters --rounds 4\n"
      "  boxwood render bunny.ply -o halves.png --shade children --node 0 --builder geometric\n"
      "  boxwood render bunny.ply -o left.png --camera eye=-1:0.2:0,look_at=0:0.1:0,fov=30");
  command.callback([options, &run] { run = [options] { return run_render(*options); }; });
}

}  // namespace boxwood::program
