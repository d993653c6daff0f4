// Treelets of a binary tree rebuilt for the rays that were seen there. For a node, the tree above its six or seven most
// visited descendants is replaced by the best of all trees over them (Karras and Aila 2013, bib key karras2013). Ours
// differs in what is best: not area but the number of sampled segments, cut at their hits, that cross the boxes, with
// prior rays that go by area (sample.h). Every subset of the treelet's leaves is tested against the segments that reach
// the node, so boxes that no tree has yet are priced as measured ones are. Top down, level by level, so that a node's
// segments are among its parent's; nodes that few segments reach are left as they are. Children of a node that are
// leaves stay what they are. Each pass is O(segments * visits * 2^leaves); deterministic: ties keep what is there.
#include <algorithm>
#include <array>
#include <bit>
#include <new>
#include <string>

#include "boxwood/optimizers.h"
#include "optimizers/node_visits.h"
#include "optimizers/sample.h"

namespace boxwood::optimizers {
namespace {

constexpr int kLeaves = 7;
constexpr int kSubsets = 1 << kLeaves;
/// Nodes reached by fewer segments are not rebuilt.
constexpr std::size_t kFewest = 4;

struct Task {
  std::uint32_t node;
  std::vector<std::uint32_t> segments;
};

/// A node with its subtree's best descendants and the tree over them.
class Treelet {
 public:
  Treelet(std::span<tree::Node> nodes, std::span<std::uint32_t> visits, std::uint32_t root)
      : nodes_(nodes), visits_(visits), root_(root) {
    const std::uint32_t pair = nodes[root].first;
    leaves_[0] = pair, leaves_[1] = pair + 1, size_ = 2;
    pairs_[0] = pair, inner_ = 1;
    while (size_ < kLeaves && open_one()) {
    }
  }

  int size() const { return size_; }

  /// Prices all subsets and, when another tree is cheaper, makes it.
  bool rebuild(std::span<const Segment> segments, std::span<const std::uint32_t> ids, float prior) {
    if (size_ < 3) return false;
    make_boxes();
    count(segments, ids);
    const int all = (1 << size_) - 1;
    const Box box = nodes_[root_].bounds;
    const VisitShare share(std::uint32_t(ids.size()), box.half_area(), prior);
    for (int s = 1; s <= all; ++s) weight_[s] = share(crossings_[s], area_[s]);
    const float before = current_cost();
    find_best(all);
    if (!(cost_[all] < before * (1 - 1e-5f))) return false;
    write(all);
    return true;
  }

 private:
  /// Takes the children of the most visited leaf that has any in its place.
  bool open_one() {
    int best = -1;
    for (int i = 0; i < size_; ++i) {
      if (nodes_[leaves_[i]].is_leaf()) continue;
      if (best < 0 || visits_[leaves_[i]] > visits_[leaves_[best]]) best = i;
    }
    if (best < 0 || visits_[leaves_[best]] == 0) return false;
    const std::uint32_t pair = nodes_[leaves_[best]].first;
    opened_[inner_ - 1] = leaves_[best];
    pairs_[inner_++] = pair;
    leaves_[best] = pair;
    leaves_[size_++] = pair + 1;
    return true;
  }

  void make_boxes() {
    for (int s = 1; s < 1 << size_; ++s) {
      const int lowest = std::countr_zero(unsigned(s)), rest = s & (s - 1);
      Box box = nodes_[leaves_[lowest]].bounds;
      if (rest) box.grow(get_box(rest));
      for (int axis = 0; axis < 3; ++axis) {
        plane_[2 * axis][s] = box.lower[axis];
        plane_[2 * axis + 1][s] = box.upper[axis];
      }
      area_[s] = box.half_area();
      crossings_[s] = 0;
    }
  }
  Box get_box(int s) const {
    return {{plane_[0][s], plane_[2][s], plane_[4][s]}, {plane_[1][s], plane_[3][s], plane_[5][s]}};
  }

  void count(std::span<const Segment> segments, std::span<const std::uint32_t> ids) {
    const int end = 1 << size_;
    for (const std::uint32_t id : ids) {
      const Segment& g = segments[id];
      const float *x0 = plane_[g.entry[0]], *x1 = plane_[1 - g.entry[0]];
      const float *y0 = plane_[2 + g.entry[1]], *y1 = plane_[3 - g.entry[1]];
      const float *z0 = plane_[4 + g.entry[2]], *z1 = plane_[5 - g.entry[2]];
      for (int s = 0; s < end; ++s) {
        const float near =
            maximum(maximum((x0[s] - g.origin[0]) * g.reciprocal[0], (y0[s] - g.origin[1]) * g.reciprocal[1]),
                    maximum((z0[s] - g.origin[2]) * g.reciprocal[2], g.tmin));
        const float far =
            minimum(minimum((x1[s] - g.origin[0]) * g.reciprocal[0], (y1[s] - g.origin[1]) * g.reciprocal[1]),
                    minimum((z1[s] - g.origin[2]) * g.reciprocal[2], g.tmax));
        crossings_[s] += near <= far;
      }
    }
  }

  /// Of the tree that is there now, in weights.
  float current_cost() const {
    // opened_[i] is the node whose pair is pairs_[i + 1]; a node's subset is what of the leaves stands below it.
    std::array<int, kLeaves> below{};  // by inner node
    const auto subset_of = [&](std::uint32_t n) {
      for (int i = 0; i < size_; ++i)
        if (leaves_[i] == n) return 1 << i;
      for (int i = 1; i < inner_; ++i)
        if (opened_[i - 1] == n) return below[std::size_t(i)];
      return 0;
    };
    float cost = 0;
    for (int i = inner_; i-- > 0;) {
      below[std::size_t(i)] = subset_of(pairs_[i]) | subset_of(pairs_[i] + 1);
      cost += weight_[below[std::size_t(i)]];
    }
    return cost;
  }

