// Small glTF and STL files, put together in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "unit/io/io_test_support.h"

namespace boxwood::io::test {

inline std::string base64(const std::string& bytes) {
  const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

/// A glTF 2.0 scene of one buffer: accessor 0 are the indices (16 bits), accessor 1 the positions.
struct GltfScene {
  std::vector<std::uint16_t> indices{0, 1, 2, 0, 1, 3};
  std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::string scene = R"("scenes":[{"nodes":[0]}])";
  std::string nodes = R"([{"mesh":0}])";
  std::string meshes = R"([{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}])";

  std::string buffer() const {
    std::string bytes;
    for (const std::uint16_t index : indices) bytes += bytes_of(index);
    bytes.resize((bytes.size() + 3) / 4 * 4);
    for (const Vec3& p : positions) bytes += bytes_of(p);
    return bytes;
  }

  std::string json(const std::string& uri) const {
    const std::size_t index_bytes = 2 * indices.size(), offset = (index_bytes + 3) / 4 * 4;
    const auto text = [](std::size_t n) { return std::to_string(n); };
    return R"({"asset":{"version":"2.0"},)" + scene + R"(,"nodes":)" + nodes + R"(,"meshes":)" + meshes +
           R"(,"accessors":[{"bufferView":0,"componentType":5123,"type":"SCALAR","count":)" + text(indices.size()) +
           R"(},{"bufferView":1,"componentType":5126,"type":"VEC3","min":[0,0,0],"max":[1,1,1],"count":)" +
           text(positions.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + text(index_bytes) +
           R"(},{"buffer":0,"byteOffset":)" + text(offset) + R"(,"byteLength":)" + text(12 * positions.size()) +
           R"(}],"buffers":[{)" + uri + R"("byteLength":)" + text(buffer().size()) + "}]}";
  }

  std::string gltf() const {
    return json(R"("uri":"data:application/octet-stream;base64,)" + base64(buffer()) + R"(",)");
  }

  std::string glb() const {
    std::string description = json("");
    description.resize((description.size() + 3) / 4 * 4, ' ');
    const std::string data = buffer();
    const auto word = [](std::size_t n) { return bytes_of(static_cast<std::uint32_t>(n)); };
    return "glTF" + word(2) + word(28 + description.size() + data.size()) + word(description.size()) + "JSON" +
           description + word(data.size()) + std::string("BIN\0", 4) + data;
  }
};

inline std::string binary_stl(const std::vector<Corners>& triangles) {
  std::string bytes = std::string(80, ' ') + bytes_of(static_cast<std::uint32_t>(triangles.size()));
  for (const Corners& corners : triangles) bytes += bytes_of(Vec3{}) + bytes_of(corners) + std::string(2, '\0');
  return bytes;
}

}  // namespace boxwood::io::test
