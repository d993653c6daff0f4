// What a picture is made of, and the loop over its pixels in batches of bounded memory.
#pragma once

#include <span>
#include <vector>

#include "boxwood/accel.h"
#include "boxwood/render.h"
#include "render/camera.h"

namespace boxwood::render {

struct Frame {
  const Accel& accel;
  Camera camera;
  std::span<const std::uint8_t> marked = {};  ///< by primitive id; empty but for Shade::subdivided

  bool is_marked(std::uint32_t primitive) const { return primitive < marked.size() && marked[primitive] != 0; }
};

/// Pixels handled by one piece of parallel work.
inline constexpr std::size_t kPixelChunk = 4096;

/// What a batch asks the Accel for besides hits.
enum class Detail { none, normals, counts };

/// Consecutive whole rows of pixels, each pixel with its primary ray and its closest hit.
struct PixelBatch {
  std::size_t first_pixel = 0;
  std::span<const Ray> rays;
  std::span<const Hit> hits;
  std::span<const Vec3> normals;            ///< empty unless Detail::normals
  std::span<const queries::Counts> counts;  ///< empty unless Detail::counts

  std::size_t size() const { return rays.size(); }
};

/// Traces the primary rays of all pixels, one call to the Accel per batch, and hands the batches on in order. Stops at
/// the first error, of the Accel's or of `use`.
Status for_batches(const Frame& frame, Detail detail, FunctionRef<Status(const PixelBatch&)> use);

/// Calls f(i) for all i below `count`, in parallel. f must touch nothing but what belongs to i.
template <class F>
void for_each_index(Executor& executor, std::size_t count, const F& f) {
  executor.for_chunks(count, kPixelChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(i);
  });
}

// The shades. Each fills all pixels of an image that has the camera's size.
/// Shade::normals and Shade::subdivided.
Status shade_normals(const Frame& frame, Image& image);
Status shade_ids(const Frame& frame, Image& image);
Status shade_depth(const Frame& frame, Image& image);
Status shade_occlusion(const Frame& frame, Image& image);
/// `shade` is Shade::nodes or Shade::primitives.
Status shade_heat(const Frame& frame, Shade shade, Image& image);

}  // namespace boxwood::render
