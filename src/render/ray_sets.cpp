// The ray sets that measurements trace. Each ray depends on the arguments and its own index only, so the sets are the
// same for every number of threads. O(rays), and two closest hits per primary ray for the sets that start on surfaces.
#include <algorithm>
#include <numeric>

#include "boxwood/render.h"
#include "render/camera.h"
#include "render/sampling.h"
#include "render/surface_point.h"

namespace boxwood::render {
namespace {

constexpr std::size_t kBatch = std::size_t{1} << 20;
constexpr std::size_t kChunk = 4096;

// Each kind of ray set has dimensions of the random numbers to itself, so that one seed may serve them all.
constexpr std::uint64_t kOriginDimension = 0, kDirectionDimension = 2, kDiffuseDimension = 3, kOcclusionDimension = 4,
                        kLineDimension = 5;

/// Uniform between two numbers: in double, so that no width of a box overflows, and never outside.
float between(float lower, float upper, double share) {
  const double value = (1 - share) * lower + share * upper;
  return std::clamp(static_cast<float>(value), lower, upper);
}

/// A point on the box's surface, uniform by area, with the normal that points inside. A box without area has its six
/// sides equally often.
struct SidePoint {
  Vector position, normal;
};
SidePoint point_on_side(const Box& box, double side_share, Sample2 place) {
  const Vector extent(box.upper - box.lower), lower(box.lower), upper(box.upper);
  double areas[3] = {extent.y * extent.z, extent.z * extent.x, extent.x * extent.y};
  double sum = areas[0] + areas[1] + areas[2];
  if (!(sum > 0)) areas[0] = areas[1] = areas[2] = 1, sum = 3;
  double rest = 2 * side_share * sum;
  const bool is_upper = rest >= sum;
  if (is_upper) rest -= sum;
  const int axis = rest < areas[0] ? 0 : rest < areas[0] + areas[1] ? 1 : areas[2] > 0 ? 2 : areas[1] > 0 ? 1 : 0;
  const double sign = is_upper ? -1 : 1;
  switch (axis) {
    case 0:
      return {{is_upper ? upper.x : lower.x, lower.y + place.x * extent.y, lower.z + place.y * extent.z}, {sign, 0, 0}};
    case 1:
      return {{lower.x + place.x * extent.x, is_upper ? upper.y : lower.y, lower.z + place.y * extent.z}, {0, sign, 0}};
    default:
      return {{lower.x + place.x * extent.x, lower.y + place.y * extent.y, is_upper ? upper.z : lower.z}, {0, 0, sign}};
  }
}

/// Turns the errors of a batch query into what a function without a Result can say. The spans are of equal length, so
/// memory is all that can be missing.
void require(const Status& status) {
  if (!status) throw std::bad_alloc();
}

/// Makes the rays that start where primary rays hit; keeps its arrays from batch to batch.
class SurfaceRays {
 public:
  SurfaceRays(const Accel& accel, std::uint64_t seed, std::uint64_t dimension, float tmax)
      : accel_(accel), seed_(seed), dimension_(dimension), tmax_(tmax) {}

  /// Appends to `rays` those of the given primary rays, the first of which has the index `first`.
  void append(std::span<const Ray> primary, std::size_t first, std::vector<Ray>& rays) {
    hits_.resize(primary.size()), normals_.resize(primary.size());
    require(accel_.closest_hits(primary, hits_, normals_));
    sources_.clear();
    for (std::size_t i = 0; i < primary.size(); ++i)
      if (hits_[i]) sources_.push_back(i);
    const std::size_t begin = rays.size();
    rays.resize(begin + sources_.size());
    made_.resize(sources_.size());
    make(primary, first, 1);
    std::copy(made_.begin(), made_.end(), rays.begin() + static_cast<std::ptrdiff_t>(begin));
    places_.resize(sources_.size());
    std::iota(places_.begin(), places_.end(), begin);
    // On triangles hundreds of times longer than wide a hit is inexact enough for the new ray to meet its own triangle.
    for (double factor = kLiftGrowth; factor <= kLargestLift && keep_self_hits(); factor *= kLiftGrowth) {
      make(primary, first, factor);
      for (std::size_t i = 0; i < made_.size(); ++i) rays[places_[i]] = made_[i];
    }
  }

 private:
  static constexpr double kLiftGrowth = 8, kLargestLift = 512;

  /// One ray for each source.
  void make(std::span<const Ray> primary, std::size_t first, double factor) {
    made_.resize(sources_.size());
    accel_.executor().for_chunks(sources_.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t source = sources_[i];
        const SurfacePoint point = lifted_point(primary[source], hits_[source], normals_[source], factor);
        const Vector direction = cosine_direction(random_pair(seed_, first + source, dimension_), point.normal);
        made_[i] = {.origin = point.position, .direction = direction.rounded(), .tmax = tmax_};
      }
    });
  }

