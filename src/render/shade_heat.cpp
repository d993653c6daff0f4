// The shades `nodes` and `primitives`: the work of each pixel's primary ray as a colour. The lightest colour stands for
// the 99.5th percentile, rounded up to a round number, so that a few costly rays do not darken the whole picture.
#include "render/color.h"
#include "render/color_scale.h"
#include "render/frame.h"
#include "render/value_plane.h"

namespace boxwood::render {

Status shade_heat(const Frame& frame, Shade shade, Image& image) {
  const bool nodes = shade == Shade::nodes;
  ValuePlane work(image);
  auto traced = for_batches(frame, Detail::counts, [&](const PixelBatch& batch) -> Status {
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      work.set(batch.first_pixel + i, nodes ? batch.counts[i].nodes : batch.counts[i].primitives);
    });
    return {};
  });
  if (!traced) return traced;
  const ValuePlane::Summary summary = work.summarize();
  const ColorScale scale = ColorScale::up_to(work.quantile(0.995));
  for_each_index(frame.accel.executor(), work.size(), [&](std::size_t pixel) {
    set_pixel(image, pixel, heat_color(static_cast<double>(work[pixel]) / scale.upper));
  });
  draw_color_scale(image, scale, nodes ? "nodes visited per ray" : "triangles tested per ray", summary);
  return {};
}

}  // namespace boxwood::render
