// The radix tree over sorted Morton codes (Lauterbach et al. 2009, bib key lbvh; Karras 2012, bib key karras2012): a
// range is divided where the highest bit that is not the same in all its codes changes; a range of equal codes is
// divided in the middle. So the depth is at most 63 plus the logarithm of the largest number of equal codes. Unlike
// Karras' tree, which gives every node a thread, ranges are divided from the top, by bisection, until they are small;
// the small ones are the parallel tasks, each made in one go in linear time. How it is cut depends on the ranges only,
// so all thread counts give equal bits.
//
// A small range is made from its last reference to its first. A node is finished when both of its children are, the
// right one first; so when each pair of children is written in front of the pairs before it, a subtree stands in
// preorder, left before right, which is canonical order, and nothing has to be put in order afterwards. Pairs whose
// node became a leaf are those written last.
//
// Boxes and prices are made on the way back up. Unlike in the papers, where leaves are single references or what is
// left when the bits end, a range within the limit becomes a leaf where that is no dearer by the surface area
// heuristic. So many references as cost no more together than a node alone are a leaf whatever their boxes: such
// subtrees are found as a whole, and the tree is made of them. O(n log n).
#include "builders/parts/emit_morton.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "builders/parts/box4.h"

namespace boxwood::builders {
namespace {

constexpr std::uint32_t kTaskSize = 4096;
/// References are read in sorted order, so the next ones can be asked for in time.
constexpr std::uint32_t kAhead = 16;
/// Differs from codes of 63 bits in a higher one.
constexpr std::uint64_t kEnd = ~std::uint64_t{0};

double area(const Box4& box) {
  return double(half_area(box.upper - box.lower));
}

/// How many references cost no more together than a node alone, so that nothing below it can make up for it; by more
/// than rounding, at least one and at most eight.
std::uint32_t leaves_for_sure(double traversal, double intersection) {
  const double sure = traversal / intersection * (1 - 1e-9);
  return sure >= 8 ? 8 : sure >= 1 ? std::uint32_t(sure) : 1;
}

Box4 merge(const Box4& a, const Box4& b) {
  return {minimum(a.lower, b.lower), maximum(a.upper, b.upper)};
}

}  // namespace

/// A range, the position that divides it (0: not divided, a task of its own), and the number of its top node.
struct MortonEmitter::Split {
  MortonRange range;
  std::uint32_t middle;
  std::uint32_t node;
};

/// A subtree whose root has no place yet, with its price: the sum over its nodes of area times cost.
struct MortonEmitter::Subtree {
  Box4 box;  ///< fourth lanes are zero
  double cost;
  std::uint32_t first;  ///< a leaf's position, or where the writer has its children
  std::uint32_t count;  ///< references of a leaf, 0: not a leaf
  std::uint32_t inner;

  void store(tree::Node& node) const {
    box.lower.store_anywhere(&node.bounds.lower.x);
    box.upper.store_anywhere(reinterpret_cast<float*>(&node) + 3);  // and over `first`
    node.first = first;
    node.count = count;
  }
};
static_assert(offsetof(tree::Node, first) == 24);

/// Makes the subtree of one small range.
struct MortonEmitter::Writer {
  /// A subtree that may still get a left neighbour, and the bits in which its first code differs from the one before.
  struct Waiting {
    Subtree subtree;
    std::uint32_t last;
    std::uint64_t step;
  };

  Writer(MortonEmitter& emitter, std::uint32_t references_at_most)
      : order(emitter.order_),
        references(emitter.references_),
        largest_leaf(emitter.leaves_.largest == 0 ? ~std::uint32_t{0} : emitter.leaves_.largest),
        traversal(double(emitter.leaves_.cost.traversal)),
        intersection(double(emitter.leaves_.cost.intersection)),
        sure_leaf(std::min(largest_leaf, leaves_for_sure(traversal, intersection))),
        primitives(emitter.primitives_.data()),
        pairs(2 * std::size_t{references_at_most}),
        next(2 * references_at_most) {}

