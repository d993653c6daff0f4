// PNG through libpng's simplified interface, which keeps its setjmp to itself: no jump ever crosses our frames.
#include <png.h>

#include <cstring>

#include "boxwood/io.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 30;

Status check(const std::filesystem::path& path, const Image& image) {
  const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
  if (image.width < 1 || image.height < 1)
    return write_error(ErrorCode::invalid_argument, path, "a picture of " + size + " pixels has no pixels");
  const std::uint64_t pixels = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  if (pixels > kMostPixels)
    return write_error(ErrorCode::too_large, path, "a picture of " + size + " pixels is beyond 2^30 pixels");
  if (image.rgb.size() != 3 * pixels)
    return write_error(ErrorCode::invalid_argument, path,
                       "a picture of " + size + " pixels needs " + std::to_string(3 * pixels) + " bytes and has " +
                           std::to_string(image.rgb.size()));
  return {};
}

}  // namespace

Status write_png(const std::filesystem::path& path, const Image& image) {
  return guard_memory("write", path, [&]() -> Status {
    if (Status status = check(path, image); !status) return status;
    png_image png;
    std::memset(&png, 0, sizeof(png));
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    // An upper bound, so that one compression is enough; it is little more than the picture itself.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    AlignedBuffer<std::uint8_t> bytes(size);
    const bool encoded = png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) != 0;
    const std::string reason = one_line(png.message);
    png_image_free(&png);
    if (!encoded) return write_error(ErrorCode::unsupported, path, "libpng says: " + reason);
    return write_file(path, [&](const Sink& sink) { return sink(bytes.data(), size); });
  });
}

}  // namespace boxwood::io
