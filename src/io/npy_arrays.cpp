// Rays and hits as NumPy arrays. Reading streams through a constant buffer: memory is that of the rays.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>

#include "boxwood/io.h"
#include "io/file_reader.h"
#include "io/npy_header.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the writers store this machine's bytes as little-endian");

constexpr std::uint64_t kReserveUnseen = 1 << 16;  // rays; when a pipe does not tell its length
constexpr std::size_t kChunkRows = 4096;

struct NumberType {
  std::size_t size = 4;
  bool swapped = false;
};

// "<f4", ">f8" and the like; '=' is the byte order of the machine that reads.
bool parse_type(const std::string& text, NumberType& type) {
  if (text.size() != 3 || std::string_view("<>=").find(text[0]) == std::string_view::npos) return false;
  if (text[1] != 'f' || (text[2] != '4' && text[2] != '8')) return false;
  type = {static_cast<std::size_t>(text[2] - '0'), text[0] == '>'};
  return true;
}

float number_at(const unsigned char* data, NumberType type) {
  unsigned char bytes[8];
  std::memcpy(bytes, data, type.size);
  if (type.swapped) std::reverse(bytes, bytes + type.size);
  if (type.size == 4) {
    float value;
    std::memcpy(&value, bytes, 4);
    return value;
  }
  double value;
  std::memcpy(&value, bytes, 8);
  return static_cast<float>(value);
}

void set_column(Ray& ray, std::size_t column, float value) {
  if (column < 3)
    ray.origin[static_cast<int>(column)] = value;
  else if (column < 6)
    ray.direction[static_cast<int>(column) - 3] = value;
  else
    (column == 6 ? ray.tmin : ray.tmax) = value;
}

class RayReader {
 public:
  RayReader(FileReader& file, const std::filesystem::path& path) : file_(file), path_(path) {}

  Result<std::vector<Ray>> read() {
    const Result<NpyHeader> header = read_npy_header(file_, path_);
    if (!header) return header.error();
    if (!parse_type(header->type, type_))
      return fail("its numbers are of type " + one_line(header->type) + ", float32 ('<f4') or float64 are needed");
    const auto& shape = header->shape;
    if (shape.size() != 2 || (shape[1] != 6 && shape[1] != 8))
      return fail("its shape is " + header->shape_text() + ", (N, 6) or (N, 8) is needed");
    rows_ = shape[0], columns_ = shape[1];
    std::uint64_t needed = 0;
    const bool overflow = __builtin_mul_overflow(rows_, columns_ * type_.size, &needed);
    if (overflow || (file_.bytes_left() && needed > *file_.bytes_left()))
      return fail("it is truncated: its shape " + header->shape_text() + " needs " +
                  (overflow ? "over 2^64" : std::to_string(needed)) + " bytes of data" +
                  (file_.bytes_left() ? " and it has " + std::to_string(*file_.bytes_left()) : ""));
    Status status = header->fortran_order ? read_by_columns() : read_by_rows();
    if (!status) return status.error();
    return std::move(rays_);
  }

 private:
  Status read_by_rows() {
    rays_.reserve(file_.is_regular() ? rows_ : std::min(rows_, kReserveUnseen));
    const std::size_t row_size = columns_ * type_.size;
    for (std::uint64_t row = 0; row < rows_; ++row) {
      if (!file_.prepare(row_size)) return truncated(row);
      Ray ray;
      for (std::size_t c = 0; c < columns_; ++c) set_column(ray, c, number_at(file_.data() + c * type_.size, type_));
      file_.consume(row_size);
      rays_.push_back(ray);
    }
    return {};
  }

  // Fortran order: all of the first column, then all of the second. The first one grows the array.
  Status read_by_columns() {
    rays_.reserve(file_.is_regular() ? rows_ : std::min(rows_, kReserveUnseen));
    for (std::size_t c = 0; c < columns_; ++c)
      for (std::uint64_t row = 0; row < rows_; ++row) {
        if (!file_.prepare(type_.size)) return truncated(row);
        if (c == 0) rays_.emplace_back();
        set_column(rays_[row], c, number_at(file_.data(), type_));
        file_.consume(type_.size);
      }
    return {};
  }

  Status truncated(std::uint64_t row) const {
    if (file_.system_error()) return read_error(path_, file_.system_error());
    return fail("it is truncated: the data ends in row " + std::to_string(row) + " of " + std::to_string(rows_));
  }

  Error fail(const std::string& reason) const { return read_error(ErrorCode::malformed, path_, reason); }

  FileReader& file_;
  const std::filesystem::path& path_;
  NumberType type_;
  std::uint64_t rows_ = 0, columns_ = 0;
  std::vector<Ray> rays_;
};

// Header, then the items in chunks, each made by `convert(item)`.
template <class Item, class Convert>
Status write_array(const std::filesystem::path& path, const std::string& type, const std::vector<std::uint64_t>& shape,
                   std::span<const Item> items, Convert&& convert) {
  return guard_memory("write", path, [&]() -> Status {
    return write_file(path, [&](const Sink& sink) -> Status {
      const std::string header = make_npy_header(type, shape);
      if (Status status = sink(header.data(), header.size()); !status) return status;
      std::vector<decltype(convert(items[0]))> chunk;
      for (std::size_t begin = 0; begin < items.size(); begin += kChunkRows) {
        chunk.clear();
        for (const Item& item : items.subspan(begin, std::min(kChunkRows, items.size() - begin)))
          chunk.push_back(convert(item));
        if (Status status = sink(chunk.data(), chunk.size() * sizeof(chunk[0])); !status) return status;
      }
      return {};
    });
  });
}

}  // namespace

Result<std::vector<Ray>> read_rays(const std::filesystem::path& path) {
  return guard_memory("read", path, [&]() -> Result<std::vector<Ray>> {
    Result<FileReader> file = FileReader::open(path);
    if (!file) return file.error();
    if (!file->prepare(1) && !file->system_error()) return Error(read_error(ErrorCode::malformed, path, "it is empty"));
    return RayReader(*file, path).read();
  });
}

Status write_hits(const std::filesystem::path& path, std::span<const HitRecord> records) {
  return write_array(path, "[('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('primitive', '<u4')]", {records.size()},
                     records, [](const HitRecord& record) { return record; });
}

Status write_occlusion(const std::filesystem::path& path, std::span<const std::uint8_t> occluded) {
  return write_array(path, "'|b1'", {occluded.size()}, occluded,
                     [](std::uint8_t value) { return static_cast<std::uint8_t>(value != 0); });
}

Status write_rays(const std::filesystem::path& path, std::span<const Ray> rays) {
  return write_array(path, "'<f4'", {rays.size(), 8}, rays, [](const Ray& ray) {
    return std::array<float, 8>{ray.origin.x,    ray.origin.y,    ray.origin.z, ray.direction.x,
                                ray.direction.y, ray.direction.z, ray.tmin,     ray.tmax};
  });
}

}  // namespace boxwood::io
