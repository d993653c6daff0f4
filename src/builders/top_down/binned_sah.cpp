// Binned surface area heuristic: the cheapest split between bins of centroids. Wald 2007 (bib key wald2007) with the
// cost of MacDonald and Booth 1990 (macdonald1990); with `axes` = longest and 12 bins near the SAH builder of Pharr,
// Jakob and Humphreys (pbrt). Ours bins all three axes by default, uses fewer bins for few references, asks every split
// to pay (pbrt always parts a pair) and falls back to medians, then index halves, where the heuristic has nothing to
// say. O(n log n), at most 96 levels before medians take over; parallel; the same bits for every number of threads.
#include "builders/builder_list.h"
#include "builders/parts/binned_finder.h"
#include "builders/parts/merged_runs.h"
#include "builders/parts/option_specs.h"

namespace boxwood::builders {
namespace {

constexpr const char* kAxes[] = {"all", "longest"};
constexpr std::size_t kAllAxes = 0;

class BinnedSah : public BinnedSahFinder {
 public:
  BinnedSah(ReferenceRanges& ranges, const BuildRange& root, const OptionValues& options)
      : BinnedSahFinder(ranges, root,
                        {options.cost(), options.integer(kLeafMax), static_cast<int>(options.integer("bins")),
                         options.choice("axes") == kAllAxes}) {}
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
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost"),
    kMergeMostOption,
    kMergeGrowthOption,
    kMergeLeastOption};

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
    .build = &build_with_planes<BinnedSah>,
};

}  // namespace boxwood::builders
