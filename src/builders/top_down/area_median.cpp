// Area median: halve not the number of references but their surface, along the widest axis of the centroids' box. Rays
// meet boxes in proportion to their surface, so both sides get the same share of what rays may hit: large triangles
// come to the top of the tree, where the plain median (equal-counts) lets them drift down among small ones. A cheap
// relative of the surface area heuristic (MacDonald and Booth 1990), which looks at the areas of the references alone
// and never at those of the sides. Ours; no paper. Boxes are summed in 64 bins, the plane nearest to half of the sum
// is taken; where all falls on one side the median of counts takes over. O(n log n) on ordinary meshes, at most 96
// levels before medians take over; parallel; sums are made in fixed chunks and joined in order, so the same bits come
// out for every number of threads.
#include <algorithm>
#include <array>
#include <cmath>

#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/plane_builder.h"

namespace boxwood::builders {
namespace {

constexpr std::size_t kBins = 64;
using AreaBins = std::array<double, kBins>;

class AreaMedianFinder : public PlaneFinder {
 public:
  AreaMedianFinder(ReferenceRanges& ranges, const BuildRange& root, const OptionValues& options)
      : PlaneFinder(ranges, root, options), area_scale_(area_scale(root.bounds.box())) {}

  RangeSplit find(const BuildRange& range, Executor& executor) const {
    if (stops(range)) return RangeSplit();
    const Box centroids = range.centroids2.box();
    RangeSplit split;
    split.kind = RangeSplit::Kind::plane;
    split.axis = centroids.widest_axis();
    split.origin = centroids.lower[split.axis];
    split.scale = static_cast<float>(kBins) / centroids.extent()[split.axis];
    if (!std::isfinite(split.scale)) return ranges().median(range);
    const AreaBins bins = sum(range, split, executor);
    double all = 0;
    for (const double area : bins) all += area;
    // References without an area (points and lines) count nothing; where all are such there is no half of it.
    if (!(all > 0)) return ranges().median(range);
    split.threshold = static_cast<float>(plane_nearest_to_half(bins, all));
    ranges().count(range, split, executor);
    const bool one_sided = split.mid == range.first || split.mid == range.last;
    return one_sided ? ranges().median(range) : split;
  }

 private:
  AreaBins sum(const BuildRange& range, const RangeSplit& split, Executor& executor) const {
    if (range.size() <= kLargeRange) return sum_part(range, split, 0, range.size());
    std::vector<AreaBins> parts((range.size() + kChunk - 1) / kChunk);
    executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      parts[chunk] = sum_part(range, split, begin, end);
    });
    AreaBins bins{};
    for (const AreaBins& part : parts)
      for (std::size_t bin = 0; bin < kBins; ++bin) bins[bin] += part[bin];
    return bins;
  }

  AreaBins sum_part(const BuildRange& range, const RangeSplit& split, std::size_t begin, std::size_t end) const {
    const refs::Reference* const references = ranges().references(range);
    AreaBins bins{};
    for (std::size_t i = begin; i < end; ++i) {
      const float place = (references[i].centroid2(split.axis) - split.origin) * split.scale;
      const auto bin = static_cast<std::size_t>(std::max(place, 0.0f));
      bins[std::min(bin, kBins - 1)] += scaled_half_area(references[i].box(), area_scale_);
    }
    return bins;
  }

  /// The bin before which the sum comes nearest to half; the first of equals, never the ends.
  static std::size_t plane_nearest_to_half(const AreaBins& bins, double all) {
    std::size_t best = 1;
    double below = 0, best_distance = all;
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      below += bins[bin - 1];
      const double distance = std::fabs(2 * below - all);
      if (distance < best_distance) best = bin, best_distance = distance;
    }
    return best;
  }

  float area_scale_;
};

constexpr OptionSpec kOptions[] = {leaf_max_option(
    2, "most references in a leaf; 0: single references, and one leaf of any size where centroids coincide")};

}  // namespace

constinit const BuilderInfo area_median_builder = {
    .id = "area-median",
    .name = "Area median",
    .summary = "halves the references' summed surface on the widest axis; best for a sturdy tree without a cost model",
    .paper = "macdonald1990",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_planes<AreaMedianFinder>,
};

}  // namespace boxwood::builders
