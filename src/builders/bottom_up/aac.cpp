// AAC, approximate agglomerative clustering (Gu, He, Fatahalian and Blelloch 2013, bib key aac): the references along
// the Morton curve are halved by the bits of their codes until at most `delta` are left; on the way back up the
// clusters of both halves are put together and the pair with the smallest joined box merges, again and again, until
// only f(n) = delta^(1/2 + epsilon) / 2 * n^(1/2 - epsilon) clusters stand for the n references. Differs from the
// paper: the recursion is a list of ranges, worked off from the last to the first; equal codes are halved by number; of
// equally small boxes the pair that has waited longest merges, which keeps equal boxes balanced; leaves are decided as
// clusters merge (parts/merge_forest.h). O(n) after the sort for usual inputs. Deterministic: ranges depend on codes
// only, and each merge takes the number that one of its two clusters has kept.
#include <algorithm>
#include <bit>

#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/box_columns.h"
#include "builders/parts/build_monitor.h"
#include "builders/parts/emit_morton.h"
#include "builders/parts/merge_forest.h"
#include "builders/parts/morton_options.h"
#include "builders/parts/morton_order.h"

namespace boxwood::builders {
namespace {

constexpr const char* kQualities[] = {"hq", "fast"};
constexpr std::uint32_t kTaskSize = 4096;

constexpr OptionSpec kOptions[] = {
    {.key = "quality",
     .description = "hq: delta 20, epsilon 0.1; fast: delta 4, epsilon 0.2 (Gu et al. 2013)",
     .choices = kQualities},
    kMortonBitsOption,
    kMortonLeafMaxOption};

/// How many clusters may stand for how many references.
struct Reduction {
  std::uint32_t delta;
  double epsilon;

  std::uint32_t clusters(std::uint32_t references) const {
    const double f = 0.5 * std::pow(double(delta), 0.5 + epsilon) * std::pow(double(references), 0.5 - epsilon);
    return std::max(1u, std::uint32_t(f));
  }
};

/// A cluster that has not found its partner. It keeps one number for a merge: references have one each, and a merge
/// takes one of the two that its clusters have.
struct Waiting {
  Box box;  ///< in units of the scene
  std::uint32_t cluster;
  std::uint32_t number;
};

/// Merges the closest of some clusters until few enough are left. Reused for many sets, for its memory.
class Combiner {
 public:
  Combiner(MergeForest& forest) : forest_(forest) {}

  void combine(std::vector<Waiting>& clusters, std::size_t target) {
    if (clusters.size() <= target) return;
    size_ = clusters.size();
    boxes_.resize(size_);
    for (auto* column : {&births_, &nearest_}) column->resize(size_);
    distances_.resize(size_);
    areas_.resize(size_);
    for (std::size_t i = 0; i < size_; ++i) {
      boxes_.set(i, clusters[i].box);
      births_[i] = std::uint32_t(i);
    }
    next_birth_ = std::uint32_t(size_);
    for (std::size_t i = 0; i < size_; ++i) find_nearest(i);
    while (size_ > target) merge_closest(clusters);
    clusters.resize(size_);
  }

 private:
  /// Sorts pairs of equal distance: the one that waits longer, by its later cluster, comes first. Of those the one with
  /// the later other cluster: then equal boxes choose each other and not all the first.
  std::pair<std::uint32_t, std::uint32_t> age(std::size_t i, std::size_t k) const {
    return {std::max(births_[i], births_[k]), ~std::min(births_[i], births_[k])};
  }

  void find_nearest(std::size_t i) {
    boxes_.joined_half_areas(i, 0, size_, areas_.data());
    areas_[i] = kInfinity;
    distances_[i] = smallest(areas_.data(), size_);
    std::size_t best = SIZE_MAX;
    for (std::size_t k = 0; k < size_; ++k)
      if (areas_[k] == distances_[i] && k != i && (best == SIZE_MAX || age(i, k) < age(i, best))) best = k;
    nearest_[i] = std::uint32_t(best);
  }

