// How many references a builder that splits may add: each range has a share of the whole, so that what is built does
// not depend on the order in which ranges are worked on.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "boxwood/builders.h"
#include "builders/parts/option_specs.h"

namespace boxwood::builders {

/// The key of the option that every builder that splits has.
inline constexpr const char* kGrowth = "growth";

constexpr OptionSpec growth_option(double default_value) {
  return {.key = kGrowth,
          .description = "most references of the tree, as a multiple of those it is built over (Popov et al. 2009)",
          .default_value = default_value,
          .lowest = 1,
          .highest = 64};
}

/// References that may be added to `count` ones under a growth limit.
inline std::uint64_t spare_references(std::uint64_t count, double growth) {
  const double spare = std::floor((growth - 1) * static_cast<double>(count));
  return std::min(static_cast<std::uint64_t>(spare), kMostReferences - std::min(count, kMostReferences));
}

/// What both sides of a split may add, when `spare` could be added before it to `before` references. They get parts of
/// what is left in proportion to their weights (not negative), of which their numbers of references are the plainest.
/// `left + right - before` must not be above `spare`.
struct SpareShares {
  std::uint64_t left, right;
};
inline SpareShares share_rest(std::uint64_t spare, std::uint64_t before, std::uint64_t left, std::uint64_t right,
                              double left_weight, double right_weight) {
  const std::uint64_t rest = spare - std::min(spare, left + right - std::min(before, left + right));
  if (!(left_weight + right_weight > 0)) left_weight = right_weight = 1;
  const double left_share = left_weight / (left_weight + right_weight);
  const auto to_left = std::min(rest, static_cast<std::uint64_t>(static_cast<double>(rest) * left_share));
  return {to_left, rest - to_left};
}
inline SpareShares share_rest(std::uint64_t spare, std::uint64_t before, std::uint64_t left, std::uint64_t right) {
  return share_rest(spare, before, left, right, static_cast<double>(left), static_cast<double>(right));
}

}  // namespace boxwood::builders
