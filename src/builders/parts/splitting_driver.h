// The driver of top-down builders that split references: each range owns its references, whose number may grow.
//
// A split finder is a class with
//   Split find(const SplittingRange&, Executor&)   the split to make; Split::is_leaf() says to make none
//   void apply(const Split&, SplittingRange&&, Executor&, SplittingRange& left, SplittingRange& right)
//                                                  fills in references, bounds and spare of both
// It is called for disjoint ranges from several threads at once. A split that leaves one side empty, and every split
// past the depth limit, is replaced by halves of the references by centroid.
//
// Large ranges are split in rounds, breadth first, each by a parallel find and apply (or, once there are many, side by
// side); then each small range is finished by one thread into a tree of its own, and these are put together in order.
// Explicit stacks only. What is built does not depend on the number of threads.
#pragma once

#include <algorithm>
#include <vector>

#include "builders/parts/build_monitor.h"
#include "builders/parts/build_range.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/reference_budget.h"

namespace boxwood::builders {

struct SplittingRange {
  std::vector<refs::Reference> references;
  Box bounds;               ///< of all references
  Box cell;                 ///< the part of space it stands for, for finders that part space; others leave it alone
  std::uint64_t spare = 0;  ///< references that may be added below (reference_budget.h)
  std::uint32_t depth = 0;  ///< of its node; the root's is 0
  double share = 1;         ///< of the whole work, for progress

  std::size_t size() const { return references.size(); }
  void measure() {
    bounds = {};
    for (const refs::Reference& reference : references) bounds.grow(reference.box());
  }
};

/// Ranges up to this size are finished by one thread each. Cutting makes references dear, so these are small.
inline constexpr std::size_t kLargeSplittingRange = 1 << 12;

template <class Finder>
class SplittingDriver {
 public:
  /// Ranges of more references than `large_range` are worked on by all threads.
  SplittingDriver(Finder& finder, const BuildContext& context, std::size_t large_range = kLargeSplittingRange)
      : finder_(finder), executor_(context.executor), monitor_(context, kProgressSteps), large_range_(large_range) {}

