// Whether assimp keeps the order of an OBJ file's triangles.
#pragma once

#include <string>

#include "io/file_reader.h"

namespace boxwood::io {

/// One sentence on why the order may be lost, or nothing. assimp collects what belongs to one object: a file that
/// comes back to an earlier object has its triangles moved there.
std::string obj_order_note(FileReader& file);

}  // namespace boxwood::io