  /// Keeps the sources whose ray meets the triangle it starts on. False when there are none.
  bool keep_self_hits() {
    next_hits_.resize(made_.size());
    require(accel_.closest_hits(made_, next_hits_));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < made_.size(); ++i) {
      if (next_hits_[i].primitive != hits_[sources_[i]].primitive) continue;
      sources_[kept] = sources_[i], places_[kept] = places_[i];
      ++kept;
    }
    sources_.resize(kept), places_.resize(kept);
    return kept != 0;
  }

  const Accel& accel_;
  std::uint64_t seed_, dimension_;
  float tmax_;
  std::vector<Hit> hits_, next_hits_;
  std::vector<Vec3> normals_;
  std::vector<Ray> made_;             ///< of each source
  std::vector<std::size_t> sources_;  ///< primary rays of the batch whose rays are being made
  std::vector<std::size_t> places_;   ///< of their rays in the result
};

/// For each primary ray that hits, a cosine-distributed ray with the given tmax from the point it hits.
std::vector<Ray> rays_from_surfaces(const Accel& accel, std::span<const Ray> primary, std::uint64_t seed,
                                    std::uint64_t dimension, float tmax) {
  std::vector<Ray> rays;
  SurfaceRays surface_rays(accel, seed, dimension, tmax);
  for (std::size_t first = 0; first < primary.size(); first += kBatch)
    surface_rays.append(primary.subspan(first, std::min(kBatch, primary.size() - first)), first, rays);
  return rays;
}

}  // namespace

Result<std::vector<Ray>> primary_rays(const View& view, int width, int height) try {
  const auto camera = Camera::make(view, width, height);
  if (!camera) return camera.error();
  std::vector<Ray> rays(camera->pixel_count());
  for (std::size_t pixel = 0; pixel < rays.size(); ++pixel) rays[pixel] = camera->ray(pixel);
  return rays;
} catch (const std::bad_alloc&) {
  return {ErrorCode::out_of_memory, "not enough memory for the rays of a picture of " + std::to_string(width) + " x " +
                                        std::to_string(height) + " pixels"};
}

std::vector<Ray> random_rays(const Box& bounds, std::size_t count, std::uint64_t seed) {
  std::vector<Ray> rays;
  if (bounds.is_empty() || !is_finite(bounds.lower) || !is_finite(bounds.upper)) return rays;
  rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Sample2 xy = random_pair(seed, i, kOriginDimension), z = random_pair(seed, i, kOriginDimension + 1);
    rays.push_back(
        {.origin = {between(bounds.lower.x, bounds.upper.x, xy.x), between(bounds.lower.y, bounds.upper.y, xy.y),
                    between(bounds.lower.z, bounds.upper.z, z.x)},
         .direction = sphere_direction(random_pair(seed, i, kDirectionDimension)).rounded()});
  }
  return rays;
}

// Lines that enter a convex body cross its surface uniformly by area, with a density proportional to the cosine of the
// angle to its normal (Cauchy, Crofton), so no line need be rejected.
std::vector<Ray> line_rays(const Box& bounds, std::size_t count, std::uint64_t seed) {
  std::vector<Ray> rays;
  if (bounds.is_empty() || !is_finite(bounds.lower) || !is_finite(bounds.upper)) return rays;
  rays.reserve(count);
  const double diagonal = length(Vector(bounds.upper) - Vector(bounds.lower));
  for (std::size_t i = 0; i < count; ++i) {
    const SidePoint point =
        point_on_side(bounds, random_pair(seed, i, kLineDimension).x, random_pair(seed, i, kLineDimension + 1));
    const Vector direction = cosine_direction(random_pair(seed, i, kLineDimension + 2), point.normal);
    rays.push_back({.origin = (point.position - direction * diagonal).rounded(), .direction = direction.rounded()});
  }
  return rays;
}

std::vector<Ray> diffuse_rays(const Accel& accel, std::span<const Ray> primary, std::uint64_t seed) {
  return rays_from_surfaces(accel, primary, seed, kDiffuseDimension, kInfinity);
}

std::vector<Ray> occlusion_rays(const Accel& accel, std::span<const Ray> primary, std::uint64_t seed, float radius) {
  const float tmax = radius > 0 ? radius : default_occlusion_radius(accel.bounds());
  return rays_from_surfaces(accel, primary, seed, kOcclusionDimension, tmax);
}

std::uint64_t hash(std::span<const Ray> rays) {
  return hash_bytes(rays.data(), rays.size_bytes());
}

}  // namespace boxwood::render
