// The front of NumPy's .npy files: what one array consists of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "boxwood/base.h"
#include "io/file_reader.h"

namespace boxwood::io {

struct NpyHeader {
  std::string type;  ///< as it stands in the file, "<f4"; a structured type in full
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;

  std::string shape_text() const;  ///< "(100, 6)", as NumPy prints it
};

/// Reads up to the first byte of data. Format versions 1.0, 2.0 and 3.0.
Result<NpyHeader> read_npy_header(FileReader& file, const std::filesystem::path& path);

/// A header of version 1.0, padded to a multiple of 64 bytes. `type` is written as it is, quotes included.
std::string make_npy_header(const std::string& type, const std::vector<std::uint64_t>& shape);

}  // namespace boxwood::io
