// How large the inputs of tests over all builders are.
#pragma once

#include <algorithm>
#include <string_view>

#include "boxwood/builders.h"
#include "support/effort.h"

namespace boxwood::testing {

/// `wanted` boxes, but for builders that say they are slower than n log n only `few`. These work in parallel on ranges
/// of more than 4096 references already (kLargeSearch), the quick ones on more than 16384 (kLargeRange). Under a
/// sanitizer there are hardly more than that.
inline std::size_t box_count(const builders::BuilderInfo& info, std::size_t wanted, std::size_t few) {
  if (test::kInstrumented) {
    wanted = std::min<std::size_t>(wanted, 20000);
    few = std::min<std::size_t>(few, 4500);
  }
  const std::string_view cost_class = info.cost_class;
  return cost_class == "O(n)" || cost_class == "O(n log n)" ? wanted : few;
}

}  // namespace boxwood::testing
