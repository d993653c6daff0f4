// EBBVH (Houghton and Spoerer, bib key ebbvh): triangles that share an edge merge in rounds, the edge with the
// largest box first; another builder joins the clusters that are left. Two rows of the registry: `ebbvh` is the paper,
// all rounds and a spatial median on top; `ebbvh-gated` stops while clusters are still compact and hands over to a
// surface area heuristic, which is better everywhere. Differs from the paper in what its listing leaves open or gets
// wrong (vertices are welded, edges sorted by both ends: mesh/edge_links.cpp), in the choice of the builder on top, and
// in the leaves, decided by the surface area heuristic once the tree is whole (parts/merge_forest.h). O(n log n),
// deterministic: the rounds have one result (parts/edge_clustering.cpp), and each root is one reference to the top.
#include <array>
#include <string>

#include "builders/builder_list.h"
#include "builders/parts/build_monitor.h"
#include "builders/parts/edge_clustering.h"
#include "builders/parts/merge_forest.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/pair_finder.h"
#include "builders/parts/top_down.h"

namespace boxwood::builders {
namespace {

constexpr std::array<const char*, 2> kWelds{"position", "index"};
constexpr std::array<const char*, 2> kSearches{"near", "all"};
constexpr std::size_t kMostTops = 64;
/// Rounds whose roots are noted one by one.
constexpr std::size_t kNotedRounds = 8;

/// Builders that can join clusters: those that take references as they are, and any number of them.
struct Tops {
  std::array<const char*, kMostTops> ids{};
  std::size_t count = 0;

  explicit Tops(const char* first) {
    add(first);
#define BOXWOOD_ADD_TOP(name) add_if_fit(name##_builder, first);
    BOXWOOD_BUILDER_LIST(BOXWOOD_ADD_TOP)
#undef BOXWOOD_ADD_TOP
  }
  std::span<const char* const> span() const {
    return {ids.data(), count};
  }

