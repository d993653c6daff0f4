// Random numbers by counter and the directions made of them.
//
// random_pair: a counter-based generator (the idea of Salmon et al. 2011, salmon2011parallel): number `index` of stream
// `seed` is a hash of both, so any of them can be made alone and on any thread. The hash chains the 64-bit finalizer of
// Steele, Lea and Flood's SplitMix (2014, steele2014fast) over seed, index and dimension.
// Directions: the concentric map of Shirley and Chiu (1997, shirley1997low) from square to disc, then the equal-area
// lift to the sphere, or the lift to the hemisphere that makes it cosine-distributed (Malley's method). They use
// nothing but arithmetic and square roots, both rounded exactly by IEEE 754, so they give the same bits on every
// machine.
#pragma once

#include <cstdint>

#include "boxwood/math.h"
#include "render/vector.h"

namespace boxwood::render {

/// A point of the open unit square.
struct Sample2 {
  double x = 0, y = 0;
};

std::uint64_t random_bits(std::uint64_t seed, std::uint64_t index, std::uint64_t dimension);
/// Two independent uniform numbers, each in (0, 1) with 32 bits.
Sample2 random_pair(std::uint64_t seed, std::uint64_t index, std::uint64_t dimension);

/// Unit vector, uniform on the sphere when the sample is uniform.
Vector sphere_direction(Sample2 sample);
/// Unit vector around the unit vector `normal`, with a density proportional to the cosine between them, which is never
/// zero.
Vector cosine_direction(Sample2 sample, Vector normal);

}  // namespace boxwood::render
