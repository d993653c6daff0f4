// Binned surface area heuristic: the cheapest split between bins of centroids. Wald 2007 (bib key wald2007) with the
// cost of MacDonald and Booth 1990 (macdonald1990); with `axes` = longest and 12 bins near the SAH builder of Pharr,
// Jakob and Humphreys (pbrt). Ours bins all three axes by default, uses fewer bins for few references, asks every split
// to pay (pbrt always parts a pair) and falls back to medians, then index halves, where the heuristic has nothing to
// say. O(n log n), at most 96 levels before medians take over; parallel; the same bits for every number of threads.
#include <cmath>
#include <memory>

#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/bins.h"
#include "builders/parts/leaf_rule.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/plane_builder.h"

namespace boxwood::builders {
namespace {

constexpr const char* kAxes[] = {"all", "longest"};
constexpr std::size_t kAllAxes = 0;

class BinnedSahFinder : public PlaneFinder {
 public:
  BinnedSahFinder(ReferenceRanges& ranges, const BuildRange& root, const OptionValues& options)
      : PlaneFinder(ranges, root, options),
        leaf_rule_(options.cost(), options.integer(kLeafMax)),
        area_scale_(area_scale(root.bounds.box())),
        bins_(static_cast<int>(options.integer("bins"))),
        all_axes_(options.choice("axes") == kAllAxes) {}

  RangeSplit find(const BuildRange& range, Executor& executor) const {
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

 private:
  int bins_for(std::uint32_t references) const { return std::min<std::uint32_t>(bins_, 4 + references / 4); }

  /// Pairs are frequent and have one split only: what the bins would say, without filling them.
  BinSplit part_pair(const BuildRange& range, const BinGrid& grid) const {
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

  BinSplit bin(const BuildRange& range, const BinGrid& grid) const {
    if (range.size() == 2) return part_pair(range, grid);
    Bins bins(grid.count);
    bins.add(grid, ranges().references(range), range.size());
    return bins.best_split(grid, area_scale_);
  }

  /// The same in parallel; also leaves behind how many references of each chunk go left.
  BinSplit bin_in_chunks(const BuildRange& range, const BinGrid& grid, Executor& executor, RangeSplit& split) const {
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

  LeafRule leaf_rule_;
  float area_scale_;
  int bins_;
  bool all_axes_;
};

constexpr OptionSpec kOptions[] = {
    {.key = "bins",
     .description = "bins per axis; fewer are used for few references (pbrt 12, the ebbvh baseline 8)",
     .default_value = 16,
     .lowest = 2,
     .highest = kMostBins,
     .integer = true},
    {.key = "axes",
     .description = "which axes to look for splits on: all, or the one on which centroids spread widest (pbrt)",
     .choices = kAxes},
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost")};

}  // namespace

constinit const BuilderInfo binned_sah_builder = {
    .id = "binned-sah",
    .name = "Binned SAH",
    .summary = "cheapest split between bins of centroids; best for most uses: fast to build and good to trace",
    .paper = "wald2007, pbrt",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_planes<BinnedSahFinder>,
};

}  // namespace boxwood::builders
