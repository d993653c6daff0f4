// The shades `ids` and `clusters`: each triangle, or each group of triangles, has one flat colour, whose hue and
// lightness are a hash of its number. Clusters are darker away from the viewer, as their shapes are what is looked at.
#include "render/backdrop.h"
#include "render/color.h"
#include "render/frame.h"
#include "render/sampling.h"
#include "render/surface_point.h"

namespace boxwood::render {
namespace {

Color id_color(std::uint32_t primitive) {
  constexpr std::uint64_t kSeed = 1;
  const Sample2 sample = random_pair(kSeed, primitive, 0);
  return from_oklch(0.55 + 0.3 * sample.y, 0.12, 360 * sample.x);
}

}  // namespace

Status shade_ids(const Frame& frame, Image& image) {
  return for_batches(frame, Detail::none, [&](const PixelBatch& batch) -> Status {
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      const std::size_t pixel = batch.first_pixel + i;
      set_pixel(image, pixel,
                to_srgb(batch.hits[i] ? id_color(batch.hits[i].primitive) : backdrop(frame.camera, pixel)));
    });
    return {};
  });
}

Status shade_clusters(const Frame& frame, std::span<const std::uint32_t> groups, Image& image) {
  return for_batches(frame, Detail::normals, [&](const PixelBatch& batch) -> Status {
    for (const Hit& hit : batch.hits)
      if (hit && hit.primitive >= groups.size())
        return {ErrorCode::invalid_argument,
                "the shade clusters needs a number for each triangle, and there is none "
                "for triangle " +
                    std::to_string(hit.primitive)};
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      const std::size_t pixel = batch.first_pixel + i;
      if (!batch.hits[i]) return set_pixel(image, pixel, to_srgb(backdrop(frame.camera, pixel)));
      const Vector normal = facing_normal(batch.rays[i], batch.normals[i]);
      const auto facing = static_cast<float>(-dot(normal, normalize(Vector(batch.rays[i].direction))));
      set_pixel(image, pixel, to_srgb(id_color(groups[batch.hits[i].primitive]) * (0.4f + 0.6f * facing)));
    });
    return {};
  });
}

}  // namespace boxwood::render
