// The options --camera eye=x:y:z,look_at=x:y:z,up=x:y:z,fov=degrees and --size WIDTHxHEIGHT.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "boxwood/base.h"
#include "boxwood/math.h"

namespace boxwood::program {

/// What was given; what was not is taken from the view the input has anyway.
struct Camera {
  std::optional<Vec3> eye, look_at, up;
  std::optional<float> fov;

  View over(View view) const;
};

Result<Camera> parse_camera(std::string_view text);
/// A view in the form parse_camera reads, exact to the last bit.
std::string camera_text(const View& view);

/// Both refuse what they can't read as wrong usage, before anything runs.
/// `or_file`: the name of a camera file (camera_file.h) will do as well; is_camera_file tells them apart.
void add_camera_option(CLI::App& command, std::string& camera, bool or_file = false);
inline bool is_camera_file(const std::string& camera) {
  return !camera.empty() && camera.find('=') == std::string::npos;
}
void add_size_option(CLI::App& command, std::string& size);

}  // namespace boxwood::program
