// Options that several builders have, so that they mean the same everywhere.
#pragma once

#include "boxwood/builders.h"

namespace boxwood::builders {

/// The key every builder with a leaf limit uses.
inline constexpr const char* kLeafMax = "leaf.max";

/// No tree can have more references than its 32-bit numbers of up to 2 * n nodes can tell apart.
inline constexpr std::uint64_t kMostReferences = (1ull << 31) - 1;

constexpr OptionSpec leaf_max_option(double default_value, const char* description) {
  return {.key = kLeafMax,
          .description = description,
          .default_value = default_value,
          .lowest = 0,
          .highest = 1 << 24,
          .integer = true};
}

}  // namespace boxwood::builders
