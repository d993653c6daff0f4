// The same rounds as in edge_clustering.cpp, driven by what changes. Every link waits in the heap of one of its two
// clusters. In a round, the clusters made in the last one offer their links, best first over all of them; so links come
// up by rank, as in the sequence. A link whose other cluster has been merged in this round moves to the cluster made of
// it, to be offered in the next round. A cluster without a partner has offered all its links, and all have moved to
// clusters that did merge: it needs no look until one of these offers a link back. When two clusters merge, so do their
// heaps, as pairing heaps do in constant time (Fredman, Sedgewick, Sleator and Tarjan 1986, bib key fredman1986).
//
// A cluster with n neighbours that merges with one of them in each of n rounds costs O(log n) a round this way.
#include "builders/parts/link_heaps.h"

#include <functional>
#include <queue>
#include <utility>

namespace boxwood::builders {

LinkHeaps::LinkHeaps(EdgeClustering& clustering)
    : clustering_(clustering),
      best_(clustering.parents_.size(), kNone),
      child_(clustering.links_.size(), kNone),
      sibling_(clustering.links_.size(), kNone) {
  for (std::size_t link = 0; link < child_.size(); ++link) {
    std::uint32_t& best = best_[root_of(clustering.links_[link].a)];
    best = meld(best, std::uint32_t(link));
  }
  for (std::size_t cluster = 0; cluster < best_.size(); ++cluster)
    if (best_[cluster] != kNone) looking_.push_back(std::uint32_t(cluster));
}

std::uint32_t LinkHeaps::root_of(std::uint32_t cluster) {
  auto& parents = clustering_.parents_;
  while (parents[cluster] != kNone) {
    const std::uint32_t parent = parents[cluster];
    if (parents[parent] != kNone) parents[cluster] = parents[parent];  // halves the path for the next one
    cluster = parent;
  }
  return cluster;
}

std::uint32_t LinkHeaps::meld(std::uint32_t a, std::uint32_t b) {
  if (a == kNone) return b;
  if (b == kNone) return a;
  if (b < a) std::swap(a, b);
  sibling_[b] = child_[a];
  child_[a] = b;
  return a;
}

std::uint32_t LinkHeaps::take_best(std::uint32_t cluster) {
  const std::uint32_t taken = best_[cluster];
  // Children are melded in pairs from the first to the last, the pairs from the last to the first.
  std::uint32_t pairs = kNone;
  for (std::uint32_t child = child_[taken]; child != kNone;) {
    const std::uint32_t second = sibling_[child];
    const std::uint32_t next = second == kNone ? kNone : sibling_[second];
    const std::uint32_t pair = meld(child, second);
    sibling_[pair] = pairs;
    pairs = pair;
    child = next;
  }
  std::uint32_t rest = kNone;
  while (pairs != kNone) {
    const std::uint32_t next = sibling_[pairs];
    rest = meld(rest, pairs);
    pairs = next;
  }
  best_[cluster] = rest;
  child_[taken] = sibling_[taken] = kNone;
  return taken;
}

std::uint32_t LinkHeaps::merge_round() {
  using Offer = std::pair<std::uint32_t, std::uint32_t>;  // link, cluster
  std::vector<Offer> offers;
  for (const std::uint32_t cluster : looking_)
    if (best_[cluster] != kNone) offers.emplace_back(best_[cluster], cluster);
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> queue({}, std::move(offers));
  looking_.clear();

  const std::uint32_t first_made = clustering_.forest_.reference_count() + clustering_.merged_;
  while (!queue.empty()) {
    const std::uint32_t cluster = queue.top().second;
    queue.pop();
    if (!clustering_.is_root(cluster)) continue;  // merged meanwhile, and its heap with it
    const std::uint32_t link = take_best(cluster);
    ClusterLink& ends = clustering_.links_[link];
    ends = {root_of(ends.a), root_of(ends.b)};
    const std::uint32_t other = ends.a == cluster ? ends.b : ends.a;
    if (other >= first_made) {
      best_[other] = meld(best_[other], link);
    } else if (other != cluster && clustering_.may_merge(ends.a, ends.b)) {
      const std::uint32_t heap = meld(best_[ends.a], best_[ends.b]);
      clustering_.merge(clustering_.merged_++, ends.a, ends.b);
      const std::uint32_t made = first_made + std::uint32_t(looking_.size());
      best_[made] = heap;
      looking_.push_back(made);
      continue;
    }
    if (best_[cluster] != kNone) queue.emplace(best_[cluster], cluster);
  }
  return std::uint32_t(looking_.size());
}

}  // namespace boxwood::builders
