// What a glTF 2.0 file's own description says about its triangles. Read before assimp gets the file, because assimp
// drops triangles with wrong indices without a word, and a deep or endless tree of nodes overflows its stack.
#pragma once

#include <filesystem>
#include <optional>

#include "boxwood/base.h"
#include "io/file_reader.h"

namespace boxwood::io {

struct GltfOutline {
  std::uint64_t triangles = 0;   ///< in the default scene, each use of a mesh counted
  bool keeps_file_order = true;  ///< the nodes, depth first, use the meshes in the file's order and none twice
};

/// Reads .gltf and .glb. Nothing when the file is neither (or of glTF 1, which has no such description).
Result<std::optional<GltfOutline>> read_gltf_outline(FileReader& file, const std::filesystem::path& path);

}  // namespace boxwood::io