 private:
  void add(const char* id) {
    if (count < kMostTops) ids[count++] = id;
  }
  void add_if_fit(const BuilderInfo& info, const char* first) {
    const std::string_view id = info.id;
    if (id != first && !id.starts_with("ebbvh") && !info.splits_references && info.largest_sensible == kMostReferences)
      add(info.id);
  }
};

constexpr OptionSpec kWeldOption{
    .key = "weld",
    .description = "vertices are the same by position, or by index as the mesh has it (seams then divide clusters)",
    .choices = kWelds};
constexpr OptionSpec kSearchOption{
    .key = "search",
    .description =
        "where the one round below binned-sah looks for shared edges: near, among the six triangles that "
        "follow in the mesh, or all; more rounds and other tops take all",
    .choices = kSearches};
constexpr OptionSpec kPairCutoffOption{
    .key = "pair_cutoff",
    .description = "the first round that merges fewer pairs is the last one (Houghton and Spoerer)",
    .default_value = 1,
    .lowest = 1,
    .highest = 1e9,
    .integer = true};
constexpr OptionSpec kLeafMaxOption = leaf_max_option(
    16, "most references in a leaf, made where it is no dearer than its subtree; 1 = one each, 0 = any");

constexpr OptionSpec rounds_option(double rounds) {
  return {.key = "rounds",
          .description = "most rounds of merging over shared edges; 0 = until no edge joins two clusters",
          .default_value = rounds,
          .lowest = 0,
          .highest = 1e9,
          .integer = true};
}
constexpr OptionSpec gate_area_option(double factor) {
  return {.key = "gate.area",
          .description =
              "clusters merge only while the joined box's area is at most this many times both areas added; "
              "0 = always",
          .default_value = factor,
          .lowest = 0,
          .highest = 1e6};
}
constexpr OptionSpec gate_size_option(double size) {
  return {.key = "gate.size",
          .description = "most references of a cluster; 0 = any number",
          .default_value = size,
          .lowest = 0,
          .highest = double(kMostReferences),
          .integer = true};
}
OptionSpec top_option(const Tops& tops) {
  return {.key = "top", .description = "builder that joins the clusters that are left", .choices = tops.span()};
}

// The rows of other files are constants, so their ids are there when these are made, before main.
const Tops kTops("middle"), kGatedTops("binned-sah");
const std::array<OptionSpec, 7> kOptions{kWeldOption,         top_option(kTops),   rounds_option(0), kPairCutoffOption,
                                         gate_area_option(0), gate_size_option(0), kLeafMaxOption};
const std::array<OptionSpec, 8> kGatedOptions{kWeldOption,         kSearchOption,     top_option(kGatedTops),
                                              rounds_option(1),    kPairCutoffOption, gate_area_option(0.8),
                                              gate_size_option(0), kLeafMaxOption};

constexpr std::uint32_t kNone = kNoCluster;

/// Links between primitives become links between references: the first of each primitive.
void name_references(AlignedBuffer<ClusterLink>& links, const refs::ReferenceSet& set) {
  bool same = set.references.size() == set.primitive_count;
  for (std::size_t i = 0; same && i < set.references.size(); ++i) same = set.references[i].primitive == i;
  if (same) return;
  std::vector<std::uint32_t> reference_of(set.primitive_count, kNone);
  for (std::size_t i = set.references.size(); i-- > 0;) reference_of[set.references[i].primitive] = std::uint32_t(i);
  std::size_t kept = 0;
  for (const ClusterLink& link : links) {
    const ClusterLink named{reference_of[link.a], reference_of[link.b]};
    if (named.a != kNone && named.b != kNone) links[kept++] = named;
  }
  links.truncate(kept);
}

AlignedBuffer<ClusterLink> links_of(const refs::ReferenceSet& set, mesh::Weld weld, Executor& executor) {
  auto links = set.primitives->edge_links(weld, executor);
  name_references(links, set);
  return links;
}

refs::ReferenceSet as_references(std::span<const std::uint32_t> roots, const MergeForest& forest) {
  refs::ReferenceSet set;
  set.references = AlignedBuffer<refs::Reference>(roots.size());
  set.primitive_count = roots.size();
  set.bounds = forest.bounds();
  set.primitives = refs::box_primitives();
  for (std::size_t r = 0; r < roots.size(); ++r) {
    const Box& box = forest.box(roots[r]);
    set.references[r] = {box.lower, std::uint32_t(r), box.upper, 0};
  }
  return set;
}

/// Merges the roots as a tree over them says. The inner node of rank k (its children stand at 2 * k + 1 and 2 * k + 2)
/// makes merge number `merged` + k, and a subtree's inner nodes have consecutive ranks: subtrees merge in parallel.
class TopMerger {
 public:
  TopMerger(const tree::BinaryTree& top, std::span<const std::uint32_t> roots, std::uint32_t merged,
            MergeForest& forest)
      : nodes_(top.nodes.span()), merged_(merged), forest_(forest), cluster_(top.nodes.size()) {
    std::uint32_t next = merged + std::uint32_t(nodes_.size() / 2);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (!nodes_[n].is_leaf()) continue;
      cluster_[n] = roots[top.references[nodes_[n].first]];
      // Tops without a limit on leaves may put several roots into one.
      for (std::uint32_t r = 1; r < nodes_[n].count; ++r)
        cluster_[n] = forest_.merge(next++, cluster_[n], roots[top.references[nodes_[n].first + r]]);
    }
  }

  /// The cluster that holds all.
  std::uint32_t run(Executor& executor) {
    std::vector<Subtree> upper, tasks, open;
    if (!nodes_[0].is_leaf()) open.push_back({0, std::uint32_t(nodes_.size() / 2)});
    while (!open.empty()) {
      const Subtree subtree = open.back();
      open.pop_back();
      (subtree.inner <= kTaskSize ? tasks : upper).push_back(subtree);
      if (subtree.inner <= kTaskSize) continue;
      const std::uint32_t left = nodes_[subtree.node].first, right = left + 1;
      const std::uint32_t below = subtree.inner - 1;
      const std::uint32_t in_left = nodes_[left].is_leaf()    ? 0
                                    : nodes_[right].is_leaf() ? below
                                                              : rank(right) - rank(left);
      if (in_left != 0) open.push_back({left, in_left});
      if (in_left != below) open.push_back({right, below - in_left});
    }
    executor.for_chunks(tasks.size(), 1, [&](std::size_t t, std::size_t, std::size_t) {
      const std::uint32_t first = rank(tasks[t].node);
      for (std::uint32_t n = 2 * (first + tasks[t].inner); n > 2 * first; --n)  // children stand after their parents
        if (!nodes_[n].is_leaf()) merge(n);
      merge(tasks[t].node);
    });
    for (std::size_t u = upper.size(); u-- > 0;) merge(upper[u].node);
    return cluster_[0];
  }

