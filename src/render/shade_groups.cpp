// The shades `clusters` and `children`: triangles in the colour of the group they belong to, darker where they turn
// away from the eye, as shapes are what is looked at. After Houghton and Spoerer's Figures 1 to 4 (bib key ebbvh) and
// Figure 2 of Popov et al. 2009 (bib key popov2009).
#include "render/backdrop.h"
#include "render/color.h"
#include "render/frame.h"
#include "render/id_color.h"
#include "render/surface_point.h"

namespace boxwood::render {
namespace {

/// Of `children`: bit 0 the first child, bit 1 the second.
Color child_color(std::uint32_t number) {
  switch (number & 3) {
    case 1:
      return from_oklch(0.72, 0.13, 250);
    case 2:
      return from_oklch(0.78, 0.14, 65);
    case 3:
      return from_oklch(0.65, 0.16, 320);
    default:
      return from_oklch(0.88, 0.01, 90);
  }
}

}  // namespace

Status shade_groups(const Frame& frame, Shade shade, Image& image) {
  return for_batches(frame, Detail::normals, [&](const PixelBatch& batch) -> Status {
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      const std::size_t pixel = batch.first_pixel + i;
      if (!batch.hits[i]) return set_pixel(image, pixel, to_srgb(backdrop(frame.camera, pixel)));
      const std::uint32_t number = frame.number(batch.hits[i].primitive);
      const Color color = shade == Shade::clusters ? id_color(number) : child_color(number);
      const Vector normal = facing_normal(batch.rays[i], batch.normals[i]);
      const auto facing = static_cast<float>(-dot(normal, normalize(Vector(batch.rays[i].direction))));
      set_pixel(image, pixel, to_srgb(color * (0.3f + 0.7f * facing)));
    });
    return {};
  });
}

}  // namespace boxwood::render
