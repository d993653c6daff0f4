// The shade `ao`, ambient occlusion (Zhukov, Iones and Kronin 1998, zhukov1998ambient): the share of cosine-distributed
// rays from the surface that get as far as a fifth of the diagonal. 16 rays a pixel, spread differently in neighbouring
// pixels, then averaged over the neighbours that lie on the same smooth surface. O(pixels), deterministic.
#include "render/backdrop.h"
#include "render/color.h"
#include "render/frame.h"
#include "render/occlusion_filter.h"
#include "render/sampling.h"
#include "render/surface_point.h"

namespace boxwood::render {
namespace {

constexpr std::size_t kRaysPerPixel = 16;

double fraction(double value) {
  return value - std::floor(value);
}

/// One of 16 points of a lattice in the unit square, which is moved as a whole from pixel to pixel. The moves, spread
/// by the powers of the plastic number, repeat with the filter's size, so that each average is over the same 400 points
/// and shows no grain on even surfaces.
Sample2 lattice_sample(std::size_t column, std::size_t row, std::size_t ray) {
  constexpr double kPlastic1 = 0.7548776662466927, kPlastic2 = 0.5698402909980532;
  constexpr std::size_t kSide = OcclusionFilter::kSide;
  const auto move = static_cast<double>(row % kSide * kSide + column % kSide) + 0.5;
  const auto i = static_cast<double>(ray);
  return {fraction(i / kRaysPerPixel + kPlastic1 * move), fraction(i / 4 + kPlastic2 * move)};
}

void make_rays(const SurfacePoint& point, std::size_t column, std::size_t row, float radius,
               std::span<Ray, kRaysPerPixel> rays) {
  for (std::size_t i = 0; i < kRaysPerPixel; ++i)
    rays[i] = {.origin = point.position,
               .direction = cosine_direction(lattice_sample(column, row, i), point.normal).rounded(),
               .tmax = radius};
}

float open_share(std::span<const std::uint8_t, kRaysPerPixel> occluded) {
  std::size_t open = 0;
  for (const std::uint8_t blocked : occluded) open += !blocked;
  return static_cast<float>(open) / static_cast<float>(kRaysPerPixel);
}

/// Finds how open the surface is at each pixel of one batch after the other; keeps its arrays between batches.
class OcclusionTracer {
 public:
  explicit OcclusionTracer(const Frame& frame)
      : frame_(frame), radius_(default_occlusion_radius(frame.accel.bounds())) {}

  Status trace(const PixelBatch& batch, std::span<OpenPoint> points) {
    std::size_t hits = 0;
    slots_.resize(batch.size());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      slots_[i] = hits * kRaysPerPixel;
      hits += batch.hits[i].is_hit();
    }
    rays_.resize(hits * kRaysPerPixel), occluded_.resize(hits * kRaysPerPixel);
    const auto width = static_cast<std::size_t>(frame_.camera.width());
    for_each_index(frame_.accel.executor(), batch.size(), [&](std::size_t i) {
      points[i] = {};
      if (!batch.hits[i]) return;
      const SurfacePoint point = lifted_point(batch.rays[i], batch.hits[i], batch.normals[i]);
      points[i] = {.position = point.position, .normal = point.normal.rounded()};
      const std::size_t pixel = batch.first_pixel + i;
      make_rays(point, pixel % width, pixel / width, radius_,
                std::span<Ray, kRaysPerPixel>(&rays_[slots_[i]], kRaysPerPixel));
    });
    if (auto traced = frame_.accel.any_hits(rays_, occluded_); !traced) return traced;
    for_each_index(frame_.accel.executor(), batch.size(), [&](std::size_t i) {
      if (!batch.hits[i]) return;
      points[i].open = open_share(std::span<const std::uint8_t, kRaysPerPixel>(&occluded_[slots_[i]], kRaysPerPixel));
    });
    return {};
  }

  float radius() const { return radius_; }

 private:
  const Frame& frame_;
  float radius_;
  std::vector<Ray> rays_;
  std::vector<std::uint8_t> occluded_;
  std::vector<std::size_t> slots_;  ///< of each pixel that hits, where its rays stand
};

}  // namespace

Status shade_occlusion(const Frame& frame, Image& image) {
  const Color dark = from_oklch(0.16, 0.02, 275), light = from_oklch(0.955, 0.012, 85);
  const Camera& camera = frame.camera;
  const auto width = static_cast<std::size_t>(camera.width()), height = static_cast<std::size_t>(camera.height());
  OcclusionTracer tracer(frame);
  OcclusionFilter filter(width, height, tracer.radius());
  std::size_t next_row = 0;
  return for_batches(frame, Detail::normals, [&](const PixelBatch& batch) -> Status {
    if (auto traced = tracer.trace(batch, filter.append_rows(batch.size() / width)); !traced) return traced;
    const std::size_t rows = filter.ready_rows() - next_row;
    for_each_index(frame.accel.executor(), rows * width, [&](std::size_t i) {
      const std::size_t pixel = next_row * width + i;
      const std::optional<float> open = filter.open(pixel % width, pixel / width);
      set_pixel(image, pixel, to_srgb(open ? mix(dark, light, *open) : backdrop(camera, pixel)));
    });
    next_row += rows;
    return {};
  });
}

}  // namespace boxwood::render
