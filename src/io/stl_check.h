// Checks of an STL file before assimp gets it, for clear sentences on truncated ones.
#pragma once

#include <filesystem>

#include "boxwood/base.h"
#include "io/file_reader.h"

namespace boxwood::io {

Status check_stl(FileReader& file, const std::filesystem::path& path);

}  // namespace boxwood::io