 private:
  static constexpr std::uint32_t kTaskSize = 4096;
  struct Subtree {
    std::uint32_t node, inner;  ///< its root and how many inner nodes it has
  };

  std::uint32_t rank(std::uint32_t node) const { return (nodes_[node].first - 1) / 2; }
  void merge(std::uint32_t node) {
    const std::uint32_t first = nodes_[node].first;
    cluster_[node] = forest_.merge(merged_ + rank(node), cluster_[first], cluster_[first + 1]);
  }

  std::span<const tree::Node> nodes_;
  std::uint32_t merged_;
  MergeForest& forest_;
  std::vector<std::uint32_t> cluster_;  ///< of each node
};

/// The build's prices and one root to a leaf: the forest decides on leaves. (Letting the top stop at leaves of several
/// roots, with prices in roots, changed neither the cost nor the time below a surface area heuristic.)
BuildOptions top_options(const OptionValues& options, const char* top) {
  BuildOptions result{.builder = top};
  for (const auto& [key, value] : options.echo())
    if (key.starts_with("cost.")) result.settings[key] = value;
  for (const OptionSpec& spec : find(top)->options)
    if (std::string_view(spec.key) == kLeafMax) result.settings[kLeafMax] = "1";
  return result;
}

Result<std::uint32_t> join_roots(const EdgeClustering& clustering, const OptionValues& options, const char* top,
                                 MergeForest& forest, const BuildContext& context) {
  const std::vector<std::uint32_t> roots = clustering.roots();
  if (roots.size() == 1) return roots[0];
  const auto tree = build(as_references(roots, forest), top_options(options, top),
                          BuildContext{context.executor, {}, context.cancel});
  if (!tree)
    return Error{tree.error().code, "option 'top', builder '" + std::string(top) + "': " + tree.error().message};
  return TopMerger(*tree, roots, clustering.merged(), forest).run(context.executor);
}

void add_notes(const EdgeClustering& clustering, std::uint32_t references, tree::BinaryTree& tree) {
  const std::vector<std::uint32_t>& pairs = clustering.pairs_by_round();
  if (!pairs.empty()) tree.notes.emplace_back("pairs of round 1", pairs[0]);
  std::uint32_t roots = references;
  for (std::size_t round = 0; round < pairs.size(); ++round) {
    roots -= pairs[round];
    if (round < kNotedRounds) tree.notes.emplace_back("roots after round " + std::to_string(round + 1), roots);
  }
  tree.notes.emplace_back("rounds", double(pairs.size()));
  tree.notes.emplace_back("roots", roots);
}

Result<tree::BinaryTree> build_with_top(refs::ReferenceSet&& set, const OptionValues& options, const char* top,
                                        const BuildContext& context) {
  BuildMonitor monitor(context, 4);
  const auto weld = static_cast<mesh::Weld>(options.choice("weld"));
  auto links = links_of(set, weld, context.executor);
  monitor.finish(1);
  if (monitor.cancelled()) return cancelled_error();

  const auto count = std::uint32_t(set.references.size());
  MergeForest forest(set.references.span(), {}, options.cost(), options.integer(kLeafMax), context.executor);
  set.references = {};
  EdgeClustering clustering(forest, std::move(links), {options.number("gate.area"), options.integer("gate.size")}, {},
                            context.executor);
  if (!clustering.run({options.integer("rounds"), options.integer("pair_cutoff")}, monitor)) return cancelled_error();
  monitor.finish(1);

  const auto root = join_roots(clustering, options, top, forest, context);
  if (!root) return root.error();
  monitor.finish(1);
  auto tree = forest.tree(*root, set.primitive_count, context.executor);
  add_notes(clustering, count, tree);
  monitor.finish(1);
  return tree;
}

Result<tree::BinaryTree> build_ebbvh(refs::ReferenceSet&& set, const OptionValues& options,
                                     const BuildContext& context) {
  return build_with_top(std::move(set), options, kTops.ids[options.choice("top")], context);
}

/// One round below a binned surface area heuristic: pairs need no order, no clusters and no tree of their own.
Result<tree::BinaryTree> build_over_pairs(refs::ReferenceSet&& set, const OptionValues& options,
                                          const BuildContext& context) {
  const auto weld = static_cast<mesh::Weld>(options.choice("weld"));
  const std::size_t count = set.references.size();
  const auto search = static_cast<PairSearch>(options.choice("search"));
  EdgePairs pairs = pair_references(set, search, weld, options.number("gate.area"), context.executor);
  const std::size_t roots = pairs.pairs.size();
  TreePieces pieces;
  {
    ReferenceRanges ranges(std::move(pairs.set));
    const BuildRange root = ranges.root(context.executor);
    PairFinder finder(ranges, root, pairs, set.references.span(), options.cost(), options.integer(kLeafMax));
    TopDownDriver<PairFinder> driver(finder, roots, context, {.parts = 2});
    if (!driver.run(root)) return cancelled_error();
    pieces = std::move(driver.pieces());
  }
  set.references = {};
  tree::BinaryTree tree = pieces.join(set.primitive_count, context.executor);
  tree.notes = {{"pairs of round 1", double(count - roots)},
                {"roots after round 1", double(roots)},
                {"rounds", 1},
                {"roots", double(roots)}};
  return tree;
}

Result<tree::BinaryTree> build_ebbvh_gated(refs::ReferenceSet&& set, const OptionValues& options,
                                           const BuildContext& context) {
  if (options.integer("rounds") == 1 && options.choice("top") == 0 && options.integer("gate.size") != 1)
    return build_over_pairs(std::move(set), options, context);
  return build_with_top(std::move(set), options, kGatedTops.ids[options.choice("top")], context);
}

}  // namespace

