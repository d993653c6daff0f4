// Binned surface area heuristic: finding the split of one range.
#include "builders/parts/binned_finder.h"

#include <memory>

namespace boxwood::builders {

RangeSplit BinnedSahFinder::find(const BuildRange& range, Executor& executor) const {
  if (leaf_rule_.is_always_leaf(range.size())) return RangeSplit();
  const double area = scaled_half_area(range.bounds.box(), area_scale_);
  const int axis = all_axes_ ? -1 : range.centroids2.box().widest_axis();
  const BinGrid grid = BinGrid::over(range.centroids2, bins_for(range.size()), axis);
  RangeSplit split;
  if (!grid.any_usable() || !(area > 0)) {
    if (!leaf_rule_.may_be_leaf(range.size())) split = ranges().median(range);
    return split;
  }
  const BinSplit best = range.size() > kLargeRange ? bin_in_chunks(range, grid, executor, split) : bin(range, grid);
  if (leaf_rule_.prefers_leaf(range.size(), area, best.cost)) return split;
  if (best.axis < 0) return ranges().median(range);
  split.kind = RangeSplit::Kind::plane;
  split.axis = best.axis;
  alignas(16) float origin[4], scale[4];
  grid.origin.store(origin);
  grid.scale.store(scale);
  split.origin = origin[best.axis];
  split.scale = scale[best.axis];
  split.threshold = static_cast<float>(best.bin);
  split.mid = range.first + best.left_count;
  split.has_boxes = true;
  split.left = best.left;
  split.right = best.right;
  return split;
}

/// Pairs are frequent and have one split only: what the bins would say, without filling them.
BinSplit BinnedSahFinder::part_pair(const BuildRange& range, const BinGrid& grid) const {
  const refs::Reference* const pair = ranges().references(range);
  BinSplit split;
  split.axis = grid.usable[0] ? 0 : grid.usable[1] ? 1 : 2;
  split.bin = 1;
  split.left_count = 1;
  split.cost = scaled_half_area(pair[0].box(), area_scale_) + scaled_half_area(pair[1].box(), area_scale_);
  const bool in_order = pair[0].centroid2(split.axis) < pair[1].centroid2(split.axis);
  split.left = Box4::of(pair[!in_order]);
  split.right = Box4::of(pair[in_order]);
  return split;
}

BinSplit BinnedSahFinder::bin(const BuildRange& range, const BinGrid& grid) const {
  if (range.size() == 2) return part_pair(range, grid);
  Bins bins(grid.count);
  bins.add(grid, ranges().references(range), range.size());
  return bins.best_split(grid, area_scale_);
}

/// The same in parallel; also leaves behind how many references of each chunk go left.
BinSplit BinnedSahFinder::bin_in_chunks(const BuildRange& range, const BinGrid& grid, Executor& executor,
                                        RangeSplit& split) const {
  const refs::Reference* const references = ranges().references(range);
  std::vector<std::unique_ptr<Bins>> parts((range.size() + kChunk - 1) / kChunk);
  executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    parts[chunk] = std::make_unique<Bins>(grid.count);
    parts[chunk]->add(grid, references + begin, end - begin);
  });
  Bins total(grid.count);
  for (const auto& part : parts) total.add(*part);
  const BinSplit best = total.best_split(grid, area_scale_);
  if (best.axis >= 0)
    for (const auto& part : parts) split.left_per_chunk.push_back(part->count_below(best.axis, best.bin));
  return best;
}

}  // namespace boxwood::builders