  /// The leaf over a range.
  void make_leaf(MortonRange range, Subtree& leaf) const {
    leaf.box = Box4::empty();
    for (std::uint32_t position = range.first; position < range.last; ++position) {
      const refs::Reference& reference = references[order[position].index];
      prefetch(&references[order[std::max(position, kAhead) - kAhead].index]);
      primitives[position] = reference.primitive;
      leaf.box = merge(leaf.box, Box4::of(reference));
    }
    leaf.box.lower = leaf.box.lower & mask;
    leaf.cost = area(leaf.box) * intersection * double(range.size());
    leaf.first = range.first;
    leaf.count = range.size();
    leaf.inner = 0;
  }

  /// The leaf over the positions from `first` on, if it is no dearer than its subtree.
  bool becomes_leaf(std::uint32_t first, std::uint32_t count, Subtree& whole) const {
    if (count > largest_leaf) return false;
    const double leaf_cost = area(whole.box) * intersection * double(count);
    if (!(leaf_cost <= whole.cost)) return false;
    whole.cost = leaf_cost;
    whole.first = first;
    whole.count = count;
    whole.inner = 0;
    return true;
  }

  Subtree over(const Subtree& left, const Subtree& right) const {
    Subtree whole;
    whole.box = merge(left.box, right.box);
    whole.cost = area(whole.box) * traversal + left.cost + right.cost;
    whole.count = 0;
    whole.inner = left.inner + right.inner + 1;
    return whole;
  }

  /// `right` becomes the parent of two subtrees over [first, last), the ones made last.
  void finish(std::uint32_t first, std::uint32_t last, const Subtree& left, Subtree& right) {
    Subtree whole = over(left, right);
    if (becomes_leaf(first, last - first, whole)) {
      next += 2 * (left.inner + right.inner);
    } else {
      next -= 2;
      left.store(pairs[next]);
      right.store(pairs[next + 1]);
      whole.first = next;
    }
    right = whole;
  }

  /// A range of equal codes, halved and halved again: some twelve levels at most.
  void make_equal(MortonRange range, Subtree& whole) {
    if (range.size() <= sure_leaf) return make_leaf(range, whole);
    const std::uint32_t middle = range.first + range.size() / 2;
    make_equal({middle, range.last}, whole);
    Subtree left;
    make_equal({range.first, middle}, left);
    finish(range.first, range.last, left, whole);
  }

  /// The first position of the largest subtree within `whole` that ends at `last` and is a leaf for sure; `last` if
  /// there is none, because too many codes are equal. `step`: the bits in which the codes before and at `last` differ.
  /// All candidates are looked at, since which one it will be is hard to foresee.
  std::uint32_t find_leaf(MortonRange whole, std::uint32_t last, std::uint64_t step) const {
    const auto differs_higher = [](std::uint64_t bits, std::uint64_t than) {
      return std::uint32_t{(bits & ~than) > than};
    };
    std::uint32_t sizes = 1;                              // a bit for each that is possible
    std::uint64_t inside = 0, key = order[last - 1].key;  // bits in which codes of the candidate differ
    const std::uint32_t most = std::min(sure_leaf + 1, last - whole.first);
    for (std::uint32_t size = 1; size < most; ++size) {
      const std::uint64_t left = order[last - size - 1].key, left_step = key ^ left;
      sizes |= (differs_higher(left_step, inside) & differs_higher(step, inside)) << size;
      inside |= left_step;
      key = left;
    }
    if (most <= sure_leaf) sizes |= differs_higher(step, inside) << most;  // all that is left
    return last + 1 - std::uint32_t(std::bit_width(sizes));
  }

  /// From right to left: where codes differ in a lower bit than the ones before do, what lies on the two sides of that
  /// place belongs together. That is the tree that division from the top makes, without a search for each place.
  const Subtree& make(MortonRange whole) {
    const auto differs_lower = [](std::uint64_t a, std::uint64_t b) { return a < b && a < (a ^ b); };
    Waiting* top = waiting.data();  // being made; those below it wait
    std::uint64_t step = kEnd;
    for (std::uint32_t last = whole.last, first; last > whole.first; last = first) {
      first = find_leaf(whole, last, step);
      if (first < last) {
        make_leaf({first, last}, top->subtree);
      } else {
        const std::uint64_t key = order[last - 1].key;
        for (first = last - 1; first > whole.first && order[first - 1].key == key;) --first;
        make_equal({first, last}, top->subtree);
      }
      top->last = last;
      step = first > whole.first ? order[first].key ^ order[first - 1].key : kEnd;
      for (; top != waiting.data() && differs_lower(top[-1].step, step); --top)
        finish(first, top[-1].last, top->subtree, top[-1].subtree);
      top->step = step;
      ++top;
    }
    return waiting[0].subtree;
  }

