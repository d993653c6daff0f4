// The text at the front of a PLY file: which elements follow, with which properties.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/base.h"
#include "io/file_reader.h"

namespace boxwood::io {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);
inline bool is_integer(PlyType type) {
  return type < PlyType::float32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  ///< of the value, or of each item of a list
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< lists only
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  const PlyProperty* find(std::string_view property) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;

  const PlyElement* find(std::string_view element) const;
};

/// True when the first bytes are those of a PLY file.
bool begins_like_ply(std::string_view bytes);

/// Reads up to and including the end_header line. Lines may end in LF, CR LF or CR, the first one decides.
Result<PlyHeader> read_ply_header(FileReader& file, const std::filesystem::path& path);

}  // namespace boxwood::io
