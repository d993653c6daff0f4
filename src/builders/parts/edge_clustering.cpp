// Rounds of pairing over shared edges (Houghton and Spoerer, bib key ebbvh, algorithm 1). A round goes through the
// links by rank and merges the two clusters of a link if neither has been merged in this round: greedy matching in a
// strict total order, which has one result only. Three ways lead to it, and they can be changed between rounds:
//
// - In sequence, as said; links inside one cluster are dropped on the way.
// - In parallel: a link that ranks first among the usable links of both its clusters is one that the sequence would
//   take, whatever else it takes. All such links merge at once; links of merged clusters are then out of this round;
//   and so on until no usable link is left. A chain of ever better links takes one step for each, so after a few steps
//   the few links that are left go in sequence.
// - By heaps (link_heaps.h), when a round merges few pairs for its many links. A cluster with many small neighbours
//   merges with one of them in each round: thousands of rounds, in each of which only the links that matter are
//   touched.
//
// A round over all links that is followed by another one has merged a pair for each sixteenth link, so all of them
// together are O(n); heaps are O(n log n). Differs from the paper: the pairs of a non-manifold edge come from
// mesh::edge_links, and pairs may be refused by a gate on the growth of boxes and clusters.
#include "builders/parts/edge_clustering.h"

#include <algorithm>
#include <atomic>

#include "builders/parts/link_heaps.h"

namespace boxwood::builders {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 14;
/// Steps of the parallel way before the rest goes in sequence, and a rest not worth a step.
constexpr int kSteps = 12;
constexpr std::size_t kFewLinks = std::size_t{1} << 12;

double half_area(const Box& box) {
  const double x = double(box.upper.x) - box.lower.x;
  const double y = double(box.upper.y) - box.lower.y;
  const double z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

void lower_to(std::uint32_t& place, std::uint32_t value) {
  std::atomic_ref<std::uint32_t> shared(place);
  std::uint32_t now = shared.load(std::memory_order_relaxed);
  while (value < now && !shared.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
}

/// Keeps the items for which keep(item) holds, in order.
template <class T, class Keep>
std::size_t compact(std::span<T> items, Executor& executor, Keep keep) {
  std::vector<std::size_t> counts((items.size() + kChunk - 1) / kChunk);
  executor.for_chunks(items.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t next = begin;
    for (std::size_t i = begin; i < end; ++i)
      if (keep(items[i])) items[next++] = items[i];
    counts[chunk] = next - begin;
  });
  std::size_t total = 0;
  for (std::size_t chunk = 0; chunk < counts.size(); ++chunk) {
    if (total != chunk * kChunk) std::copy_n(items.begin() + chunk * kChunk, counts[chunk], items.begin() + total);
    total += counts[chunk];
  }
  return total;
}

}  // namespace

EdgeClustering::EdgeClustering(MergeForest& forest, AlignedBuffer<ClusterLink> links, const GrowthGate& gate,
                               const Ways& ways, Executor& executor)
    : forest_(forest),
      links_(std::move(links)),
      gate_(gate),
      ways_(ways),
      executor_(executor),
      parents_(2 * std::size_t(forest.reference_count())) {
  executor_.for_chunks(parents_.size(), 8 * kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::fill(parents_.begin() + begin, parents_.begin() + end, kNone);
  });
}

bool EdgeClustering::may_merge(std::uint32_t a, std::uint32_t b) const {
  if (gate_.size != 0 && forest_.count(a) + forest_.count(b) > gate_.size) return false;
  if (gate_.area == 0) return true;
  const Box &left = forest_.box(a), &right = forest_.box(b);
  return half_area(boxwood::merge(left, right)) <= gate_.area * (half_area(left) + half_area(right));
}

void EdgeClustering::merge(std::uint32_t number, std::uint32_t a, std::uint32_t b) {
  parents_[a] = parents_[b] = forest_.merge(number, a, b);
}

void EdgeClustering::merge_round() {
  const std::uint32_t begin = forest_.reference_count() + merged_;
  std::size_t kept = 0;
  // Ends are clusters that the last round started with. A parent made in that round is where an end is now; a parent
  // made in this one says that it is taken.
  const auto current = [&](std::uint32_t end) {
    const std::uint32_t parent = parents_[end];
    return parent != kNone && parent < begin ? parent : end;
  };
  for (ClusterLink link : links_) {
    link = {current(link.a), current(link.b)};
    if (link.a == link.b) continue;
    if (is_root(link.a) && is_root(link.b)) {
      if (may_merge(link.a, link.b)) merge(merged_++, link.a, link.b);
      continue;
    }
    if (parents_[link.a] != parents_[link.b]) links_[kept++] = link;
  }
  links_.truncate(kept);
}