  void find_best(int all) {
    for (int s = 1; s <= all; ++s) {
      cost_[s] = 0;
      if (std::has_single_bit(unsigned(s))) continue;
      // The part that holds the lowest leaf, so that each pair of parts is seen once.
      const int lowest = s & -s, rest = s ^ lowest;
      float least = kInfinity;
      int best = 0;
      for (int others = (rest - 1) & rest;; others = (others - 1) & rest) {
        const int part = lowest | others;
        const float cost = cost_[part] + cost_[s ^ part];
        if (cost < least) least = cost, best = part;
        if (others == 0) break;
      }
      cost_[s] = least + weight_[s];
      part_[s] = best;
    }
  }

  void write(int all) {
    std::array<tree::Node, kLeaves> saved;
    std::array<std::uint32_t, kLeaves> saved_visits;
    for (int i = 0; i < size_; ++i) {
      saved[std::size_t(i)] = nodes_[leaves_[i]];
      saved_visits[std::size_t(i)] = visits_[leaves_[i]];
    }
    int used = 1;
    std::array<std::pair<int, std::uint32_t>, kLeaves> stack;
    std::size_t top = 0;
    const auto put = [&](int s, std::uint32_t node) {
      if (std::has_single_bit(unsigned(s))) {
        const auto leaf = std::size_t(std::countr_zero(unsigned(s)));
        nodes_[node] = saved[leaf];
        visits_[node] = saved_visits[leaf];
        return;
      }
      const std::uint32_t pair = pairs_[used++];
      nodes_[node] = {get_box(s), pair, 0};
      visits_[node] = crossings_[s];
      stack[top++] = {s, pair};
    };
    stack[top++] = {all, pairs_[0]};
    while (top > 0) {
      const auto [s, pair] = stack[--top];
      put(part_[s], pair);
      put(s ^ part_[s], pair + 1);
    }
  }

  std::span<tree::Node> nodes_;
  std::span<std::uint32_t> visits_;
  std::uint32_t root_;
  int size_, inner_;
  std::array<std::uint32_t, kLeaves> leaves_, opened_, pairs_;
  alignas(64) float plane_[6][kSubsets] = {};
  alignas(64) std::uint32_t crossings_[kSubsets] = {};
  float area_[kSubsets], weight_[kSubsets], cost_[kSubsets];
  int part_[kSubsets];
};

class Pass {
 public:
  Pass(std::span<tree::Node> nodes, std::span<std::uint32_t> visits, std::span<const Segment> segments, float prior,
       Executor& executor)
      : nodes_(nodes), visits_(visits), segments_(segments), prior_(prior), executor_(executor) {}

  std::size_t run() {
    std::vector<Task> level(1);
    level[0].node = 0;
    for (std::uint32_t s = 0; s < segments_.size(); ++s)
      if (segments_[s].meets(nodes_[0].bounds)) level[0].segments.push_back(s);
    std::size_t changed = 0;
    if (level[0].segments.size() < kFewest) level.clear();
    while (!level.empty()) {
      std::vector<std::array<Task, 2>> children(level.size());
      std::vector<std::uint8_t> changes(level.size());
      executor_.for_chunks(level.size(), 8, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) changes[i] = work(level[i], children[i]);
      });
      changed += std::size_t(std::count(changes.begin(), changes.end(), 1));
      std::vector<Task> next;
      for (auto& pair : children)
        for (Task& task : pair)
          if (task.segments.size() >= kFewest) next.push_back(std::move(task));
      level = std::move(next);
    }
    return changed;
  }

 private:
  bool work(Task& task, std::array<Task, 2>& children) {
    if (nodes_[task.node].is_leaf()) return false;
    const bool changed = Treelet(nodes_, visits_, task.node).rebuild(segments_, task.segments, prior_);
    for (std::uint32_t side = 0; side < 2; ++side) {
      const std::uint32_t child = nodes_[task.node].first + side;
      children[side].node = child;
      if (nodes_[child].is_leaf()) continue;
      for (const std::uint32_t s : task.segments)
        if (segments_[s].meets(nodes_[child].bounds)) children[side].segments.push_back(s);
    }
    task.segments = {};
    return changed;
  }

  std::span<tree::Node> nodes_;
  std::span<std::uint32_t> visits_;
  std::span<const Segment> segments_;
  float prior_;
  Executor& executor_;
};

}  // namespace

Result<tree::BinaryTree> restructure(const tree::BinaryTree& tree, std::span<const Ray> segments,
                                     const RestructureOptions& options, Executor& executor) try {
  const std::vector<Segment> sample = make_segments(segments);
  std::vector<tree::Node> nodes(tree.nodes.begin(), tree.nodes.end());
  std::size_t changed = 0;
  if (!tree.empty()) {
    auto visits = count_visits(tree, sample, executor);
    for (int pass = 0; pass < options.passes; ++pass) {
      const std::size_t changes = Pass(nodes, visits, sample, options.prior, executor).run();
      changed += changes;
      if (changes == 0) break;
    }
  }
  if (tree.empty()) {
    tree::BinaryTree empty;
    empty.primitive_count = tree.primitive_count;
    return empty;
  }
  auto out = tree::canonicalize(nodes, tree.references.span(), tree.primitive_count, tree.splits_references, executor);
  out.notes.push_back({"treelets rebuilt", double(changed)});
  return out;
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::out_of_memory,
               "not enough memory to restructure a tree of " + std::to_string(tree.nodes.size()) + " nodes"};
}

}  // namespace boxwood::optimizers
