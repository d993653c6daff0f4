// Can this view be read, which triangles can be used, and how large is the whole?
#include <algorithm>

#include "boxwood/mesh.h"
#include "mesh/check_arrays.h"
#include "mesh/chunks.h"

namespace boxwood::mesh {
namespace {

constexpr std::size_t kLargestCount = 0x7fffffff;

/// Does the last of `count` elements of 12 bytes, `stride` bytes apart, still lie in the address space?
bool fits_address_space(std::size_t count, std::size_t stride) {
  return count == 0 || count - 1 <= (SIZE_MAX - 12) / stride;
}

Status check_array(const void* data, std::size_t count, std::size_t stride, const char* what) {
  const std::string name = what, names = name == "vertex" ? "vertices" : "triangles";
  if (count > kLargestCount) {
    return {ErrorCode::too_large,
            "mesh has " + std::to_string(count) + " " + names + ", more than the 2147483647 that ids can count"};
  }
  if (stride < 12) {
    return {ErrorCode::invalid_argument, "mesh has a " + name + " stride of " + std::to_string(stride) +
                                             " bytes, but a " + name + " takes 12 bytes"};
  }
  if (!fits_address_space(count, stride)) {
    return {ErrorCode::too_large, "mesh has " + std::to_string(count) + " " + names + " with a stride of " +
                                      std::to_string(stride) + " bytes, more than memory can hold"};
  }
  if (count && !data) {
    return {ErrorCode::invalid_argument,
            "mesh claims " + std::to_string(count) + " " + names + ", but its " + name + " array is null"};
  }
  return {};
}

Status check_corners(const MeshView& mesh, Executor& executor) {
  const std::size_t none = mesh.triangle_count;
  std::vector<std::size_t> first_bad(chunk_count(mesh.triangle_count), none);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto c = mesh.corners(i);
      if (std::max({c[0], c[1], c[2]}) < mesh.vertex_count) continue;
      first_bad[chunk] = i;
      return;
    }
  });
  const auto bad = std::find_if(first_bad.begin(), first_bad.end(), [&](std::size_t i) { return i != none; });
  if (bad == first_bad.end()) return {};
  const auto c = mesh.corners(*bad);
  const auto index = *std::find_if(c.begin(), c.end(), [&](std::uint32_t v) { return v >= mesh.vertex_count; });
  return {ErrorCode::malformed, "triangle " + std::to_string(*bad) + " refers to vertex " + std::to_string(index) +
                                    ", but the mesh has only " + std::to_string(mesh.vertex_count) + " vertices"};
}

}  // namespace

Status check_arrays(const MeshView& mesh) {
  if (Status status = check_array(mesh.positions, mesh.vertex_count, mesh.vertex_stride, "vertex"); !status)
    return status;
  if (mesh.indices) return check_array(mesh.indices, mesh.triangle_count, mesh.triangle_stride, "triangle");
  if (mesh.triangle_count <= mesh.vertex_count / 3) return {};
  return {ErrorCode::malformed, "mesh without indices claims " + std::to_string(mesh.triangle_count) +
                                    " triangles, but its " + std::to_string(mesh.vertex_count) +
                                    " vertices make only " + std::to_string(mesh.vertex_count / 3)};
}

Status check_indices(const MeshView& mesh, Executor& executor) {
  try {
    if (Status status = check_arrays(mesh); !status) return status;
    return mesh.indices ? check_corners(mesh, executor) : Status{};
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "not enough memory to check the mesh"};
  }
}

bool is_usable(const Triangle& triangle) {
  // Written so that a NaN, which fails every comparison, makes it false.
  const auto fits = [](Vec3 p) {
    return std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
           std::fabs(p.z) <= kLargestCoordinate;
  };
  return fits(triangle.v0) && fits(triangle.v1) && fits(triangle.v2);
}

Box bounds(const MeshView& mesh, Executor& executor) {
  std::vector<Box> parts(chunk_count(mesh.triangle_count));
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Box box;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle triangle = mesh.triangle(i);
      if (is_usable(triangle)) box.grow(triangle.bounds());
    }
    parts[chunk] = box;
  });
  Box whole;
  for (const Box& part : parts) whole.grow(part);
  return whole;
}

}  // namespace boxwood::mesh
