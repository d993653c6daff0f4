#include <algorithm>
#include <bit>
#include <cstring>

#include "boxwood/io.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the writers store this machine's bytes as little-endian");

constexpr std::size_t kMostEntries = 0x7fffffff;
constexpr std::size_t kChunkRows = 4096;

// What can be seen without a look at the indices; those are checked while they are written.
Status check(const std::filesystem::path& path, const MeshView& mesh) {
  if (mesh.vertex_count > kMostEntries || mesh.triangle_count > kMostEntries)
    return write_error(ErrorCode::too_large, path, "the mesh has more than 2^31 - 1 vertices or triangles");
  if (mesh.vertex_count && (!mesh.positions || mesh.vertex_stride < 12))
    return write_error(ErrorCode::invalid_argument, path,
                       mesh.positions ? "the vertex stride is " + std::to_string(mesh.vertex_stride) + ", less than 12"
                                      : "the mesh has no positions");
  if (mesh.indices && mesh.triangle_count && mesh.triangle_stride < 12)
    return write_error(ErrorCode::invalid_argument, path,
                       "the triangle stride is " + std::to_string(mesh.triangle_stride) + ", less than 12");
  return {};
}

std::string header_of(const MeshView& mesh) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertex_count) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(mesh.triangle_count) +
         "\nproperty list uchar uint vertex_indices\nend_header\n";
}

Status write_vertices(const MeshView& mesh, const Sink& sink) {
  std::vector<Vec3> chunk;
  for (std::size_t begin = 0; begin < mesh.vertex_count; begin += kChunkRows) {
    chunk.clear();
    for (std::size_t i = begin; i < std::min(begin + kChunkRows, mesh.vertex_count); ++i)
      chunk.push_back(mesh.vertex(i));
    if (Status status = sink(chunk.data(), chunk.size() * sizeof(Vec3)); !status) return status;
  }
  return {};
}

Status write_triangles(const std::filesystem::path& path, const MeshView& mesh, const Sink& sink) {
  constexpr std::size_t kRow = 1 + 3 * sizeof(std::uint32_t);
  std::vector<char> chunk;
  for (std::size_t begin = 0; begin < mesh.triangle_count; begin += kChunkRows) {
    const std::size_t end = std::min(begin + kChunkRows, mesh.triangle_count);
    chunk.resize((end - begin) * kRow);
    for (std::size_t i = begin; i < end; ++i) {
      const auto corners = mesh.corners(i);
      for (const std::uint32_t corner : corners)
        if (corner >= mesh.vertex_count)
          return write_error(ErrorCode::malformed, path,
                             "triangle " + std::to_string(i) + " refers to vertex " + std::to_string(corner) +
                                 ", there are " + std::to_string(mesh.vertex_count) + " (counted from 0)");
      char* row = chunk.data() + (i - begin) * kRow;
      *row = 3;
      std::memcpy(row + 1, corners.data(), kRow - 1);
    }
    if (Status status = sink(chunk.data(), chunk.size()); !status) return status;
  }
  return {};
}

}  // namespace

Status write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  return guard_memory("write", path, [&]() -> Status {
    if (Status status = check(path, mesh); !status) return status;
    return write_file(path, [&](const Sink& sink) -> Status {
      const std::string header = header_of(mesh);
      if (Status status = sink(header.data(), header.size()); !status) return status;
      if (Status status = write_vertices(mesh, sink); !status) return status;
      return write_triangles(path, mesh, sink);
    });
  });
}

}  // namespace boxwood::io
