#include "input.h"

#include "boxwood/io.h"
#include "progress.h"
#include "text.h"

namespace boxwood::program {
namespace {

constexpr std::string_view kScenePrefix = "scene:";

Result<mesh::SceneOptions> parse_scene_options(const std::vector<std::string>& parts) {
  auto settings = parse_settings({parts.begin() + 1, parts.end()});
  if (!settings) return settings.error();
  mesh::SceneOptions options;
  for (const auto& [key, value] : *settings) {
    if (key == "triangles") {
      auto triangles = parse_integer(value, key);
      if (!triangles) return triangles.error();
      // Zero would mean the default to the library; typed out it is a mistake.
      if (*triangles == 0) return {ErrorCode::out_of_range, "triangles must be from 12 to 20000000, not 0"};
      options.triangles = *triangles;
    } else if (key == "seed") {
      auto seed = parse_integer(value, key);
      if (!seed) return seed.error();
      options.seed = *seed;
    } else if (key == "rotate") {
      auto rotate = parse_vector(value, key);
      if (!rotate) return rotate.error();
      options.rotate = *rotate;
    } else if (key == "outlier" || key == "spike") {
      auto distance = parse_number(value, key);
      if (!distance) return distance.error();
      (key == "outlier" ? options.outlier : options.spike) = *distance;
    } else {
      return {ErrorCode::unknown_name,
              fmt::format("a scene has no option '{}'; it has triangles, seed, rotate, outlier and spike", key)};
    }
  }
  return options;
}

Status make_scene(Input& input) {
  const std::vector<std::string> parts = split(std::string_view(input.text).substr(kScenePrefix.size()), ',');
  auto options = parse_scene_options(parts);
  if (!options) return Error{options.error().code, fmt::format("{}: {}", input.text, options.error().message)};
  auto scene = mesh::make_scene(parts[0], *options);
  if (!scene) return scene.error();
  input.mesh = std::move(scene->mesh);
  input.view = scene->view;
  input.scene = *options;
  input.is_scene = true;
  return {};
}

Status read_file(Input& input, const Session& session) {
  auto loaded = io::read_mesh(input.text);
  if (!loaded) return loaded.error();
  input.mesh = std::move(loaded->mesh);
  input.keeps_file_order = loaded->keeps_file_order;
  input.order_note = loaded->order_note;
  input.polygons_triangulated = loaded->polygons_triangulated;
  input.lines_and_points_skipped = loaded->lines_and_points_skipped;
  if (!input.keeps_file_order) session.note("{}: {}\n", input.mesh.name, one_line(input.order_note));
  return {};
}

}  // namespace

Json Input::json() const {
  Json json;
  json["name"] = mesh.name;
  json["input"] = text;
  json["triangles"] = mesh.triangles.size();
  json["vertices"] = mesh.vertices.size();
  json["hash"] = hash_text(hash);
  if (is_scene) {
    json["seed"] = scene.seed;
    json["rotate"] = {scene.rotate.x, scene.rotate.y, scene.rotate.z};
    if (scene.outlier > 0) json["outlier"] = scene.outlier;
    if (scene.spike > 0) json["spike"] = scene.spike;
  } else {
    json["keeps_file_order"] = keeps_file_order;
  }
  if (rotation != Vec3{}) json["turned"] = {rotation.x, rotation.y, rotation.z};
  return json;
}

std::string Input::line() const {
  const std::string seed = is_scene ? fmt::format(", seed {}", scene.seed) : "";
  const std::string turn = rotation == Vec3{} ? "" : fmt::format(", turned by {}", vector_text(rotation));
  return fmt::format("{}: {} triangles, {} vertices{}{}, hash {}", mesh.name, with_thousands(mesh.triangles.size()),
                     with_thousands(mesh.vertices.size()), seed, turn, hash_text(hash));
}

void InputOptions::add_to(CLI::App& command) {
  command.add_option("--rotate", rotate, "Turn INPUT, and the camera with it, by degrees about x, then y, then z")
      ->type_name("X:Y:Z")
      ->check([](const std::string& text) {
        const auto parsed = parse_vector(text, "the rotation");
        return parsed ? std::string() : parsed.error().message;
      });
}

Result<Input> load_input(const std::string& text, const InputOptions& options, const Session& session) {
  Input input;
  input.text = text;
  const Progress progress("reading " + text, session.shows_progress());
  const double start = now();
  const Status status = text.starts_with(kScenePrefix) ? make_scene(input) : read_file(input, session);
  if (!status) return status.error();
  input.read_seconds = now() - start;
  if (input.mesh.triangles.empty()) return {ErrorCode::malformed, text + " has no triangles"};
  Executor& executor = *session.executor();
  if (const Status checked = mesh::check_indices(input.mesh, executor); !checked)
    return Error{checked.error().code, text + ": " + checked.error().message};
  input.bounds = mesh::bounds(input.mesh, executor);
  if (!input.is_scene && !input.bounds.is_empty()) input.view = mesh::view_from_bounds(input.bounds);
  if (!options.rotate.empty() && !input.bounds.is_empty()) {
    const auto rotation = parse_vector(options.rotate, "the rotation");
    if (!rotation) return rotation.error();
    input.rotation = *rotation;
    input.rotation_center = input.bounds.center();
    mesh::rotate(input.mesh, input.rotation, input.rotation_center);
    input.bounds = mesh::bounds(input.mesh, executor);
  }
  input.hash = mesh::hash(input.mesh, executor);
  return input;
}

Result<Input> load_usable_input(const std::string& text, const InputOptions& options, const Session& session) {
  auto input = load_input(text, options, session);
  if (input && input->bounds.is_empty())
    return {ErrorCode::malformed, fmt::format("{} has no usable triangle: all {} reach a coordinate that is NaN, "
                                              "infinite or beyond {}",
                                              text, with_thousands(input->mesh.triangles.size()), kLargestCoordinate)};
  return input;
}

void warn_excluded(const Input& input, std::size_t excluded, const Session& session) {
  if (excluded == 0) return;
  session.warn(fmt::format("{}: {} of {} triangles {} not finite (NaN, infinite or beyond {}) and left out of the tree",
                           input.mesh.name, with_thousands(excluded), with_thousands(input.mesh.triangles.size()),
                           excluded == 1 ? "is" : "are", kLargestCoordinate));
}

}  // namespace boxwood::program
