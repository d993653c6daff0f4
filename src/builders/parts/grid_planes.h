// Planes on which the sides of candidate boxes lie: those of a regular grid over the node (Popov et al. 2009, section
// 3.3), or the sides of all references.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/option_specs.h"

namespace boxwood::builders {

/// The keys of the options that every builder with a grid has.
inline constexpr const char* kGridFactor = "grid.k";
inline constexpr const char* kGridRule = "grid.rule";
inline constexpr const char* kGridRules[] = {"node", "text"};

constexpr OptionSpec grid_factor_option() {
  return {
      .key = kGridFactor,
      .description = "K_R, which sets the number of grid cells over the |S| references of a node (Popov et al. 2009)",
      .default_value = 64,
      .lowest = 1,
      .highest = 4096};
}
constexpr OptionSpec grid_rule_option() {
  return {.key = kGridRule,
          .description = "cells of the grid: node = sqrt(K_R |S|), the paper's tables; text = K_R sqrt(|S|), its text",
          .choices = kGridRules};
}

/// How many cells the grid over a node has.
struct GridRule {
  double factor = 64;
  bool factor_outside_root = false;

  explicit GridRule(const OptionValues& options)
      : factor(options.number(kGridFactor)), factor_outside_root(options.choice(kGridRule) == 1) {}
  double cells(std::size_t references) const;
};

/// Where the lower and the upper sides of candidate boxes may be, rising, by axis. The first lower and the last upper
/// plane are the node's own sides.
struct CandidatePlanes {
  std::vector<float> lower[3], upper[3];
  /// May a candidate box be flat on an axis on which the node is not?
  bool flat_boxes = false;
};

/// About `cells` cells, as near to cubes as they can be. Fewer where a CountingTable over them would be too large.
CandidatePlanes grid_planes(const Box& node, double cells);
/// Lower sides at lower sides of the references, upper ones at upper ones.
CandidatePlanes side_planes(std::span<const refs::Reference> references);

}  // namespace boxwood::builders