  std::span<const KeyedIndex> order;
  std::span<const refs::Reference> references;
  std::uint32_t largest_leaf;
  double traversal, intersection;
  std::uint32_t sure_leaf;  ///< so many references are a leaf whatever their boxes; at least one
  std::uint32_t* primitives;
  Float4 mask = xyz_mask();
  /// Room for two nodes per reference, of which leaves of several leave most free: so it is small and used again.
  AlignedBuffer<tree::Node> pairs;
  std::uint32_t next = 0;           ///< nodes from here on are made
  std::array<Waiting, 65> waiting;  ///< each step's highest bit is lower than that of the one below, but the last's
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

LargeVector<std::uint32_t> MortonEmitter::emit(std::span<const MortonRange> ranges, LargeVector<tree::TopNode>& top,
                                               Executor& executor) {
  LargeVector<std::uint32_t> roots(ranges.size());
  LargeVector<Split> splits;  // of the large ranges, parents before children
  LargeVector<Split> tasks;   // from left to right
  std::vector<Split> open;
  const auto open_node = [&](MortonRange range) {
    open.push_back({range, 0, std::uint32_t(top.size())});
    top.emplace_back();
    return open.back().node;
  };
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    roots[r] = open_node(ranges[r]);
    while (!open.empty()) {
      Split split = open.back();
      open.pop_back();
      if (split.range.size() <= kTaskSize) {
        tasks.push_back(split);
        continue;
      }
      split.middle = middle(split.range);
      splits.push_back(split);
      const std::uint32_t right = open_node({split.middle, split.range.last});
      const std::uint32_t left = open_node({split.range.first, split.middle});
      top[split.node].left = left;
      top[split.node].right = right;
    }
  }

  // Treelets may be of a few references each, so several make a piece of work.
  std::vector<std::size_t> works{0};
  std::uint32_t size = 0;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    size += tasks[t].range.size();
    if (size < kTaskSize / 2 && t + 1 < tasks.size()) continue;
    works.push_back(t + 1);
    size = 0;
  }
  LargeVector<Subtree> made(splits.empty() ? 0 : top.size());
  const auto place = [&](const Split& split, const Subtree& subtree) {
    tree::TopNode& node = top[split.node];
    subtree.store(node.root);
    if (!made.empty()) made[split.node] = subtree;
    node.inner = subtree.inner;
    node.first_reference = split.range.first;
    node.reference_count = split.range.size();
  };
  pairs_.resize(works.size() - 1);
  executor.for_chunks(works.size() - 1, 1, [&](std::size_t work, std::size_t, std::size_t) {
    const std::span<const Split> own = std::span(tasks).subspan(works[work], works[work + 1] - works[work]);
    Writer writer(*this, own.back().range.last - own.front().range.first);
    for (const Split& task : own) {
      if (cancel_ && cancel_->load(std::memory_order_relaxed)) return;
      place(task, writer.make(task.range));
    }
    const std::span<const tree::Node> pairs = writer.pairs.span().subspan(writer.next);
    pairs_[work] = AlignedBuffer<tree::Node>(pairs.size());
    std::copy(pairs.begin(), pairs.end(), pairs_[work].begin());
    for (const Split& task : own)
      if (tree::TopNode& node = top[task.node]; node.inner > 0)
        node.pairs = pairs_[work].data() + (node.root.first - writer.next);
  });

  const Writer writer(*this, 0);
  for (std::size_t s = splits.size(); s-- > 0;) {
    tree::TopNode& node = top[splits[s].node];
    Subtree whole = writer.over(made[node.left], made[node.right]);
    whole.first = 0;
    if (writer.becomes_leaf(splits[s].range.first, splits[s].range.size(), whole)) node.left = node.right = 0;
    place(splits[s], whole);
  }
  return roots;
}

}  // namespace boxwood::builders
