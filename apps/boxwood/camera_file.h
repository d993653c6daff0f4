// Cameras by mesh name, from a JSON file: {"bunny": {"eye": [x, y, z], "look_at": [...], "up": [...], "fov": 40}}.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "input.h"

namespace boxwood::program {

void add_cameras_option(CLI::App& command, std::string& path);

/// Gives the input the file's camera of its name (without its ending). A mesh that the file does not name keeps the
/// view from its bounds, which is warned about; a procedural scene keeps its own. Nothing happens for an empty path.
Status apply_camera_file(const std::string& path, Input& input, const Session& session);

}  // namespace boxwood::program
