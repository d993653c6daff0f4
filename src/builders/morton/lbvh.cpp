// LBVH, the linear bounding volume hierarchy (Lauterbach, Garland, Sengupta, Luebke and Manocha 2009, bib key lbvh):
// sort by the Morton codes of the centroids and read the tree off the codes' bits. The radix tree comes from the sorted
// codes directly (Karras 2012, bib key karras2012). Differs from the papers in its leaves and in how the work is cut:
// see parts/emit_morton.cpp. O(n log n) with a small factor, deterministic.
#include "builders/builder_list.h"
#include "builders/parts/build_monitor.h"
#include "builders/parts/emit_morton.h"
#include "builders/parts/merged_runs.h"
#include "builders/parts/morton_options.h"
#include "builders/parts/morton_order.h"

namespace boxwood::builders {
namespace {

constexpr OptionSpec kOptions[] = {kMortonBitsOption, kMortonLeafMaxOption, kMergeMostOption, kMergeGrowthOption,
                                   kMergeLeastOption};

Result<tree::BinaryTree> build_lbvh(refs::ReferenceSet&& set, const OptionValues& options,
                                    const BuildContext& context) {
  const auto count = std::uint32_t(set.references.size());
  BuildMonitor monitor(context, 4);
  auto order = morton_order(set.references.span(), bits_per_axis(options), context.executor);
  monitor.finish(2);
  if (monitor.cancelled()) return cancelled_error();

  MortonEmitter emitter(order.span(), set.references.span(), leaves(options), context.cancel);
  const MortonRange all{0, count};
  LargeVector<tree::TopNode> top(1);
  const std::uint32_t root = emitter.emit({&all, 1}, top, context.executor)[0];
  monitor.finish(1);
  if (monitor.cancelled()) return cancelled_error();

  order = {};  // not needed any more, and the tree needs the memory
  set.references = {};
  auto tree = tree::join_pieces(top, root, emitter.primitives(), set.primitive_count, context.executor);
  monitor.finish(1);
  return tree;
}

}  // namespace

constinit const BuilderInfo lbvh_builder = {
    .id = "lbvh",
    .name = "LBVH",
    .summary = "splits along the bits of Morton codes; best for rebuilding every frame, when traversal matters less",
    .paper = "lbvh, karras2012",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = build_lbvh};

}  // namespace boxwood::builders