  /// Builds over the references, of which the tree may have `spare` more. An error when it was cancelled or the tree
  /// has more references than 32-bit numbers can count.
  Result<tree::BinaryTree> run(refs::ReferenceSet&& set, std::uint64_t spare) {
    std::vector<SplittingRange> large(1);
    large[0].references.assign(set.references.begin(), set.references.end());
    large[0].measure();
    large[0].cell = large[0].bounds;
    large[0].spare = spare;
    // Spelt out: clang 14 forgets to emit the destructor for "= {}" in a template.
    set.references = AlignedBuffer<refs::Reference>();
    top_.push_back({large[0].bounds, 0, 0});
    std::vector<std::uint32_t> slots{0};  // the top nodes of the ranges
    std::vector<SplittingRange> small;
    std::vector<std::uint32_t> small_slots;
    while (!large.empty() && !monitor_.cancelled()) {
      std::vector<Children> children = split_round(large);
      std::vector<SplittingRange> next;
      std::vector<std::uint32_t> next_slots;
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (!children[i].split) {  // small, or a leaf: finish() finds that out again
          small.push_back(std::move(large[i]));
          small_slots.push_back(slots[i]);
          continue;
        }
        const auto first = static_cast<std::uint32_t>(top_.size());
        top_[slots[i]].first = first;
        for (SplittingRange* child : {&children[i].left, &children[i].right}) {
          next_slots.push_back(static_cast<std::uint32_t>(top_.size()));
          top_.push_back({child->bounds, 0, 0});
          next.push_back(std::move(*child));
        }
      }
      large = std::move(next);
      slots = std::move(next_slots);
    }
    std::vector<Subtree> subtrees(small.size());
    executor_.for_chunks(small.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      const double share = small[i].share;
      subtrees[i] = finish(std::move(small[i]));
      monitor_.finish(static_cast<std::size_t>(share * kProgressSteps));
    });
    if (monitor_.cancelled()) return cancelled_error();
    monitor_.finish(kProgressSteps);  // what rounding left over
    return join(subtrees, small_slots, set.primitive_count);
  }

 private:
  static constexpr std::size_t kProgressSteps = 1000000;
  /// Below this many ranges at once the threads share the work on each range, from here on the ranges.
  static constexpr std::size_t kManyRanges = 8;
  static constexpr std::uint32_t kSplittingDepthLimit = 96;

  struct Children {
    bool split = false;
    SplittingRange left, right;
  };
  struct Subtree {
    std::vector<tree::Node> nodes;
    std::vector<std::uint32_t> ids;
  };

  std::vector<Children> split_round(std::vector<SplittingRange>& ranges) {
    std::vector<Children> children(ranges.size());
    const auto split = [&](std::size_t i, Executor& executor) {
      if (ranges[i].size() > large_range_)
        children[i].split = split_or_leaf(ranges[i], executor, children[i].left, children[i].right);
    };
    if (ranges.size() < kManyRanges) {
      for (std::size_t i = 0; i < ranges.size(); ++i) split(i, executor_);
    } else {
      executor_.for_chunks(ranges.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
        SequentialExecutor sequential;
        split(i, sequential);
      });
    }
    return children;
  }

  /// True when the range was split (its references are gone then), false when it shall become a leaf.
  bool split_or_leaf(SplittingRange& range, Executor& executor, SplittingRange& left, SplittingRange& right) {
    if (range.size() <= 1) return false;
    const bool too_deep = range.depth >= kSplittingDepthLimit;
    if (!too_deep) {
      const auto split = finder_.find(range, executor);
      if (split.is_leaf()) return false;
      finder_.apply(split, std::move(range), executor, left, right);
    }
    if (too_deep || left.references.empty() || right.references.empty()) halve(range, left, right);
    const double all = static_cast<double>(left.size() + right.size());
    left.share = range.share * static_cast<double>(left.size()) / all;
    right.share = range.share - left.share;
    left.depth = right.depth = range.depth + 1;
    return true;
  }

  /// Halves by centroid on its widest axis. When a split failed, all references are on one of its sides.
  void halve(SplittingRange& range, SplittingRange& left, SplittingRange& right) {
    std::vector<refs::Reference> all = std::move(
        !left.references.empty() ? left.references : (!right.references.empty() ? right.references : range.references));
    Box centroids;
    for (const refs::Reference& reference : all) centroids.grow(reference.centroid2());
    const int axis = centroids.widest_axis();
    const auto mid = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::stable_sort(all.begin(), all.end(), [axis](const refs::Reference& a, const refs::Reference& b) {
      return a.centroid2(axis) < b.centroid2(axis);
    });
    left.references.assign(all.begin(), mid);
    right.references.assign(mid, all.end());
    left.measure();
    right.measure();
    left.cell = right.cell = range.cell;
    const SpareShares shares = share_rest(range.spare, all.size(), left.size(), right.size());
    left.spare = shares.left, right.spare = shares.right;
  }

  Subtree finish(SplittingRange root) {
    struct Waiting {
      SplittingRange range;
      std::uint32_t slot;
    };
    Subtree out;
    out.nodes.push_back({root.bounds, 0, 0});
    std::vector<Waiting> stack;
    stack.push_back({std::move(root), 0});
    SequentialExecutor sequential;
    while (!stack.empty() && !monitor_.cancelled()) {
      auto [range, slot] = std::move(stack.back());
      stack.pop_back();
      SplittingRange left, right;
      if (split_or_leaf(range, sequential, left, right)) {
        const auto first = static_cast<std::uint32_t>(out.nodes.size());
        out.nodes[slot] = {range.bounds, first, 0};
        out.nodes.push_back({left.bounds, 0, 0});
        out.nodes.push_back({right.bounds, 0, 0});
        stack.push_back({std::move(right), first + 1});
        stack.push_back({std::move(left), first});
      } else {
        out.nodes[slot].first = static_cast<std::uint32_t>(out.ids.size());
        out.nodes[slot].count = static_cast<std::uint32_t>(range.size());
        for (const refs::Reference& reference : range.references) out.ids.push_back(reference.primitive);
      }
    }
    if (stack.empty()) refit(out.nodes);  // else cancelled, and some nodes were never filled in
    return out;
  }

  /// Parts are boxed tighter than what they were cut from, so an inner box may have become larger than its children
  /// together. Children stand behind their parents.
  static void refit(std::vector<tree::Node>& nodes) {
    for (std::size_t i = nodes.size(); i-- > 0;)
      if (!nodes[i].is_leaf()) nodes[i].bounds = merge(nodes[nodes[i].first].bounds, nodes[nodes[i].first + 1].bounds);
  }

  Result<tree::BinaryTree> join(std::vector<Subtree>& subtrees, const std::vector<std::uint32_t>& slots,
                                std::size_t primitive_count) {
    std::size_t node_count = top_.size(), id_count = 0;
    for (const Subtree& subtree : subtrees) {
      node_count += subtree.nodes.size() - 1;
      id_count += subtree.ids.size();
    }
    if (id_count > kMostReferences)
      return {ErrorCode::too_large, "the tree would have " + std::to_string(id_count) + " references, more than " +
                                        std::to_string(kMostReferences)};
    top_.reserve(node_count);
    std::vector<std::uint32_t> ids;
    ids.reserve(id_count);
    for (std::size_t i = 0; i < subtrees.size(); ++i) {
      // A subtree's node k > 0 goes to `moved` + k; its root takes the slot that waits for it.
      const auto moved = static_cast<std::uint32_t>(top_.size()) - 1;
      const auto move = [&](tree::Node node) {
        node.first += node.is_leaf() ? static_cast<std::uint32_t>(ids.size()) : moved;
        return node;
      };
      top_[slots[i]] = move(subtrees[i].nodes[0]);
      for (std::size_t k = 1; k < subtrees[i].nodes.size(); ++k) top_.push_back(move(subtrees[i].nodes[k]));
      ids.insert(ids.end(), subtrees[i].ids.begin(), subtrees[i].ids.end());
      subtrees[i] = {};
    }
    refit(top_);
    return tree::canonicalize(top_, ids, primitive_count, true, executor_);
  }

  Finder& finder_;
  Executor& executor_;
  BuildMonitor monitor_;
  std::size_t large_range_;
  std::vector<tree::Node> top_;
};

/// The `build` function of a builder that splits, from its finder, which is made with the primitives, the box of all
/// references and the options.
template <class Finder>
Result<tree::BinaryTree> build_with_splits(refs::ReferenceSet&& set, const OptionValues& options,
                                           const BuildContext& context) {
  const std::shared_ptr<const refs::Primitives> primitives = set.primitives;
  Box bounds;
  for (const refs::Reference& reference : set.references) bounds.grow(reference.box());
  Finder finder(*primitives, bounds, options);
  const std::uint64_t spare = spare_references(set.references.size(), options.number(kGrowth));
  return SplittingDriver<Finder>(finder, context).run(std::move(set), spare);
}

}  // namespace boxwood::builders
