// Binned surface area heuristic over treelets (Pantaleoni and Luebke 2010, bib key hlbvh, section 3.2; Pharr, Jakob and
// Humphreys 2016, bib key pbrt, section 4.3.3). Each treelet weighs one, as there, whatever it holds: weighing it by
// its references made the tree 2 % better on one scene and 5 to 6 % worse on three others. Unlike there, all three axes
// can be binned, and treelets that bins can't tell apart, or that have no area, are halved. There is no choice between
// a split and a leaf up here, so the price of a visit (PBRT adds 0.125 to each split) would change nothing and is left
// out.
//
// To the driver of the top-down builders, treelets are references like any others: a box and a number.
// O(t log t) for t treelets, deterministic.
#include "builders/parts/emit_treelets.h"

#include "builders/parts/binned_finder.h"

namespace boxwood::builders {
namespace {

/// Ranges of so many treelets are worth a task: each holds many references, yet all is waiting for their tree.
constexpr std::size_t kTreeletTask = 1 << 8;

/// Treelets are never put together in a leaf.
BinnedSahFinder::Settings settings(const OptionValues& options) {
  return {.cost = {},
          .leaf_max = 1,
          .bins = static_cast<int>(options.integer("bins")),
          .all_axes = options.choice("axes") == 0};
}

refs::ReferenceSet as_references(std::span<const std::uint32_t> treelets, std::span<const tree::TopNode> top) {
  refs::ReferenceSet set;
  set.references = AlignedBuffer<refs::Reference>(treelets.size());
  set.primitive_count = treelets.size();
  for (std::size_t t = 0; t < treelets.size(); ++t) {
    const Box& box = top[treelets[t]].root.bounds;
    set.references[t] = {box.lower, std::uint32_t(t), box.upper, 0};
    set.bounds.grow(box);
  }
  return set;
}

}  // namespace

std::optional<std::uint32_t> join_treelets(std::span<const std::uint32_t> treelets, const OptionValues& options,
                                           const BuildContext& context, LargeVector<tree::TopNode>& top) {
  const BuildContext quiet{context.executor, {}, context.cancel};
  ReferenceRanges references(as_references(treelets, top));
  const BuildRange whole = references.root(context.executor);
  BinnedSahFinder finder(references, whole, settings(options));
  TopDownDriver<BinnedSahFinder> driver(finder, treelets.size(), quiet, {.task_range = kTreeletTask});
  if (!driver.run(whole)) return {};

  const tree::BinaryTree tree = driver.pieces().join(treelets.size(), context.executor);
  const auto nodes = tree.nodes.span();
  const auto number = [&](const tree::Node& node) {
    if (node.is_leaf()) return treelets[tree.references[node.first]];
    top.push_back({.root = node});
    return std::uint32_t(top.size() - 1);
  };
  std::vector<std::uint32_t> open;
  const auto follow = [&](const tree::Node& node) {
    const std::uint32_t n = number(node);
    if (!node.is_leaf()) open.push_back(n);
    return n;
  };
  const std::uint32_t root = follow(nodes[0]);
  while (!open.empty()) {
    const std::uint32_t n = open.back();
    open.pop_back();
    const std::uint32_t pair = top[n].root.first;
    const std::uint32_t left = follow(nodes[pair]), right = follow(nodes[pair + 1]);
    top[n].left = left;
    top[n].right = right;
  }
  return root;
}

}  // namespace boxwood::builders
