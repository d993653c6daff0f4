// A colour for a number, hue and lightness from a hash of it.
#pragma once

#include "render/color.h"
#include "render/sampling.h"

namespace boxwood::render {

inline Color id_color(std::uint32_t number) {
  constexpr std::uint64_t kSeed = 1;
  const Sample2 sample = random_pair(kSeed, number, 0);
  return from_oklch(0.55 + 0.3 * sample.y, 0.12, 360 * sample.x);
}

}  // namespace boxwood::render
