// The split finder of the binned surface area heuristic: the cheapest split between bins of centroids (bins.h), in
// parallel where a range is large.
#pragma once

#include "builders/parts/area_scale.h"
#include "builders/parts/bins.h"
#include "builders/parts/leaf_rule.h"
#include "builders/parts/plane_builder.h"

namespace boxwood::builders {

class BinnedSahFinder : public PlaneFinder {
 public:
  struct Settings {
    tree::CostModel cost;
    std::uint32_t leaf_max = 0;  ///< 0: no limit but the cost
    int bins = 16;               ///< most bins per axis
    bool all_axes = true;        ///< false: only the axis on which the centroids spread widest
  };

  BinnedSahFinder(ReferenceRanges& ranges, const BuildRange& root, const Settings& settings)
      : PlaneFinder(ranges, settings.leaf_max),
        leaf_rule_(settings.cost, settings.leaf_max),
        area_scale_(area_scale(root.bounds.box())),
        bins_(settings.bins),
        all_axes_(settings.all_axes) {}

  RangeSplit find(const BuildRange& range, Executor& executor) const;
  /// What lengths are multiplied with before areas are made of them.
  float scale() const { return area_scale_; }

 private:
  int bins_for(std::uint32_t references) const { return std::min<std::uint32_t>(bins_, 4 + references / 4); }
  BinSplit part_pair(const BuildRange& range, const BinGrid& grid) const;
  BinSplit bin(const BuildRange& range, const BinGrid& grid) const;
  BinSplit bin_in_chunks(const BuildRange& range, const BinGrid& grid, Executor& executor, RangeSplit& split) const;

  LeafRule leaf_rule_;
  float area_scale_;
  int bins_;
  bool all_axes_;
};

}  // namespace boxwood::builders
