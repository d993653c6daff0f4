// Cheapest forests by dynamic programming (Ylitie, Karras and Laine 2017, bib key ylitie2017, section 3.1; Pinto 2010,
// bib key pinto2010). With a(n) the area of node n, or the weight given for it, and w the width:
//   leaf(n)   = a(n) * ceil(count / block), when the count is within the limit
//   C(n, 1)   = min(leaf(n), a(n) * node_cost + D(n, w))
//   D(n, i)   = min over k of C(left, k) + C(right, i - k)
//   C(n, i)   = min(C(n, 1), D(n, i))
// C never rises with i, so neither does D, and C(n, i - 1) in the papers' last line may be C(n, 1): one number per node
// says from which i on it is opened. Beyond the papers: leaves priced in whole blocks, binary leaves above the limit.
//
// Only the choices are kept, 12 bytes per inner node. Costs (doubles) live on a stack: canonical trees number pairs of
// children in the preorder of their parents, so going backwards meets a node when its children's costs are on top.
// Subtrees of at most kPairsPerTask pairs are runs of that order and independent: they may run at the same time, and
// give the same bits as when they do not. O(nodes * width^2).
#include "optimizers/forest_costs.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "optimizers/leaf_chunks.h"

namespace boxwood::optimizers {
namespace {

constexpr std::uint32_t kPairsPerTask = 4096;

/// What a subtree costs as a forest of so many trees: it never rises with their number.
struct Costs {
  std::array<double, kLargestWidth + 1> of;  ///< [i]: of a forest of i trees, up to `last`; from there on it stays
  int last;
};

double area(const Box& box) {
  if (box.is_empty()) return 0;
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

/// Pairs [begin, end) of children: one pair, or all pairs of one subtree.
struct Run {
  std::uint32_t begin, end;
};

/// A subtree whose parent has not been reached yet.
struct Waiting {
  std::uint32_t pair, first, count;
  Costs opened;  ///< D(n, 2) and up
};

struct Subtree {
  std::uint32_t first, count;
  Costs costs;  ///< C(n, 1) and up
};

class Stack {
 public:
  /// Room for one more, to be filled in.
  Waiting& push() {
    if (size_ == entries_.size()) entries_.resize(2 * size_ + 16);
    return entries_[size_++];
  }
  /// The last one, good until the next push; null when there is none.
  Waiting* pop() { return size_ == 0 ? nullptr : &entries_[--size_]; }
  std::size_t size() const { return size_; }

 private:
  std::vector<Waiting> entries_;
  std::size_t size_ = 0;
};

class Programme {
 public:
  Programme(const tree::BinaryTree& tree, const CollapseOptions& options, ForestCosts& out)
      : tree_(tree),
        width_(options.width),
        block_(std::uint32_t(options.block)),
        largest_leaf_(largest_leaf(options)),
        node_cost_(double(options.node_cost)),
        leaf_blocks_(options.leaf_blocks),
        node_weights_(options.node_weights),
        out_(out) {
    // Points and segments have no area, and everything below them would be equally good. A trillionth of the root's
    // area on top of every node's makes fewer nodes and blocks better there and changes nothing elsewhere.
    const double root_area = weight(0);
    least_area_ = root_area > 0 ? std::ldexp(root_area, -40) : 1;
  }

  std::uint32_t pairs() const { return std::uint32_t(tree_.nodes.size() / 2); }

  /// Cuts the pairs into runs, in order. False: not canonical.
  bool plan(std::vector<Run>& runs) const {
    if (pairs() == 0) return true;
    if (tree_.nodes[0].is_leaf() || tree_.nodes[0].first != 1) return false;
    std::vector<Run> subtrees{{0, pairs()}};
    while (!subtrees.empty()) {
      const auto [begin, end] = subtrees.back();
      subtrees.pop_back();
      if (end - begin <= kPairsPerTask) {
        runs.push_back({begin, end});
        continue;
      }
      runs.push_back({begin, begin + 1});
      const tree::Node &left = tree_.nodes[2 * begin + 1], &right = tree_.nodes[2 * begin + 2];
      const std::uint32_t middle = right.is_leaf() ? end : ForestCosts::pair_of(right);
      if (middle <= begin || middle > end || (left.is_leaf() && middle != begin + 1)) return false;
      if (middle < end) subtrees.push_back({middle, end});
      if (begin + 1 < middle) subtrees.push_back({begin + 1, middle});
    }
    return true;
  }

  /// Works through the pairs of a run from back to front. False: not canonical.
  bool evaluate(Run run, Stack& stack) const {
    Subtree left, right;
    for (std::uint32_t pair = run.end; pair-- > run.begin;) {
      if (!close(2 * pair + 1, stack, left) || !close(2 * pair + 2, stack, right)) return false;
      if (right.first - left.first != left.count) return false;
      out_.counts[pair] = left.count + right.count;
      Waiting& whole = stack.push();
      whole.pair = pair;
      whole.first = left.first;
      whole.count = left.count + right.count;
      out_.choices[pair] = share(left.costs, right.costs, whole.opened);
    }
    return true;
  }

  /// C(n, 1) to C(n, width) of a node whose subtree is done: on top of the stack, or a leaf.
  bool close(std::uint32_t n, Stack& stack, Subtree& subtree) const {
    const tree::Node& node = tree_.nodes[n];
    const double node_area = weight(n) + least_area_;
    if (node.is_leaf()) {
      if (node.first > tree_.references.size() || node.count > tree_.references.size() - node.first) return false;
      subtree.first = node.first;
      subtree.count = node.count;
      price_leaf(node_area, node.first, node.count, subtree.costs);
      return true;
    }
    const Waiting* const waiting = stack.pop();
    if (waiting == nullptr || node.first != 2 * waiting->pair + 1) return false;
    subtree.first = waiting->first;
    subtree.count = waiting->count;
    Choice& choice = out_.choices[waiting->pair];
    const Costs& opened = waiting->opened;
    double whole = node_area * node_cost_ + opened.of[std::size_t(opened.last)];
    if (subtree.count <= largest_leaf_) {
      // The fewest blocks first: most subtrees that are no leaf are none at any number.
      double leaf = node_area * double(blocks_by_count(subtree.count));
      if (leaf <= whole && leaf_blocks_) leaf = node_area * double(blocks_of(subtree.first, subtree.count));
      if (leaf <= whole) whole = leaf, choice.set_leaf();
    }
    Costs& costs = subtree.costs;
    costs.last = 1;
    for (int trees = 1; trees <= opened.last; ++trees) {
      const bool opens = trees > 1 && opened.of[std::size_t(trees)] < whole;
      if (opens && costs.last == 1) choice.set_opened_from(trees);
      if (opens) costs.last = opened.last;
      costs.of[std::size_t(trees)] = opens ? opened.of[std::size_t(trees)] : whole;
    }
    return true;
  }

 private:
  double weight(std::uint32_t n) const {
    return node_weights_.empty() ? area(tree_.nodes[n].bounds) : double(node_weights_[n]);
  }

  /// In 32 bits: divisions by 64-bit numbers take long.
  std::uint32_t blocks_by_count(std::uint32_t count) const { return (count + block_ - 1) / block_; }

  /// Blocks of a leaf, or of all chunks of one above the limit.
  std::uint64_t blocks_of(std::uint32_t first, std::uint32_t count) const {
    if (!leaf_blocks_) return blocks_by_count(count);
    const std::span<const std::uint32_t> all = tree_.references.span();
    std::uint64_t blocks = 0;
    for (std::uint32_t done = 0; done < count; done += largest_leaf_)
      blocks += leaf_blocks_(all.subspan(first + done, std::min(largest_leaf_, count - done)));
    return blocks;
  }

  void price_leaf(double node_area, std::uint32_t first, std::uint32_t count, Costs& costs) const {
    const double blocks = double(blocks_of(first, count));
    costs.of[1] = node_area * blocks;
    costs.last = 1;
    if (count <= largest_leaf_) return;
    const std::uint64_t chunks = divide_up(count, largest_leaf_);
    for (int trees = 1; trees <= width_; ++trees) {
      const double nodes = double(chunk_nodes(chunks, std::uint64_t(trees), std::uint64_t(width_)));
      costs.of[std::size_t(trees)] = node_area * (blocks + node_cost_ * nodes);
      if (costs.of[std::size_t(trees)] < costs.of[std::size_t(costs.last)]) costs.last = trees;
    }
  }

  /// D(n, 2) and up of a node with these children, and how many trees each of them gives. No more trees than both of
  /// them have a use for are looked at: most subtrees are small. Ties: the fewest on the left.
  Choice share(const Costs& left, const Costs& right, Costs& opened) const {
    const int all = left.last + right.last;
    Choice choice;
    opened.last = std::min(all, width_);
    for (int trees = 2; trees <= opened.last; ++trees) {
      int best = std::max(1, trees - right.last);
      while (best > 1 && left.of[std::size_t(best) - 1] == left.of[std::size_t(best)]) --best;
      double cost = left.of[std::size_t(best)] + right.of[std::size_t(std::min(trees - best, right.last))];
      for (int k = std::max(best + 1, trees - right.last); k <= std::min(trees - 1, left.last); ++k) {
        const double candidate = left.of[std::size_t(k)] + right.of[std::size_t(trees - k)];
        if (candidate < cost) cost = candidate, best = k;
      }
      opened.of[std::size_t(trees)] = cost;
      if (trees > 2) choice.set_left_trees(trees, best);
    }
    if (all < width_) choice.set_left_trees_from(std::max(3, all + 1), left.last);
    return choice;
  }

  const tree::BinaryTree& tree_;
  int width_;
  std::uint32_t block_, largest_leaf_;
  double node_cost_, least_area_;
  const std::function<std::uint32_t(std::span<const std::uint32_t>)>& leaf_blocks_;
  std::span<const float> node_weights_;
  ForestCosts& out_;
};

Error not_canonical(std::size_t nodes) {
  return {ErrorCode::malformed, "the binary tree of " + std::to_string(nodes) +
                                    " nodes is not in canonical form: children must stand in pairs, numbered depth "
                                    "first, and references in the order of the leaves"};
}

}  // namespace

Result<ForestCosts> price_forests(const tree::BinaryTree& tree, const CollapseOptions& options, Executor& executor) {
  const Error malformed = not_canonical(tree.nodes.size());
  if (tree.nodes.size() % 2 == 0) return malformed;
  ForestCosts out;
  const Programme programme(tree, options, out);
  std::vector<Run> runs;
  if (!programme.plan(runs)) return malformed;
  out.choices = AlignedBuffer<Choice>(programme.pairs());
  out.counts = AlignedBuffer<std::uint32_t>(programme.pairs());

  std::vector<std::uint32_t> tasks;  // runs of more than one pair: whole subtrees
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (runs[r].end - runs[r].begin > 1) tasks.push_back(std::uint32_t(r));
  std::vector<Stack> stacks(tasks.size());
  std::vector<std::uint8_t> good(tasks.size());
  executor.for_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t, std::size_t) {
    good[task] = programme.evaluate(runs[tasks[task]], stacks[task]) && stacks[task].size() == 1;
  });

  Stack stack;
  Subtree whole;
  std::size_t task = tasks.size();
  for (std::size_t r = runs.size(); r-- > 0;) {
    if (task > 0 && tasks[task - 1] == r) {
      if (!good[--task]) return malformed;
      stack.push() = *stacks[task].pop();
    } else if (!programme.evaluate(runs[r], stack)) {
      return malformed;
    }
  }
  if (!programme.close(0, stack, whole) || stack.size() != 0) return malformed;
  if (whole.first != 0 || whole.count != tree.references.size()) return malformed;
  out.root_cost = whole.costs.of[1];
  return out;
}

}  // namespace boxwood::optimizers
