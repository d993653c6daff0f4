// The shade `depth`: the distance along the view direction, nearer is lighter. The range is that of the picture without
// its nearest and farthest half percent, so that one stray triangle does not flatten the rest.
#include <algorithm>

#include "render/color.h"
#include "render/frame.h"
#include "render/value_plane.h"

namespace boxwood::render {
namespace {

struct Range {
  double low = 0, high = 0;
};

/// Depths that points of the box can have, in front of the eye.
Range depth_range(const Camera& camera, const Box& bounds) {
  Range range{.low = std::numeric_limits<double>::infinity()};
  for (int corner = 0; corner < 8; ++corner) {
    const Vector point(corner & 1 ? bounds.upper.x : bounds.lower.x, corner & 2 ? bounds.upper.y : bounds.lower.y,
                       corner & 4 ? bounds.upper.z : bounds.lower.z);
    const double depth = dot(point - Vector(camera.eye()), camera.forward());
    range.low = std::min(range.low, depth), range.high = std::max(range.high, depth);
  }
  range.low = std::max(range.low, 0.0);
  return range;
}

double share_of(double value, double low, double high) {
  return high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0;
}

}  // namespace

Status shade_depth(const Frame& frame, Image& image) {
  ValuePlane depths(image);
  const Range range = frame.accel.bounds().is_empty() ? Range{} : depth_range(frame.camera, frame.accel.bounds());
  auto traced = for_batches(frame, Detail::none, [&](const PixelBatch& batch) -> Status {
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      const std::size_t pixel = batch.first_pixel + i;
      if (!batch.hits[i]) return depths.set_nothing(pixel);
      const double depth = dot(Vector(batch.rays[i].direction), frame.camera.forward()) * batch.hits[i].t;
      depths.set(pixel, static_cast<std::uint64_t>(share_of(depth, range.low, range.high) * ValuePlane::kLargest));
    });
    return {};
  });
  if (!traced) return traced;
  const std::uint32_t nearest = depths.quantile(0.005), farthest = depths.quantile(0.995);
  for_each_index(frame.accel.executor(), depths.size(), [&](std::size_t pixel) {
    const std::uint32_t depth = depths[pixel];
    const double share = share_of(depth, nearest, farthest);
    const Color color = depth == ValuePlane::kNothing ? from_oklch(0.12, 0.015, 265)
                                                      : from_oklch(0.97 - 0.72 * share, 0.02 + 0.03 * share, 265);
    set_pixel(image, pixel, to_srgb(color));
  });
  return {};
}

}  // namespace boxwood::render