  void merge_closest(std::vector<Waiting>& clusters) {
    std::size_t i = 0;
    for (std::size_t k = 1; k < size_; ++k)
      if (distances_[k] < distances_[i] ||
          (distances_[k] == distances_[i] && age(k, nearest_[k]) < age(i, nearest_[i])))
        i = k;
    std::size_t j = nearest_[i];
    if (births_[j] < births_[i]) std::swap(i, j);
    Waiting& merged = clusters[i];
    merged.cluster = forest_.merge(merged.number, merged.cluster, clusters[j].cluster);
    merged.number = clusters[j].number;
    merged.box = boxwood::merge(merged.box, clusters[j].box);
    births_[i] = next_birth_++;
    boxes_.set(i, merged.box);
    const std::size_t last = --size_;
    clusters[j] = clusters[last];
    boxes_.set(j, boxes_.get(last));
    births_[j] = births_[last];
    nearest_[j] = nearest_[last];
    distances_[j] = distances_[last];
    if (i == last) i = j;
    if (size_ == 1) return;
    for (std::size_t k = 0; k < size_; ++k) {
      const std::uint32_t nearest = nearest_[k];
      if (k == i || nearest == i || nearest == j || (nearest == last && i == j))
        stale_.push_back(std::uint32_t(k));
      else if (nearest == last)
        nearest_[k] = std::uint32_t(j);
    }
    for (const std::uint32_t k : stale_) find_nearest(k);
    stale_.clear();
  }

  MergeForest& forest_;
  std::size_t size_ = 0;
  std::uint32_t next_birth_ = 0;
  BoxColumns boxes_;
  std::vector<std::uint32_t> births_, nearest_, stale_;
  std::vector<float> distances_, areas_;
};

class AgglomerativeClustering {
 public:
  AgglomerativeClustering(MergeForest& forest, std::span<const KeyedIndex> order, const Reduction& reduction)
      : forest_(forest), order_(order), reduction_(reduction), scale_(area_scale(forest.bounds())) {}

  /// The cluster of all references; what it is when cancelled is not said.
  std::uint32_t run(const BuildContext& context, BuildMonitor& monitor) {
    // The ranges above the tasks in depth-first order, and how many more levels of ranges are above the tasks below.
    struct Upper {
      std::uint32_t left, right;  ///< among `sets`
      std::uint32_t size;
      std::uint32_t height;
    };
    struct Open {
      MortonRange range;
      std::uint32_t set;
    };
    std::vector<Upper> uppers;
    std::vector<std::uint32_t> upper_set;
    std::vector<Open> tasks, open{{{0, std::uint32_t(order_.size())}, 0}};
    std::uint32_t sets_made = 1;
    while (!open.empty()) {
      const Open now = open.back();
      open.pop_back();
      if (now.range.size() <= kTaskSize) {
        tasks.push_back(now);
        continue;
      }
      const std::uint32_t m = middle(now.range);
      uppers.push_back({sets_made, sets_made + 1, now.range.size(), 0});
      upper_set.push_back(now.set);
      open.push_back({{m, now.range.last}, sets_made + 1});
      open.push_back({{now.range.first, m}, sets_made});
      sets_made += 2;
    }
    std::vector<std::vector<Waiting>> sets(sets_made);
    context.executor.for_chunks(tasks.size(), 1, [&](std::size_t t, std::size_t, std::size_t) {
      if (monitor.cancelled()) return;
      sets[tasks[t].set] = cluster_small(tasks[t].range);
      monitor.finish(tasks[t].range.size());
    });
    if (monitor.cancelled()) return 0;

    std::vector<std::uint32_t> height(sets_made);
    std::vector<std::vector<std::uint32_t>> by_height;
    for (std::size_t u = uppers.size(); u-- > 0;) {
      const std::uint32_t h = std::max(height[uppers[u].left], height[uppers[u].right]);
      height[upper_set[u]] = h + 1;
      if (h >= by_height.size()) by_height.resize(h + 1);
      by_height[h].push_back(std::uint32_t(u));
    }
    for (const std::vector<std::uint32_t>& level : by_height)
      context.executor.for_chunks(level.size(), 1, [&](std::size_t l, std::size_t, std::size_t) {
        if (monitor.cancelled()) return;
        const Upper& upper = uppers[level[l]];
        Combiner combiner(forest_);
        sets[upper_set[level[l]]] =
            join(std::move(sets[upper.left]), std::move(sets[upper.right]), upper.size, combiner);
      });
    if (monitor.cancelled()) return 0;
    Combiner(forest_).combine(sets[0], 1);
    return sets[0][0].cluster;
  }