constinit const BuilderInfo ebbvh_builder = {
    .id = "ebbvh",
    .name = "EBBVH",
    .summary = "merges triangles over shared edges, bottom-up, as published; best for comparing with the paper",
    .paper = "ebbvh",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = build_ebbvh};

constinit const BuilderInfo ebbvh_gated_builder = {
    .id = "ebbvh-gated",
    .name = "Gated EBBVH",
    .summary = "pairs triangles over shared edges below a binned SAH tree; best for meshes of connected triangles",
    .paper = "ebbvh",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kGatedOptions,
    .build = build_ebbvh_gated};

Result<std::vector<std::uint32_t>> edge_clusters(const refs::ReferenceSet& set, std::uint32_t rounds, mesh::Weld weld,
                                                 const BuildContext& context) try {
  std::vector<std::uint32_t> cluster_of(set.primitive_count, kNone);
  for (const refs::Reference& reference : set.references)
    if (reference.primitive >= set.primitive_count)
      return {ErrorCode::malformed, "a reference names primitive " + std::to_string(reference.primitive) + " of only " +
                                        std::to_string(set.primitive_count)};
  AlignedBuffer<ClusterLink> links =
      set.primitives ? links_of(set, weld, context.executor) : AlignedBuffer<ClusterLink>();
  MergeForest forest(set.references.span(), {}, {}, 0, context.executor);
  EdgeClustering clustering(forest, std::move(links), {}, {}, context.executor);
  const BuildMonitor monitor(context, 1);
  if (rounds != 0 && !clustering.run({.rounds = rounds}, monitor)) return cancelled_error();

  // Numbered in the order of their first references.
  const std::vector<std::uint32_t> roots = clustering.root_of_each_reference();
  std::vector<std::uint32_t> number(2 * set.references.size(), kNone);
  std::uint32_t clusters = 0;
  for (std::size_t r = 0; r < roots.size(); ++r) {
    std::uint32_t& n = number[roots[r]];
    if (n == kNone) n = clusters++;
    std::uint32_t& cluster = cluster_of[set.references[r].primitive];
    if (cluster == kNone) cluster = n;
  }
  return cluster_of;
} catch (const std::bad_alloc&) {
  return {ErrorCode::out_of_memory,
          "out of memory for the clusters of " + std::to_string(set.references.size()) + " references"};
}

}  // namespace boxwood::builders
