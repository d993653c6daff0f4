// The shade `ids`: each triangle has one flat colour, whose hue and lightness are a hash of its id.
#include "render/backdrop.h"
#include "render/color.h"
#include "render/frame.h"
#include "render/sampling.h"

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

}  // namespace boxwood::render
