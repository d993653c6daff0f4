// The shade `ids`: each triangle has one flat colour.
#include "render/backdrop.h"
#include "render/frame.h"
#include "render/id_color.h"

namespace boxwood::render {

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
