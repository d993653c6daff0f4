// Files: meshes in, pictures out, NumPy arrays both ways. Link boxwood::io for this header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/mesh.h"

namespace boxwood::io {

/// A mesh from a file, with what a careful user would want to know of the reading.
struct LoadedMesh {
  TriangleMesh mesh;
  bool keeps_file_order = true;           ///< primitive ids follow the order of triangles in the file
  std::string order_note;                 ///< why not, one sentence, when keeps_file_order is false
  std::size_t polygons_triangulated = 0;  ///< faces of more than three corners that were cut into fans
  std::size_t lines_and_points_skipped = 0;
};

/// Reads PLY (ASCII and binary, both byte orders), OBJ, STL, glTF/GLB and whatever else assimp reads, by the file's
/// content or ending. All nodes of a scene with their transforms; polygons triangulated; units untouched. Errors name
/// the file and the reason: missing, unreadable, truncated, no triangles, index out of range, unknown format.
Result<LoadedMesh> read_mesh(const std::filesystem::path& path);

/// Writes binary little-endian PLY. Through a temporary name, like every writer here.
Status write_ply(const std::filesystem::path& path, const MeshView& mesh);

/// Writes through a temporary file in the same folder and renames it into place, so that the old content stays until
/// the new one is complete. `write` gets the bytes in one or more calls to the sink it is handed.
using Sink = std::function<Status(const void* data, std::size_t size)>;
Status write_file(const std::filesystem::path& path, const std::function<Status(const Sink&)>& write);
Status write_file(const std::filesystem::path& path, std::string_view content);

/// 8-bit RGB PNG.
Status write_png(const std::filesystem::path& path, const Image& image);

/// Rays from a NumPy file: float32 (little-endian, C order), shape (N, 6) `ox oy oz dx dy dz` or (N, 8) with
/// `tmin tmax` behind; float64 is converted. Errors name the file and what was found. Values are not judged here.
Result<std::vector<Ray>> read_rays(const std::filesystem::path& path);

/// Closest hits as a structured array (N,): t f4 (inf on a miss), u f4, v f4, primitive u4 (4294967295 on a miss).
/// `records` are 16 bytes each in that order.
struct HitRecord {
  float t, u, v;
  std::uint32_t primitive;
};
static_assert(sizeof(HitRecord) == 16);
Status write_hits(const std::filesystem::path& path, std::span<const HitRecord> records);
/// Any-hit answers as a NumPy bool array (N,), one byte (0 or 1) each.
Status write_occlusion(const std::filesystem::path& path, std::span<const std::uint8_t> occluded);
/// Rays as float32 (N, 8), the form read_rays takes.
Status write_rays(const std::filesystem::path& path, std::span<const Ray> rays);

}  // namespace boxwood::io
