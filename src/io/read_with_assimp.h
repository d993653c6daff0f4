// Every mesh format but PLY, through the library assimp.
#pragma once

#include "boxwood/io.h"
#include "io/file_reader.h"

namespace boxwood::io {

/// Reads the file at `path`; `file` is the same, just opened, for the checks before assimp may have it. May throw
/// std::bad_alloc.
Result<LoadedMesh> read_with_assimp(FileReader& file, const std::filesystem::path& path);

}  // namespace boxwood::io
