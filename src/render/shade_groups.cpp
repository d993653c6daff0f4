// Triangles in the colours of their groups, as in Figure 2 of Popov et al. 2009 (bib key popov2009), which shows the
// two children of a node. Shaded by a lamp at the eye.
#include <atomic>

#include "render/backdrop.h"
#include "render/color.h"
#include "render/frame.h"
#include "render/surface_point.h"

namespace boxwood::render {
namespace {

Color group_color(Group group) {
  switch (group) {
    case Group::none:
      break;
    case Group::first:
      return from_oklch(0.72, 0.13, 250);
    case Group::second:
      return from_oklch(0.78, 0.14, 65);
    case Group::both:
      return from_oklch(0.65, 0.16, 320);
  }
  return from_oklch(0.88, 0.01, 90);
}

}  // namespace

Status shade_groups(const Frame& frame, std::span<const Group> groups, Image& image) {
  std::atomic<bool> complete = true;
  const Status traced = for_batches(frame, Detail::normals, [&](const PixelBatch& batch) -> Status {
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      const std::size_t pixel = batch.first_pixel + i;
      if (!batch.hits[i]) return set_pixel(image, pixel, to_srgb(backdrop(frame.camera, pixel)));
      if (batch.hits[i].primitive >= groups.size()) return complete.store(false, std::memory_order_relaxed);
      const Vector normal = facing_normal(batch.rays[i], batch.normals[i]);
      const auto cosine = static_cast<float>(-dot(normal, normalize(Vector(batch.rays[i].direction))));
      set_pixel(image, pixel, to_srgb(group_color(groups[batch.hits[i].primitive]) * (0.25f + 0.75f * cosine)));
    });
    return {};
  });
  if (!traced) return traced;
  if (!complete)
    return {ErrorCode::invalid_argument,
            "there are groups for " + std::to_string(groups.size()) + " triangles only, fewer than the mesh has"};
  return {};
}

}  // namespace boxwood::render
