// Median splits: an equal number of references on both sides of the median centroid on the widest axis, down to single
// references. The "EqualCounts" method of Pharr, Jakob and Humphreys (pbrt). Ours differs for coinciding centroids:
// pbrt makes one leaf of any size, we halve such ranges by index down to `leaf.max` (0 gives pbrt's leaf).
// O(n log n), ceil(log2(n)) levels; parallel over subtrees; the same bits for every number of threads.
#include "builders/builder_list.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/plane_builder.h"

namespace boxwood::builders {
namespace {

class EqualCountsFinder : public PlaneFinder {
 public:
  using PlaneFinder::PlaneFinder;

  RangeSplit find(const BuildRange& range, Executor&) const {
    return stops(range) ? RangeSplit() : ranges().median(range);
  }
};

constexpr OptionSpec kOptions[] = {leaf_max_option(
    1, "most references in a leaf; 0: single references, and one leaf of any size where centroids coincide (pbrt)")};

}  // namespace

constinit const BuilderInfo equal_counts_builder = {
    .id = "equal-counts",
    .name = "Equal counts",
    .summary = "halves the references at the median centroid; best for the shallowest trees",
    .paper = "pbrt",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_planes<EqualCountsFinder>,
};

}  // namespace boxwood::builders
