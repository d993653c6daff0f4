// Random numbers for scenes: a permuted congruential generator (PCG-XSH-RR, O'Neill 2014), the same on every machine.
#pragma once

#include <cstdint>

#include "boxwood/math.h"

namespace boxwood::mesh::procedural {

class Random {
 public:
  /// Each (seed, stream) gives an own sequence, so that each tree or building can have its own.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint32_t bits();
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(std::uint64_t(bits()) * n >> 32); }
  float uniform() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }  ///< [0, 1)
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  Vec3 in_ball();    ///< uniform in the unit ball
  Vec3 direction();  ///< uniform on the unit sphere

 private:
  std::uint64_t state_, increment_;
};

}  // namespace boxwood::mesh::procedural
