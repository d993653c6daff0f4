// The radix tree over sorted Morton codes (Lauterbach et al. 2009, bib key lbvh; Karras 2012, bib key karras2012): a
// range is divided where the highest bit that is not the same in all its codes changes; a range of equal codes is
// divided in the middle. So the depth is at most 63 plus the logarithm of the largest number of equal codes. Unlike
// Karras' tree, which gives every node a thread, ranges are divided from the top, by bisection, until they are small;
// the small ones are the parallel tasks, each made from left to right in linear time. How it is cut depends on the
// ranges only, so all thread counts give equal bits.
//
// Boxes and prices are made on the way back up. Unlike in the papers, where leaves are single references or what is
// left when the bits end, a range within the limit becomes a leaf where that is no dearer by the surface area
// heuristic. O(n log n).
#include "builders/parts/emit_morton.h"

#include <bit>

namespace boxwood::builders {
namespace {

constexpr std::uint32_t kTaskSize = 4096;

}  // namespace

/// A range and the position that divides it; 0 stands for "not divided, a task of its own".
struct MortonEmitter::Split {
  MortonRange range;
  std::uint32_t middle;
};

/// A subtree that may still get a right neighbour, and the bits in which its last code differs from the next one.
struct MortonEmitter::Waiting {
  EmittedSubtree subtree;
  std::uint32_t first;
  std::uint64_t step;
};

std::uint32_t MortonEmitter::middle(MortonRange range) const {
  const std::uint64_t first = order_[range.first].key, difference = first ^ order_[range.last - 1].key;
  if (difference == 0) return range.first + range.size() / 2;
  const std::uint64_t bit = std::bit_floor(difference);
  std::uint32_t zero = range.first, one = range.last - 1;  // the bit is 0 at the one and 1 at the other
  while (one - zero > 1) {
    const std::uint32_t between = zero + (one - zero) / 2;
    (order_[between].key & bit ? one : zero) = between;
  }
  return one;
}

EmittedSubtree MortonEmitter::leaf(std::uint32_t position) const {
  const Box box = references_[order_[position].index].box();
  return {{box, position, 1}, double(box.half_area()) * double(leaves_.cost.intersection)};
}

EmittedSubtree MortonEmitter::finish(const Split& split, const EmittedSubtree& left,
                                     const EmittedSubtree& right) const {
  const Box box = merge(left.root.bounds, right.root.bounds);
  const std::uint32_t count = split.range.size();
  const double area = double(box.half_area());
  const double inner_cost = area * double(leaves_.cost.traversal) + left.cost + right.cost;
  if (leaves_.largest == 0 || count <= leaves_.largest) {
    const double leaf_cost = area * double(leaves_.cost.intersection) * double(count);
    if (leaf_cost <= inner_cost) return {{box, split.range.first, count}, leaf_cost};
  }
  // Children of what became a leaf never touch the nodes' memory.
  nodes_[2 * std::size_t(split.middle) - 1] = left.root;
  nodes_[2 * std::size_t(split.middle)] = right.root;
  return {{box, 2 * split.middle - 1, 0}, inner_cost};
}

/// A range of equal codes, halved and halved again: some twelve levels at most.
EmittedSubtree MortonEmitter::emit_equal(MortonRange range) const {
  if (range.size() == 1) return leaf(range.first);
  const std::uint32_t m = range.first + range.size() / 2;
  const EmittedSubtree left = emit_equal({range.first, m}), right = emit_equal({m, range.last});
  return finish({range, m}, left, right);
}

/// From left to right: where codes differ in a lower bit than the next ones do, what lies on the two sides of that
/// place belongs together. That is the tree that division from the top makes, without a search for each place.
EmittedSubtree MortonEmitter::emit_small(MortonRange whole, std::vector<Waiting>& waiting) const {
  const auto differs_lower = [](std::uint64_t a, std::uint64_t b) { return a < b && a < (a ^ b); };
  waiting.clear();
  EmittedSubtree subtree;
  for (std::uint32_t first = whole.first, last; first < whole.last; first = last) {
    const std::uint64_t key = order_[first].key;
    for (last = first + 1; last < whole.last && order_[last].key == key;) ++last;
    subtree = emit_equal({first, last});
    const std::uint64_t step = last < whole.last ? key ^ order_[last].key : ~std::uint64_t{0};
    std::uint32_t begin = first;
    for (; !waiting.empty() && differs_lower(waiting.back().step, step); waiting.pop_back()) {
      subtree = finish({{waiting.back().first, last}, begin}, waiting.back().subtree, subtree);
      begin = waiting.back().first;
    }
    waiting.push_back({subtree, begin, step});
  }
  return subtree;
}

std::vector<EmittedSubtree> MortonEmitter::emit(std::span<const MortonRange> ranges, Executor& executor) const {
  std::vector<Split> splits;  // of the large ranges and, between them, the tasks, in depth-first order
  std::vector<MortonRange> tasks;
  std::vector<MortonRange> open(ranges.rbegin(), ranges.rend());
  while (!open.empty()) {
    const MortonRange range = open.back();
    open.pop_back();
    if (range.size() <= kTaskSize) {
      splits.push_back({range, 0});
      tasks.push_back(range);
      continue;
    }
    const std::uint32_t m = middle(range);
    splits.push_back({range, m});
    open.push_back({m, range.last});
    open.push_back({range.first, m});
  }

  // Treelets may be of a few references each, so several make a piece of work.
  std::vector<std::size_t> pieces{0};
  std::uint32_t size = 0;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    size += tasks[t].size();
    if (size < kTaskSize / 2 && t + 1 < tasks.size()) continue;
    pieces.push_back(t + 1);
    size = 0;
  }
  std::vector<EmittedSubtree> task_roots(tasks.size());
  executor.for_chunks(pieces.size() - 1, 1, [&](std::size_t piece, std::size_t, std::size_t) {
    std::vector<Waiting> waiting;
    for (std::size_t t = pieces[piece]; t < pieces[piece + 1]; ++t) {
      if (cancel_ && cancel_->load(std::memory_order_relaxed)) return;
      task_roots[t] = emit_small(tasks[t], waiting);
    }
  });

  std::vector<EmittedSubtree> made;
  const auto take = [&] {
    const EmittedSubtree subtree = made.back();
    made.pop_back();
    return subtree;
  };
  std::size_t task = tasks.size();
  for (std::size_t s = splits.size(); s-- > 0;) {
    if (splits[s].middle == 0) {
      made.push_back(task_roots[--task]);
      continue;
    }
    const EmittedSubtree left = take(), right = take();
    made.push_back(finish(splits[s], left, right));
  }
  return {made.rbegin(), made.rend()};  // they were made from the last range to the first
}

}  // namespace boxwood::builders
