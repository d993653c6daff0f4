// HLBVH (Pantaleoni and Luebke 2010, bib key hlbvh; Pharr, Jakob and Humphreys 2016, bib key pbrt, section 4.3.3):
// references that share the first bits of their Morton codes become treelets, made like an LBVH; the surface area
// heuristic divides the treelets. Differs from PBRT's version in its 63-bit codes, its leaves (parts/emit_morton.cpp),
// the default size of the treelets and how they are divided (parts/emit_treelets.cpp). O(n log n), deterministic.
#include <algorithm>

#include "builders/builder_list.h"
#include "builders/parts/bins.h"
#include "builders/parts/build_monitor.h"
#include "builders/parts/emit_morton.h"
#include "builders/parts/emit_treelets.h"
#include "builders/parts/merged_runs.h"
#include "builders/parts/morton_options.h"
#include "builders/parts/morton_order.h"

namespace boxwood::builders {
namespace {

constexpr const char* kAxes[] = {"all", "longest"};

constexpr OptionSpec kOptions[] = {
    kMortonBitsOption,
    {.key = "treelet.bits",
     .description = "references that share so many first bits of their codes form a treelet (PBRT 12)",
     .default_value = 15,
     .lowest = 1,
     .highest = 30,
     .integer = true},
    {.key = "bins",
     .description = "bins per axis for dividing treelets (PBRT 12)",
     .default_value = 12,
     .lowest = 2,
     .highest = kMostBins,
     .integer = true},
    {.key = "axes",
     .description = "axes binned for dividing treelets: all, or the one along which centroids spread most (PBRT)",
     .choices = kAxes},
    kMortonLeafMaxOption,
    kMergeMostOption,
    kMergeGrowthOption,
    kMergeLeastOption};

/// Ranges of equal first bits. Their ends are searched for in strides that double, then by bisection.
LargeVector<MortonRange> treelet_ranges(std::span<const KeyedIndex> order, int shift) {
  LargeVector<MortonRange> ranges;
  const std::size_t count = order.size();
  for (std::size_t first = 0, last; first < count; first = last) {
    const std::uint64_t bits = order[first].key >> shift;
    std::size_t stride = 1;
    while (stride < count - first && order[first + stride].key >> shift == bits) stride *= 2;
    const auto stretch = order.subspan(first + stride / 2, std::min(count, first + stride) - (first + stride / 2));
    last = std::size_t(std::partition_point(stretch.begin(), stretch.end(),
                                            [&](const KeyedIndex& i) { return i.key >> shift == bits; }) -
                       order.begin());
    ranges.push_back({std::uint32_t(first), std::uint32_t(last)});
  }
  return ranges;
}

Result<tree::BinaryTree> build_hlbvh(refs::ReferenceSet&& set, const OptionValues& options,
                                     const BuildContext& context) {
  BuildMonitor monitor(context, 4);
  const int axis_bits = bits_per_axis(options);
  auto order = morton_order(set.references.span(), axis_bits, context.executor);
  monitor.finish(2);
  if (monitor.cancelled()) return cancelled_error();

  MortonEmitter emitter(order.span(), set.references.span(), leaves(options), context.cancel);
  const auto ranges = treelet_ranges(order.span(), 3 * axis_bits - int(options.integer("treelet.bits")));
  LargeVector<tree::TopNode> top(1);
  const auto treelets = emitter.emit(ranges, top, context.executor);
  if (monitor.cancelled()) return cancelled_error();
  const auto root = join_treelets(treelets, options, context, top);
  if (!root) return cancelled_error();
  monitor.finish(1);

  order = {};  // not needed any more, and the tree needs the memory
  set.references = {};
  auto tree = tree::join_pieces(top, *root, emitter.primitives(), set.primitive_count, context.executor);
  monitor.finish(1);
  return tree;
}

}  // namespace

constinit const BuilderInfo hlbvh_builder = {
    .id = "hlbvh",
    .name = "HLBVH",
    .summary = "Morton treelets below a binned SAH tree; best for fast builds that still trace well",
    .paper = "hlbvh, pbrt",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = build_hlbvh};

}  // namespace boxwood::builders
