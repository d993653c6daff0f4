// PLOC, parallel locally-ordered clustering (Meister and Bittner 2018, bib key ploc): references stand in the order of
// their Morton codes; in each round every cluster looks for the one within `radius` places that makes the smallest box
// with it, and pairs that chose each other merge. Differs from the paper: of equally small boxes the cluster whose
// place differs in the lowest bits is taken, which makes the choice unique and pairs up equal boxes in one round; a
// round in which fewer than a sixteenth of the clusters would merge (nested boxes can let one pair merge at a time)
// joins each cluster with its neighbour in the order instead, which bounds the rounds and so the depth by 11 log2(n);
// leaves are decided as clusters merge (parts/merge_forest.h). O(n * radius) for usual inputs, O(n * radius * log n)
// for any; deterministic: new clusters are numbered in the order of their places.
#include <algorithm>

#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/box_columns.h"
#include "builders/parts/build_monitor.h"
#include "builders/parts/merge_forest.h"
#include "builders/parts/morton_options.h"
#include "builders/parts/morton_order.h"

namespace boxwood::builders {
namespace {

constexpr std::uint32_t kMostRadius = 128;
constexpr std::size_t kChunk = 2048;
/// Fewer merges than this share of the clusters are no progress.
constexpr std::size_t kSlow = 16;

constexpr OptionSpec kOptions[] = {
    {.key = "radius",
     .description = "places along the Morton order, before and after, in which the nearest cluster is looked for",
     .default_value = 16,
     .lowest = 1,
     .highest = kMostRadius,
     .integer = true},
    kMortonBitsOption,
    kMortonLeafMaxOption};

/// The clusters of one round in the order of the curve.
struct Clusters {
  std::vector<std::uint32_t> ids;
  BoxColumns boxes;  ///< in units of the scene

  explicit Clusters(std::size_t size) : ids(size) { boxes.resize(size); }
};

class LocallyOrderedClustering {
 public:
  LocallyOrderedClustering(MergeForest& forest, float scale, std::uint32_t radius, Executor& executor)
      : forest_(forest),
        scale_(scale),
        radius_(radius),
        executor_(executor),
        size_(forest.reference_count()),
        now_(size_),
        next_(size_),
        nearest_(size_) {
    executor.for_chunks(size_, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        now_.ids[i] = std::uint32_t(i);
        now_.boxes.set(i, scaled(forest_.box(std::uint32_t(i)), scale_));
      }
    });
  }

  std::size_t size() const { return size_; }
  std::uint32_t root() const { return now_.ids[0]; }

  /// One round; returns how many pairs merged, at least one.
  std::size_t merge_round() {
    executor_.for_chunks(size_, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) nearest_[i] = nearest(i);
    });
    if (count_pairs() * kSlow < size_)
      for (std::size_t i = 0; i < size_; ++i) nearest_[i] = std::uint32_t(std::min(i ^ 1, size_ - 1));
    const std::size_t pairs = count_pairs();
    executor_.for_chunks(size_, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      merge_chunk(pairs_before_[chunk], kept_before_[chunk], begin, end);
    });
    merged_ += pairs;
    size_ -= pairs;
    std::swap(now_, next_);
    return pairs;
  }

 private:
  std::uint32_t nearest(std::size_t i) const {
    const std::size_t first = i - std::min<std::size_t>(i, radius_);
    const std::size_t last = std::min(size_, i + radius_ + 1);
    float areas[2 * kMostRadius + 1];
    now_.boxes.joined_half_areas(i, first, last - first, areas);
    areas[i - first] = kInfinity;
    const float distance = smallest(areas, last - first);
    std::size_t best = SIZE_MAX;  // place xor i
    for (std::size_t k = 0; k < last - first; ++k)
      if (areas[k] == distance && first + k != i) best = std::min(best, (first + k) ^ i);
    return std::uint32_t(best ^ i);
  }

  bool is_pair(std::size_t i) const { return nearest_[i] != i && nearest_[nearest_[i]] == i; }

  /// Counts pairs and, for each chunk, how many pairs and clusters that stay come before it.
  std::size_t count_pairs() {
    const std::size_t chunks = (size_ + kChunk - 1) / kChunk;
    pairs_before_.resize(chunks);
    kept_before_.resize(chunks);
    executor_.for_chunks(size_, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      std::size_t firsts = 0, seconds = 0;
      for (std::size_t i = begin; i < end; ++i)
        if (is_pair(i)) ++(i < nearest_[i] ? firsts : seconds);
      pairs_before_[chunk] = firsts;
      kept_before_[chunk] = end - begin - seconds;
    });
    std::size_t pairs = 0, kept = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      pairs += std::exchange(pairs_before_[chunk], pairs);
      kept += std::exchange(kept_before_[chunk], kept);
    }
    return pairs;
  }

  void merge_chunk(std::size_t pair, std::size_t place, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!is_pair(i)) {
        next_.ids[place] = now_.ids[i];
        next_.boxes.set(place++, now_.boxes.get(i));
      } else if (i < nearest_[i]) {
        const std::size_t other = nearest_[i];
        next_.ids[place] = forest_.merge(std::uint32_t(merged_ + pair++), now_.ids[i], now_.ids[other]);
        next_.boxes.set(place++, boxwood::merge(now_.boxes.get(i), now_.boxes.get(other)));
      }
    }
  }

  MergeForest& forest_;
  float scale_;
  std::uint32_t radius_;
  Executor& executor_;
  std::size_t size_, merged_ = 0;
  Clusters now_, next_;
  std::vector<std::uint32_t> nearest_;
  std::vector<std::size_t> pairs_before_, kept_before_;
};

Result<tree::BinaryTree> build_ploc(refs::ReferenceSet&& set, const OptionValues& options,
                                    const BuildContext& context) {
  BuildMonitor monitor(context, set.references.size() + 1);
  auto order = morton_order(set.references.span(), bits_per_axis(options), context.executor);
  MergeForest forest(set.references.span(), order.span(), options.cost(), options.integer(kLeafMax), context.executor);
  order = {};
  set.references = {};
  LocallyOrderedClustering clustering(forest, area_scale(forest.bounds()), options.integer("radius"), context.executor);
  while (clustering.size() > 1) {
    if (monitor.cancelled()) return cancelled_error();
    monitor.finish(clustering.merge_round());
  }
  auto tree = forest.tree(clustering.root(), set.primitive_count, context.executor);
  monitor.finish(2);
  return tree;
}

}  // namespace

constinit const BuilderInfo ploc_builder = {
    .id = "ploc",
    .name = "PLOC",
    .summary = "merges near clusters along the Morton curve, bottom-up; best for architecture on many threads",
    .paper = "ploc",
    .cost_class = "O(n log n)",
    .splits_references = false,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = build_ploc};

}  // namespace boxwood::builders
