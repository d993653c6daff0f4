// Smooth random relief: gradient noise (Perlin 2002's fade and edge gradients on a hashed lattice) and sums of octaves.
#pragma once

#include <cstdint>

#include "boxwood/math.h"

namespace boxwood::mesh::procedural {

/// About -1 to 1, zero at integer coordinates; |p| below 2^30.
float gradient_noise(Vec3 p, std::uint32_t seed);

/// Sum of `octaves` noises, each of double frequency and half amplitude.
float fractal_noise(Vec3 p, int octaves, std::uint32_t seed);

}  // namespace boxwood::mesh::procedural
