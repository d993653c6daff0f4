#include "camera_file.h"

#include <algorithm>
#include <fstream>

namespace boxwood::program {
namespace {

Result<Vec3> vector_of(const Json& json, const char* key, const std::string& where) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->size() != 3 ||
      !std::all_of(found->begin(), found->end(), [](const Json& v) { return v.is_number(); }))
    return {ErrorCode::malformed, fmt::format("{}: '{}' must be an array of three numbers", where, key)};
  return Vec3{(*found)[0].get<float>(), (*found)[1].get<float>(), (*found)[2].get<float>()};
}

}  // namespace

void add_cameras_option(CLI::App& command, std::string& path) {
  command
      .add_option("--cameras", path,
                  "JSON file with a camera by mesh name: {\"bunny\": {\"eye\": [x,y,z], \"look_at\": ..., \"up\": ..., "
                  "\"fov\": 40}}")
      ->type_name("FILE");
}

Status apply_camera_file(const std::string& path, Input& input, const Session& session) {
  if (path.empty()) return {};
  std::ifstream file(path);
  if (!file) return {ErrorCode::not_found, fmt::format("the camera file '{}' can't be read", path)};
  const Json cameras = Json::parse(file, nullptr, false);
  if (!cameras.is_object())
    return {ErrorCode::malformed, fmt::format("the camera file '{}' is not a JSON object", path)};
  const std::string stem = input.mesh.name.substr(0, input.mesh.name.rfind('.'));
  const auto camera = cameras.find(stem);
  if (camera == cameras.end()) {
    if (!input.is_scene)
      session.warn(fmt::format("{} has no camera '{}'; the view is computed from the bounds", path, stem));
    return {};
  }
  const std::string where = fmt::format("{}, camera '{}'", path, stem);
  for (const auto& [key, member] : {std::pair{"eye", &View::eye}, {"look_at", &View::look_at}, {"up", &View::up}}) {
    const auto value = vector_of(*camera, key, where);
    if (!value) return value.error();
    input.view.*member = *value;
  }
  const auto fov = camera->find("fov");
  if (fov == camera->end()) return {};
  if (!fov->is_number() || !(fov->get<float>() > 0 && fov->get<float>() < 180))
    return {ErrorCode::out_of_range, fmt::format("{}: 'fov' must be between 0 and 180 degrees", where)};
  input.view.fov = fov->get<float>();
  return {};
}

}  // namespace boxwood::program
