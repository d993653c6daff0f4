// Our own reader of PLY files.
#pragma once

#include "boxwood/io.h"
#include "io/file_reader.h"

namespace boxwood::io {

/// Reads a PLY file that was just opened. Memory: the mesh and a buffer of constant size. May throw std::bad_alloc.
Result<LoadedMesh> read_ply(FileReader& file, const std::filesystem::path& path);

}  // namespace boxwood::io
