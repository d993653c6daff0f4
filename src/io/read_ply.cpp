// PLY (Turk 1994): ASCII and binary in both byte orders, any order and types of properties, extra properties and
// elements skipped. One pass through a constant buffer, O(file size). No number of the header is believed before the
// file has been found large enough for it.
#include "io/read_ply.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/ply_header.h"
#include "io/ply_values.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

constexpr std::uint64_t kMostEntries = 0x7fffffff;  // vertices and triangles, as mesh::check_indices wants
// What is reserved before the first value when a pipe does not tell its length.
constexpr std::uint64_t kReserveUnseen = 1 << 16;

std::string count_of(std::uint64_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

template <class Values>
class BodyReader {
 public:
  BodyReader(FileReader& file, const std::filesystem::path& path, const PlyHeader& header)
      : file_(file), path_(path), header_(header), values_(file) {}

  Result<LoadedMesh> read() {
    if (Status status = check_header(); !status) return status.error();
    for (const PlyElement& element : header_.elements) {
      if (Status status = check_size(element); !status) return status.error();
      Status status = &element == vertices_ ? read_vertices(element)
                      : &element == faces_  ? read_faces(element)
                                            : skip_rows(element);
      if (!status) return status.error();
    }
    if (loaded_.mesh.triangles.empty()) return malformed("it has no triangles");
    return std::move(loaded_);
  }

 private:
  Status check_header() {
    vertices_ = header_.find("vertex");
    faces_ = header_.find("face");
    if (!vertices_) return malformed("it has no vertices");
    if (!faces_ && header_.find("tristrips"))
      return Error(
          read_error(ErrorCode::unsupported, path_, "its triangles are strips, which this reader does not know"));
    if (!faces_) return malformed("it has no triangles, only " + count_of(vertices_->count, "point"));
    for (const PlyElement* element : {vertices_, faces_})
      if (element->count > kMostEntries)
        return Error(read_error(ErrorCode::too_large, path_,
                                "it announces " + std::to_string(element->count) +
                                    (element == faces_ ? " faces" : " vertices") + ", more than 2^31 - 1"));
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, static_cast<char>('x' + axis));
      axes_[axis] = vertices_->find(name);
      if (!axes_[axis] || axes_[axis]->is_list) return malformed("its vertices have no property '" + name + "'");
    }
    corners_ = faces_->find("vertex_indices");
    if (!corners_) corners_ = faces_->find("vertex_index");
    if (!corners_ || !corners_->is_list) return malformed("its faces have no list 'vertex_indices'");
    if (!is_integer(corners_->type)) return malformed("its 'vertex_indices' are not integers");
    return {};
  }

  // Refuses a count the rest of the file can't hold, before anything is allocated or read for it.
  Status check_size(const PlyElement& element) const {
    const auto left = file_.bytes_left();
    if (!left) return {};
    std::uint64_t row = 0, needed = 0;
    for (const PlyProperty& p : element.properties) row += Values::least_size(p.is_list ? p.count_type : p.type);
    const bool overflow = __builtin_mul_overflow(row, element.count, &needed);
    // The last number of an ASCII file needs no blank behind it.
    if (!overflow && needed <= *left + (header_.format == PlyFormat::ascii ? 1 : 0)) return {};
    return malformed("it is truncated: its " + count_of(element.count, "element") + " '" + one_line(element.name) +
                     "' need at least " + (overflow ? "2^64" : std::to_string(needed)) + " bytes and " +
                     std::to_string(*left) + " are left");
  }

  Status read_vertices(const PlyElement& element) {
    std::vector<Vec3>& vertices = loaded_.mesh.vertices;
    vertices.reserve(file_.is_regular() ? element.count : std::min(element.count, kReserveUnseen));
    for (std::uint64_t row = 0; row < element.count; ++row) {
      Vec3 position;
      for (const PlyProperty& property : element.properties) {
        const int axis = &property == axes_[0] ? 0 : &property == axes_[1] ? 1 : &property == axes_[2] ? 2 : -1;
        double value = 0;
        if (axis < 0) {
          if (Status status = skip_property(property, element, row); !status) return status;
        } else if (values_.next(property.type, value)) {
          position[axis] = static_cast<float>(value);
        } else {
          return broken(element, row);
        }
      }
      vertices.push_back(position);
    }
    return {};
  }

  Status read_faces(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count; ++row)
      for (const PlyProperty& property : element.properties)
        if (Status status = &property == corners_ ? read_corners(element, row) : skip_property(property, element, row);
            !status)
          return status;
    return {};
  }

  // Cuts the polygon into a fan around its first corner while it is read, so its length does not matter.
  Status read_corners(const PlyElement& element, std::uint64_t row) {
    std::uint64_t count = 0;
    if (Status status = read_length(*corners_, element, row, count); !status) return status;
    std::vector<std::array<std::uint32_t, 3>>& triangles = loaded_.mesh.triangles;
    if (row == 0) reserve_triangles(element.count, count);
    std::uint32_t first = 0, previous = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      double value = 0;
      if (!values_.next(corners_->type, value)) return broken(element, row);
      if (!(value >= 0 && value < static_cast<double>(vertices_->count)) || value != std::floor(value))
        return bad_index(row, value);
      const auto index = static_cast<std::uint32_t>(value);
      if (i == 0) first = index;
      if (i >= 2) {
        if (triangles.size() == kMostEntries)
          return Error(read_error(ErrorCode::too_large, path_, "it has more than 2^31 - 1 triangles"));
        triangles.push_back({first, previous, index});
      }
      previous = index;
    }
    if (count > 3) ++loaded_.polygons_triangulated;
    if (count < 3) ++loaded_.lines_and_points_skipped;
    return {};
  }

  // Most meshes have faces of one kind, so the first face foretells the memory; the size of the file bounds it.
  void reserve_triangles(std::uint64_t faces, std::uint64_t corners) {
    const std::uint64_t guess = faces * std::clamp<std::uint64_t>(corners, 3, 8) - 2 * faces;
    const std::uint64_t bound =
        file_.is_regular() ? *file_.bytes_left() / Values::least_size(corners_->type) + 1 : kReserveUnseen;
    loaded_.mesh.triangles.reserve(std::min({guess, bound, kMostEntries}));
  }

  Status skip_rows(const PlyElement& element) {
    if (element.name == "edge") loaded_.lines_and_points_skipped += element.count;
    if (element.properties.empty()) return {};
    for (std::uint64_t row = 0; row < element.count; ++row)
      for (const PlyProperty& property : element.properties)
        if (Status status = skip_property(property, element, row); !status) return status;
    return {};
  }

  Status skip_property(const PlyProperty& property, const PlyElement& element, std::uint64_t row) {
    std::uint64_t count = 1;
    if (property.is_list)
      if (Status status = read_length(property, element, row, count); !status) return status;
    if (!values_.skip(property.type, count)) return broken(element, row);
    return {};
  }

  Status read_length(const PlyProperty& list, const PlyElement& element, std::uint64_t row, std::uint64_t& count) {
    double value = 0;
    if (!values_.next(list.count_type, value)) return broken(element, row);
    if (!(value >= 0 && value <= 0xffffffffu) || value != std::floor(value))
      return malformed(row_name(element, row) + " has a list of length " + number(value));
    count = static_cast<std::uint64_t>(value);
    return {};
  }

  Status broken(const PlyElement& element, std::uint64_t row) const {
    if (file_.system_error()) return read_error(path_, file_.system_error());
    const std::string problem = values_.problem();
    return malformed((problem == "the file ends" ? "it is truncated: " : "") + problem + " in " +
                     row_name(element, row) + " of " + std::to_string(element.count));
  }

  Status bad_index(std::uint64_t face, double value) const {
    return malformed("face " + std::to_string(face) + " refers to vertex " + number(value) + ", there are " +
                     std::to_string(vertices_->count) + " (counted from 0)");
  }

  // Integers without a decimal point, anything else as a person would write it.
  static std::string number(double value) {
    char text[32] = {};
    std::to_chars(text, text + sizeof(text) - 1, value);
    return text;
  }

  static std::string row_name(const PlyElement& element, std::uint64_t row) {
    return "'" + one_line(element.name) + "' " + std::to_string(row);
  }

  Error malformed(const std::string& reason) const { return read_error(ErrorCode::malformed, path_, reason); }

  FileReader& file_;
  const std::filesystem::path& path_;
  const PlyHeader& header_;
  Values values_;
  LoadedMesh loaded_;
  const PlyElement* vertices_ = nullptr;
  const PlyElement* faces_ = nullptr;
  const PlyProperty* axes_[3] = {};
  const PlyProperty* corners_ = nullptr;
};

}  // namespace

Result<LoadedMesh> read_ply(FileReader& file, const std::filesystem::path& path) {
  const Result<PlyHeader> header = read_ply_header(file, path);
  if (!header) return header.error();
  constexpr bool kLittleEndianMachine = std::endian::native == std::endian::little;
  switch (header->format) {
    case PlyFormat::binary_little_endian:
      return BodyReader<BinaryPlyValues<!kLittleEndianMachine>>(file, path, *header).read();
    case PlyFormat::binary_big_endian:
      return BodyReader<BinaryPlyValues<kLittleEndianMachine>>(file, path, *header).read();
    default:
      return BodyReader<AsciiPlyValues>(file, path, *header).read();
  }
}

}  // namespace boxwood::io
