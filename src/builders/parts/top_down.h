// The top-down driver: takes ranges of references apart with a split finder until only leaves are left.
//
// A split finder is a class with
//   Split find(const BuildRange&, Executor&)       the split to make; Split::is_leaf() says to make none
//   Split median(const BuildRange&)                a split into two halves, which always works
//   void apply(const Split&, const BuildRange&, Executor&, BuildRange& left, BuildRange& right)
//                                                  sorts the references and fills in all of both ranges but slot, depth
//   void write_leaf(const BuildRange&, std::uint32_t* ids)
// It is called for disjoint ranges from several threads at once. A finder that makes small subtrees by itself has, in
// place of the last,
//   bool finishes(const BuildRange&)               does it make the subtree over the range?
//   void finish(const BuildRange&, tree::Node* nodes, std::uint32_t* ids)
//                                                  does so; without `finishes` said, it makes a leaf
//
// Ranges worth a task are split in rounds, breadth first: few large ones one after the other, each by a parallel find
// and apply, all others side by side; then each small range is finished by one thread. A stack that takes the larger
// half and goes on with the smaller one never holds more than log2(n) ranges, so nothing here recurses. The node of the
// split of [first, last) at `mid` puts its children into the slots 2 * mid and 2 * mid + 1: each mid in 1 .. n - 1 is
// used once at most, so threads need no counter and the slots do not depend on their order. Past kDepthLimit ranges are
// halved, which bounds the depth of the tree by kDepthLimit + log2(n).
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "builders/parts/build_monitor.h"
#include "builders/parts/build_range.h"

namespace boxwood::builders {

/// Deep enough for any input that a heuristic splits with sense, far below what a traversal has to fear.
inline constexpr std::uint32_t kDepthLimit = 96;

template <class Finder>
concept MakesSubtrees = requires(Finder finder, const BuildRange& range) {
  finder.finishes(range);
};

template <class Finder>
class TopDownDriver {
 public:
  /// Ranges of more references than `large_range` are worked on by all threads.
  TopDownDriver(Finder& finder, std::size_t reference_count, const BuildContext& context,
                std::size_t large_range = kLargeRange)
      : TopDownDriver(finder, reference_count, context, large_range, 2 * reference_count, reference_count) {}
  /// For a finder that makes subtrees and needs more room than two nodes and one id for each reference.
  TopDownDriver(Finder& finder, std::size_t reference_count, const BuildContext& context, std::size_t large_range,
                std::size_t nodes, std::size_t ids)
      : finder_(finder),
        executor_(context.executor),
        monitor_(context, reference_count),
        large_range_(large_range),
        nodes_(nodes),
        ids_(ids) {}

  /// Fills nodes() and ids(). False when cancelled.
  bool run(const BuildRange& root) {
    std::vector<BuildRange> large, small;
    (root.size() > kTaskRange ? large : small).push_back(root);
    while (!large.empty() && !monitor_.cancelled()) large = split_round(large, small);
    executor_.for_chunks(small.size(), 1, [&](std::size_t chunk, std::size_t, std::size_t) {
      finish(small[chunk]);
      monitor_.finish(small[chunk].size());
    });
    return !monitor_.cancelled();
  }

  AlignedBuffer<tree::Node>& nodes() { return nodes_; }
  AlignedBuffer<std::uint32_t>& ids() { return ids_; }

 private:
  /// Below this many ranges at once the threads share the work on each large range, from here on the ranges.
  static constexpr std::size_t kManyRanges = 8;

  struct Children {
    bool split = false;
    BuildRange left, right;
  };

  std::vector<BuildRange> split_round(const std::vector<BuildRange>& ranges, std::vector<BuildRange>& small) {
    std::vector<Children> children(ranges.size());
    const auto by_all_threads = [&](const BuildRange& range) {
      return ranges.size() < kManyRanges && range.size() > large_range_;
    };
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (by_all_threads(ranges[i]))
        children[i].split = split_or_leaf(ranges[i], executor_, children[i].left, children[i].right);
    executor_.for_chunks(ranges.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      SequentialExecutor sequential;
      if (!by_all_threads(ranges[i]))
        children[i].split = split_or_leaf(ranges[i], sequential, children[i].left, children[i].right);
    });
    std::vector<BuildRange> large;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (!children[i].split) {
        monitor_.finish(ranges[i].size());
        continue;
      }
      for (const BuildRange& child : {children[i].left, children[i].right})
        (child.size() > kTaskRange ? large : small).push_back(child);
    }
    return large;
  }

  void finish(BuildRange range) {
    std::array<BuildRange, 32> stack;
    std::size_t waiting = 0;
    SequentialExecutor sequential;
    while (!monitor_.cancelled()) {
      BuildRange left, right;
      if (split_or_leaf(range, sequential, left, right)) {
        const bool left_is_larger = left.size() > right.size();
        stack[waiting++] = left_is_larger ? left : right;
        range = left_is_larger ? right : left;
      } else {
        if (waiting == 0) return;
        range = stack[--waiting];
      }
    }
  }

  /// True when the range was split, false when it became a leaf.
  bool split_or_leaf(const BuildRange& range, Executor& executor, BuildRange& left, BuildRange& right) {
    if (!is_finished(range)) {
      const auto split = range.depth < kDepthLimit ? finder_.find(range, executor) : finder_.median(range);
      if (!split.is_leaf()) {
        finder_.apply(split, range, executor, left, right);
        left.slot = 2 * right.first;
        right.slot = 2 * right.first + 1;
        left.depth = right.depth = range.depth + 1;
        nodes_[range.slot] = {range.bounds.box(), left.slot, 0};
        return true;
      }
    }
    if constexpr (MakesSubtrees<Finder>) {
      finder_.finish(range, nodes_.data(), ids_.data());
    } else {
      finder_.write_leaf(range, ids_.data() + range.first);
      nodes_[range.slot] = {range.bounds.box(), range.first, range.size()};
    }
    return false;
  }

  bool is_finished(const BuildRange& range) const {
    if constexpr (MakesSubtrees<Finder>) return finder_.finishes(range);
    return range.size() <= 1;
  }

  Finder& finder_;
  Executor& executor_;
  BuildMonitor monitor_;
  std::size_t large_range_;
  AlignedBuffer<tree::Node> nodes_;
  AlignedBuffer<std::uint32_t> ids_;
};

/// The tree of `set` that a finder which owns its references makes. `make_finder(ReferenceSet&&)` returns the finder;
/// its `root(Executor&)` is the range of all references.
template <class MakeFinder>
Result<tree::BinaryTree> build_top_down(refs::ReferenceSet&& set, const BuildContext& context,
                                        const MakeFinder& make_finder, std::size_t large_range = kLargeRange) {
  const std::size_t count = set.references.size();
  const std::size_t primitive_count = set.primitive_count;
  AlignedBuffer<tree::Node> nodes;
  AlignedBuffer<std::uint32_t> ids;
  {
    auto finder = make_finder(std::move(set));
    TopDownDriver<decltype(finder)> driver(finder, count, context, large_range);
    if (!driver.run(finder.root(context.executor))) return cancelled_error();
    nodes = std::move(driver.nodes());
    ids = std::move(driver.ids());
  }  // the references are no longer needed: their memory goes before the canonical copy is made
  return tree::canonicalize(nodes.span(), ids.span(), primitive_count, false, context.executor);
}

}  // namespace boxwood::builders
