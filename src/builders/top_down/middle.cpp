// Spatial median splits: halve the box of the centroids on its widest axis, down to single references. The "Middle"
// method of Pharr, Jakob and Humphreys (pbrt); the same split as the "recursive split" of Houghton and Spoerer (ebbvh).
// Where all centroids fall on one side (rounding) the median takes over, as in pbrt. Ours differs for coinciding
// centroids: pbrt makes one leaf of any size, we halve such ranges by index down to `leaf.max` (0 gives pbrt's leaf).
// `fallback=none` is the split of many tutorials instead: it cuts the node's box, not the centroids' box, and where one
// side stays empty it gives up and makes a leaf of any size. It is here to show what that costs: one floor as wide as the
// scene keeps its node's box that wide, and all that lies on its side of the middle becomes one leaf.
// O(n log n) on ordinary meshes, at most 96 levels before medians take over; parallel; the same bits for every number
// of threads.
#include "builders/builder_list.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/plane_builder.h"

namespace boxwood::builders {
namespace {

class MiddleFinder : public PlaneFinder {
 public:
  MiddleFinder(ReferenceRanges& ranges, const BuildRange& root, const OptionValues& options)
      : PlaneFinder(ranges, root, options), falls_back_(options.choice("fallback") == 0) {}

  RangeSplit find(const BuildRange& range, Executor& executor) const {
    if (stops(range)) return RangeSplit();
    Box centroids = range.centroids2.box();
    if (!falls_back_) centroids = {range.bounds.box().lower * 2.0f, range.bounds.box().upper * 2.0f};
    RangeSplit split;
    split.kind = RangeSplit::Kind::plane;
    split.axis = centroids.widest_axis();
    split.threshold = centroids.center()[split.axis];
    ranges().count(range, split, executor);
    const bool one_sided = split.mid == range.first || split.mid == range.last;
    if (!one_sided) return split;
    return falls_back_ ? ranges().median(range) : RangeSplit();
  }

 private:
  bool falls_back_;
};

constexpr const char* kFallbacks[] = {"median", "none"};

constexpr OptionSpec kOptions[] = {
    leaf_max_option(
        1, "most references in a leaf; 0: single references, and one leaf of any size where centroids coincide (pbrt)"),
    {.key = "fallback",
     .description = "where the middle parts nothing: median, or none: cut the node's box, make a leaf of what stays",
     .choices = kFallbacks}};

}  // namespace

constinit const BuilderInfo middle_builder = {
    .id = "middle",
    .name = "Spatial median",
    .summary = "halves the centroids' box on its widest axis; best for a quick baseline to compare others with",
    .paper = "pbrt, ebbvh",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_planes<MiddleFinder>,
};

}  // namespace boxwood::builders