 private:
  /// Where the highest bit in which the codes of a range differ changes; half of the range if they don't.
  std::uint32_t middle(MortonRange range) const {
    const std::uint64_t first = order_[range.first].key, difference = first ^ order_[range.last - 1].key;
    if (difference == 0) return range.first + range.size() / 2;
    const std::uint64_t bit = std::bit_floor(difference);
    const auto begin = order_.begin() + range.first, end = order_.begin() + range.last;
    return std::uint32_t(std::partition_point(begin, end, [&](const KeyedIndex& k) { return !(k.key & bit); }) -
                         order_.begin());
  }

  std::vector<Waiting> join(std::vector<Waiting> left, const std::vector<Waiting>& right, std::uint32_t references,
                            Combiner& combiner) const {
    left.insert(left.end(), right.begin(), right.end());
    combiner.combine(left, reduction_.clusters(references));
    return left;
  }

  std::vector<Waiting> singles(MortonRange range, Combiner& combiner) const {
    std::vector<Waiting> clusters;
    for (std::uint32_t i = range.first; i < range.last; ++i) clusters.push_back({scaled(forest_.box(i), scale_), i, i});
    combiner.combine(clusters, reduction_.clusters(reduction_.delta));
    return clusters;
  }

  std::vector<Waiting> cluster_small(MortonRange whole) const {
    Combiner combiner(forest_);
    // Depth-first order, backwards: the halves of a range are always the last two sets made.
    std::vector<MortonRange> ranges, open{whole};
    while (!open.empty()) {
      const MortonRange range = open.back();
      open.pop_back();
      ranges.push_back(range);
      if (range.size() < reduction_.delta) continue;
      const std::uint32_t m = middle(range);
      open.push_back({m, range.last});
      open.push_back({range.first, m});
    }
    std::vector<std::vector<Waiting>> made;
    for (std::size_t r = ranges.size(); r-- > 0;) {
      if (ranges[r].size() < reduction_.delta) {
        made.push_back(singles(ranges[r], combiner));
        continue;
      }
      std::vector<Waiting> left = std::move(made.back());
      made.pop_back();
      made.back() = join(std::move(left), made.back(), ranges[r].size(), combiner);
    }
    return std::move(made.back());
  }

  MergeForest& forest_;
  std::span<const KeyedIndex> order_;
  Reduction reduction_;
  float scale_;
};

Result<tree::BinaryTree> build_aac(refs::ReferenceSet&& set, const OptionValues& options, const BuildContext& context) {
  BuildMonitor monitor(context, set.references.size() + 2);
  const auto order = morton_order(set.references.span(), bits_per_axis(options), context.executor);
  MergeForest forest(set.references.span(), order.span(), options.cost(), options.integer(kLeafMax), context.executor);
  set.references = {};
  if (monitor.cancelled()) return cancelled_error();
  const Reduction reduction = options.choice("quality") == 0 ? Reduction{20, 0.1} : Reduction{4, 0.2};
  const std::uint32_t root = AgglomerativeClustering(forest, order.span(), reduction).run(context, monitor);
  if (monitor.cancelled()) return cancelled_error();
  auto tree = forest.tree(root, set.primitive_count, context.executor);
  monitor.finish(2);
  return tree;
}

}  // namespace

constinit const BuilderInfo aac_builder = {
    .id = "aac",
    .name = "AAC",
    .summary = "merges the closest clusters, up a Morton tree; best for architecture, when building may take long",
    .paper = "aac",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = build_aac};

}  // namespace boxwood::builders
