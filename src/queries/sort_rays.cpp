// Sorting of incoherent rays by octant, origin and coarse direction, with a radix sort over keys of 22 bits (rays in
// order of such keys: Moon and others 2010, bib key moon2010; Aila and Karras 2010, bib key aila2010). The rays
// themselves are moved once, at the end. Linear time.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "queries/batch.h"

namespace boxwood::queries {
namespace {

constexpr int kDigit = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigit;

/// A number from 0 to `cells` - 1; what is outside, and NaN, goes into the nearest cell.
std::uint32_t cell(float value, float lower, float scale, int cells) {
  const float x = (value - lower) * scale;
  return static_cast<std::uint32_t>(x > 0 ? minimum(x, static_cast<float>(cells - 1)) : 0.0f);
}

/// Bits 0 to 4 of x to bits 0, 3, 6, 9 and 12.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | x << 8) & 0x100f;
  x = (x | x << 4) & 0x10c3;
  return (x | x << 2) & 0x1249;
}

/// Octant (3 bits), origin (15 bits), direction (4 bits).
std::uint32_t key_of(const Ray& ray, const Box& bounds, const Vec3& scale) {
  const Vec3 d = ray.direction;
  std::uint32_t origin = 0;
  for (int axis = 0; axis < 3; ++axis)
    origin |= spread_bits(cell(ray.origin[axis], bounds.lower[axis], scale[axis], 32)) << axis;
  const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  const float sum = x + y + z;
  const std::uint32_t direction = cell(x, 0, 4 / sum, 4) << 2 | cell(y, 0, 4 / sum, 4);
  const std::uint32_t octant = (d.x < 0) | (d.y < 0) << 1 | (d.z < 0) << 2;
  return octant << 19 | origin << 4 | direction;
}

}  // namespace

void sort_rays(std::span<const Ray> rays, const Box& bounds, std::span<Ray> sorted, std::span<std::uint32_t> places,
               std::span<std::uint64_t> scratch) {
  const std::size_t n = rays.size();
  std::uint64_t *from = scratch.data(), *to = scratch.data() + n;
  std::array<std::array<std::uint32_t, kDigits>, 2> counts{};
  Vec3 scale;
  for (int axis = 0; axis < 3; ++axis) {
    const float size = bounds.upper[axis] - bounds.lower[axis];
    scale[axis] = size > 0 ? 32 / size : 0.0f;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t key = key_of(rays[i], bounds, scale);
    ++counts[0][key & (kDigits - 1)], ++counts[1][key >> kDigit];
    from[i] = std::uint64_t{key} << 32 | i;
  }
  for (int pass = 0; pass < 2; ++pass) {
    std::uint32_t sum = 0;
    for (std::uint32_t& count : counts[pass]) sum += std::exchange(count, sum);
    for (std::size_t i = 0; i < n; ++i) to[counts[pass][from[i] >> (32 + kDigit * pass) & (kDigits - 1)]++] = from[i];
    std::swap(from, to);
  }
  for (std::size_t i = 0; i < n; ++i) {
    places[i] = static_cast<std::uint32_t>(from[i]);
    sorted[i] = rays[places[i]];
  }
}

}  // namespace boxwood::queries
