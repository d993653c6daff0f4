// From an instruction set to what Highway has compiled for it.
#pragma once

#include "base/simd_targets.h"
// simd_targets.h first: it sets which targets Highway's headers see.
#include <hwy/targets.h>

#include <cstddef>
#include <cstdint>

namespace boxwood {

/// Place of a target in the tables HWY_EXPORT makes. A dispatcher of our own, so that forcing an instruction set
/// changes nothing for other users of Highway in the process.
inline std::size_t dispatch_index(std::int64_t target) {
  hwy::ChosenTarget chosen;
  chosen.Update(target);
  return chosen.GetIndex();
}

}  // namespace boxwood
