// The ending of a file's name, for choosing a reader.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace boxwood::io {

/// ".ply" for "Chair.PLY"; empty without an ending.
inline std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace boxwood::io
