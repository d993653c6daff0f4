// Floats as integers in the same order, for sorting by digits.
#pragma once

#include <cstdint>
#include <cstring>

namespace boxwood::builders {

/// Integers in the order of the floats; both zeros are one.
inline std::uint32_t ordered_bits(float x) {
  x += 0.0f;
  std::uint32_t bits;
  std::memcpy(&bits, &x, 4);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/// The float of its ordered_bits.
inline float from_ordered_bits(std::uint32_t ordered) {
  const std::uint32_t bits = ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered;
  float x;
  std::memcpy(&x, &bits, 4);
  return x;
}

}  // namespace boxwood::builders
