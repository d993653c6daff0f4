#include "camera.h"

#include <fmt/format.h>

#include "text.h"

namespace boxwood::program {

View Camera::over(View view) const {
  view.eye = eye.value_or(view.eye);
  view.look_at = look_at.value_or(view.look_at);
  view.up = up.value_or(view.up);
  view.fov = fov.value_or(view.fov);
  return view;
}

Result<Camera> parse_camera(std::string_view text) {
  auto settings = parse_settings(split(text, ','));
  if (!settings) return Error{settings.error().code, "the camera: " + settings.error().message};
  Camera camera;
  for (const auto& [key, value] : *settings) {
    const std::string what = "the camera's " + key;
    if (key == "fov") {
      const Result<float> fov = parse_number(value, what);
      if (!fov) return fov.error();
      if (!(*fov > 0 && *fov < 180))
        return {ErrorCode::out_of_range, fmt::format("{} must be between 0 and 180 degrees, not {}", what, value)};
      camera.fov = *fov;
      continue;
    }
    if (key != "eye" && key != "look_at" && key != "up")
      return {ErrorCode::unknown_name, fmt::format("the camera has no '{}'; it has eye, look_at, up and fov", key)};
    const Result<Vec3> vector = parse_vector(value, what);
    if (!vector) return vector.error();
    (key == "eye" ? camera.eye : key == "look_at" ? camera.look_at : camera.up) = *vector;
  }
  return camera;
}

std::string camera_text(const View& view) {
  return fmt::format("eye={},look_at={},up={},fov={}", vector_text(view.eye), vector_text(view.look_at),
                     vector_text(view.up), view.fov);
}

void add_camera_option(CLI::App& command, std::string& camera, bool or_file) {
  command
      .add_option("--camera", camera,
                  std::string("eye=x:y:z,look_at=x:y:z,up=x:y:z,fov=degrees; what is left out is computed") +
                      (or_file ? ". Or a file as for --cameras" : ""))
      ->type_name("CAMERA")
      ->check([or_file](const std::string& text) {
        if (or_file && is_camera_file(text)) return std::string();
        const auto parsed = parse_camera(text);
        return parsed ? std::string() : parsed.error().message;
      });
}

void add_size_option(CLI::App& command, std::string& size) {
  command.add_option("--size", size, "Pixels")
      ->type_name("WIDTHxHEIGHT")
      ->capture_default_str()
      ->check([](const std::string& text) {
        const auto parsed = parse_size(text);
        return parsed ? std::string() : parsed.error().message;
      });
}

}  // namespace boxwood::program
