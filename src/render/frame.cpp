#include "render/frame.h"

#include <algorithm>

namespace boxwood::render {
namespace {

/// About this many pixels at a time, in whole rows.
constexpr std::size_t kBatch = std::size_t{1} << 16;

std::size_t batch_size(const Camera& camera) {
  const auto width = static_cast<std::size_t>(camera.width());
  return std::min(std::max(kBatch / width, std::size_t{1}) * width, camera.pixel_count());
}

}  // namespace

Status for_batches(const Frame& frame, Detail detail, FunctionRef<Status(const PixelBatch&)> use) {
  const std::size_t pixels = frame.camera.pixel_count();
  const std::size_t capacity = batch_size(frame.camera);
  std::vector<Ray> rays(capacity);
  std::vector<Hit> hits(capacity);
  std::vector<Vec3> normals(detail == Detail::normals ? capacity : 0);
  std::vector<queries::Counts> counts(detail == Detail::counts ? capacity : 0);
  for (std::size_t first = 0; first < pixels; first += capacity) {
    const std::size_t size = std::min(capacity, pixels - first);
    for_each_index(frame.accel.executor(), size, [&](std::size_t i) { rays[i] = frame.camera.ray(first + i); });
    const auto part = [size](auto& all) { return std::span(all).first(std::min(size, all.size())); };
    if (auto traced = detail == Detail::counts ? frame.accel.closest_hits_counted(part(rays), part(hits), part(counts))
                                               : frame.accel.closest_hits(part(rays), part(hits), part(normals));
        !traced)
      return traced;
    const PixelBatch batch{first, part(rays), part(hits), part(normals), part(counts)};
    if (auto used = use(batch); !used) return used;
  }
  return {};
}

}  // namespace boxwood::render
