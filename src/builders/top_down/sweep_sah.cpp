// Full-sweep surface area heuristic: every split between two neighbouring centroids on every axis is priced. MacDonald
// and Booth 1990 (bib key macdonald1990); the baseline C-BVH of Popov, Georgiev, Dimov and Slusallek 2009 (popov2009).
// References are sorted once per axis (doubled centroids; ties by primitive, then by place in the input) and the three
// orders are kept by stable partition (Wald 2007, wald2007), so a level costs O(n) and the build O(n log n). Ours
// differs in the depth limit, past which the order of the widest axis is halved. Large ranges are swept and partitioned
// in fixed chunks: boxes are joined exactly, so the same bits come out for every number of threads.
#include "builders/builder_list.h"
#include "builders/parts/merged_runs.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/sweep.h"
#include "builders/parts/top_down.h"

namespace boxwood::builders {
namespace {

constexpr OptionSpec kOptions[] = {leaf_max_option(16, "most references in a leaf; 0: no limit but the cost"),
                                   kMergeMostOption, kMergeGrowthOption, kMergeLeastOption};

Result<tree::BinaryTree> build_sweep_sah(refs::ReferenceSet&& set, const OptionValues& options,
                                         const BuildContext& context) {
  const auto make_finder = [&](refs::ReferenceSet&& references) {
    return SweepFinder(std::move(references), LeafRule(options.cost(), options.integer(kLeafMax)), context.executor);
  };
  return build_top_down(std::move(set), context, make_finder);
}

}  // namespace

constinit const BuilderInfo sweep_sah_builder = {
    .id = "sweep-sah",
    .name = "Full-sweep SAH",
    .summary = "cheapest split between centroids of all axes; best for the fastest rays that whole references allow",
    .paper = "macdonald1990, popov2009",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_sweep_sah,
};

}  // namespace boxwood::builders
