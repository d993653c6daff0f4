#include "render/sampling.h"

#include <numbers>

namespace boxwood::render {
namespace {

constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15ull;

constexpr std::uint64_t scramble(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ x >> 27) * 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

/// Sine and cosine of |angle| <= pi / 4, to 2e-9: Taylor's series, because a library's functions differ between
/// machines.
constexpr double small_sine(double angle) {
  const double s = angle * angle;
  return angle * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72))));
}
constexpr double small_cosine(double angle) {
  const double s = angle * angle;
  return 1 - s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90))));
}

/// Area-preserving map of the unit square onto the unit disc.
Sample2 concentric_disc(Sample2 sample) {
  const double a = 2 * sample.x - 1, b = 2 * sample.y - 1;
  if (a == 0 && b == 0) return {};
  if (std::fabs(a) > std::fabs(b)) {
    const double angle = std::numbers::pi / 4 * (b / a);
    return {a * small_cosine(angle), a * small_sine(angle)};
  }
  const double angle = std::numbers::pi / 4 * (a / b);
  return {b * small_sine(angle), b * small_cosine(angle)};
}

}  // namespace

std::uint64_t random_bits(std::uint64_t seed, std::uint64_t index, std::uint64_t dimension) {
  const std::uint64_t stream = scramble(seed + kGoldenRatio);
  return scramble(scramble(stream ^ index * kGoldenRatio) + (dimension + 1) * kGoldenRatio);
}

Sample2 random_pair(std::uint64_t seed, std::uint64_t index, std::uint64_t dimension) {
  const std::uint64_t bits = random_bits(seed, index, dimension);
  const auto uniform = [](std::uint64_t bits32) { return (static_cast<double>(bits32) + 0.5) * 0x1p-32; };
  return {uniform(bits >> 32), uniform(bits & 0xffffffffu)};
}

Vector sphere_direction(Sample2 sample) {
  const Sample2 disc = concentric_disc(sample);
  const double square = std::fmin(disc.x * disc.x + disc.y * disc.y, 1.0);
  const double stretch = 2 * std::sqrt(1 - square);
  return {disc.x * stretch, disc.y * stretch, 1 - 2 * square};
}

Vector cosine_direction(Sample2 sample, Vector normal) {
  const Sample2 disc = concentric_disc(sample);
  // The floor, far above single precision's rounding, keeps the rounded direction off the surface's plane.
  const double height = std::sqrt(std::fmax(1 - disc.x * disc.x - disc.y * disc.y, 1e-10));
  const Vector tangent = normalize(cross(least_aligned_axis(normal), normal));
  const Vector bitangent = cross(normal, tangent);
  return normalize(tangent * disc.x + bitangent * disc.y + normal * height);
}

}  // namespace boxwood::render