std::vector<std::uint32_t> EdgeClustering::choose_in_parallel() {
  std::vector<std::uint32_t> open(links_.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = std::uint32_t(i);
  AlignedBuffer<std::uint32_t> first(parents_.size());  // best usable link of each cluster
  std::vector<std::uint8_t> taken(parents_.size()), chosen(links_.size());
  const auto usable = [&](std::uint32_t i) {
    const ClusterLink link = links_[i];
    return link.a != link.b && !taken[link.a] && !taken[link.b];
  };
  const auto decide = [&](std::uint32_t i) {
    ClusterLink& link = links_[i];
    if (may_merge(link.a, link.b))
      chosen[i] = taken[link.a] = taken[link.b] = 1;
    else
      link.b = link.a;
  };
  const auto for_open = [&](auto f) {
    executor_.for_chunks(open.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) f(open[k]);
    });
  };
  for (int step = 0; step < kSteps && open.size() > kFewLinks; ++step) {
    for_open([&](std::uint32_t i) {
      for (const std::uint32_t end : {links_[i].a, links_[i].b})
        std::atomic_ref(first[end]).store(kNone, std::memory_order_relaxed);
    });
    for_open([&](std::uint32_t i) { lower_to(first[links_[i].a], i), lower_to(first[links_[i].b], i); });
    for_open([&](std::uint32_t i) {
      if (first[links_[i].a] == i && first[links_[i].b] == i) decide(i);
    });
    open.resize(compact(std::span(open), executor_, usable));
  }
  for (const std::uint32_t i : open)
    if (usable(i)) decide(i);

  std::vector<std::uint32_t> matched;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) matched.push_back(std::uint32_t(i));
  return matched;
}

void EdgeClustering::merge_round_in_parallel() {
  executor_.for_chunks(links_.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ClusterLink& link = links_[i];
      if (!is_root(link.a)) link.a = parents_[link.a];
      if (!is_root(link.b)) link.b = parents_[link.b];
    }
  });
  links_.truncate(compact(links_.span(), executor_, [](const ClusterLink& link) { return link.a != link.b; }));
  const std::vector<std::uint32_t> matched = choose_in_parallel();
  executor_.for_chunks(matched.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      merge(merged_ + std::uint32_t(k), links_[matched[k]].a, links_[matched[k]].b);
  });
  merged_ += std::uint32_t(matched.size());
  links_.truncate(compact(links_.span(), executor_, [&](const ClusterLink& link) {
    return link.a != link.b && (is_root(link.a) || parents_[link.a] != parents_[link.b]);
  }));
}

bool EdgeClustering::is_done(const Limits& limits) const {
  if (pairs_by_round_.empty()) return false;
  const std::uint32_t pairs = pairs_by_round_.back();
  return pairs == 0 || pairs < limits.pair_cutoff || pairs_by_round_.size() == limits.rounds;
}

bool EdgeClustering::run(const Limits& limits, const BuildMonitor& monitor) {
  while (!is_done(limits)) {
    if (monitor.cancelled()) return false;
    const std::size_t links = links_.size();
    const std::uint32_t before = merged_;
    if (links >= ways_.parallel_links && executor_.threads() >= ways_.parallel_threads)
      merge_round_in_parallel();
    else
      merge_round();
    pairs_by_round_.push_back(merged_ - before);
    if (is_done(limits) || (merged_ - before) * ways_.slow_share >= links) continue;
    LinkHeaps heaps(*this);
    while (!is_done(limits)) {
      if (monitor.cancelled()) return false;
      pairs_by_round_.push_back(heaps.merge_round());
    }
  }
  return true;
}

std::vector<std::uint32_t> EdgeClustering::roots() const {
  std::vector<std::uint32_t> roots;
  const std::uint32_t count = forest_.reference_count() + merged_;
  roots.reserve(count - 2 * merged_);
  for (std::uint32_t cluster = 0; cluster < count; ++cluster)
    if (is_root(cluster)) roots.push_back(cluster);
  return roots;
}

std::vector<std::uint32_t> EdgeClustering::root_of_each_reference() const {
  std::vector<std::uint32_t> root(forest_.reference_count() + std::size_t(merged_));
  for (std::size_t c = root.size(); c-- > 0;)  // parents have higher numbers
    root[c] = is_root(std::uint32_t(c)) ? std::uint32_t(c) : root[parents_[c]];
  root.resize(forest_.reference_count());
  return root;
}

}  // namespace boxwood::builders
