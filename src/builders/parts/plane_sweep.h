// Sweeps of planes over references that may be cut: every side of every box on every axis is tried.
#pragma once

#include <span>

#include "boxwood/parallel.h"
#include "boxwood/refs.h"
#include "builders/parts/plane_split.h"

namespace boxwood::builders {

/// What a plane's sides are priced by.
enum class SideAreas {
  region,   ///< the two parts of the region, as KD trees do
  tight,    ///< the boxes of what lies on each side, cut references with their parts
  between,  ///< tight, and planes between two box sides where the cost may be lower still
};

/// What to sweep over.
struct SweepInput {
  std::span<const refs::Reference> references;
  const refs::Primitives& primitives;
  Box region;               ///< what is parted; holds all references
  float area_scale = 1;     ///< lengths are multiplied by it before areas are made of them
  std::uint64_t spare = 0;  ///< references that a split may add
  SideAreas areas = SideAreas::region;
  /// Below 1: planes with nothing on one side count too (inside the region only), their cost times this.
  double empty_factor = 1;
};

struct SweepResult {
  PlaneSplit best;
  bool overrun = false;  ///< a cheaper plane was not taken because it would have added too many references
};

/// The cheapest plane. Ties: the lowest axis, then the lowest position, then flat boxes to the left.
SweepResult sweep_planes(const SweepInput& input, Executor& executor);

}  // namespace boxwood::builders
