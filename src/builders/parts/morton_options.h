// Options that the Morton builders share.
#pragma once

#include <array>

#include "builders/parts/emit_morton.h"
#include "builders/parts/option_specs.h"

namespace boxwood::builders {

inline constexpr std::array<const char*, 2> kMortonBits{"63", "30"};

inline constexpr OptionSpec kMortonBitsOption{
    .key = "bits",
    .description = "bits of a Morton code: 63 or 30, a third for each axis (Karras 2012)",
    .choices = kMortonBits};

inline constexpr OptionSpec kMortonLeafMaxOption = leaf_max_option(
    16, "most references in a leaf, made where it is no dearer than its subtree; 1 = one each, 0 = no limit");

inline int bits_per_axis(const OptionValues& options) {
  return options.choice("bits") == 0 ? 21 : 10;
}

inline MortonEmitter::Leaves leaves(const OptionValues& options) {
  return {options.integer(kLeafMax), options.cost()};
}

}  // namespace boxwood::builders
