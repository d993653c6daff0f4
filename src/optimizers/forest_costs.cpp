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

constexpr std::uint32_t kPairsPerTask = 16384;

using Costs = std::array<double, kLargestWidth + 1>;  // [i]: cost of a forest of i trees

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
};

class Stack {
 public:
  explicit Stack(int width) : width_(std::size_t(width)) {}
  void push(const Waiting& subtree, const Costs& opened) {
    subtrees_.push_back(subtree);
    opened_.insert(opened_.end(), opened.begin() + 2, opened.begin() + std::ptrdiff_t(width_) + 1);
  }
  /// False when there is none.
  bool pop(Waiting& subtree, Costs& opened) {
    if (subtrees_.empty()) return false;
    subtree = subtrees_.back();
    subtrees_.pop_back();
    std::copy(opened_.end() - std::ptrdiff_t(width_ - 1), opened_.end(), opened.begin() + 2);
    opened_.resize(opened_.size() - (width_ - 1));
    return true;
  }
  std::size_t size() const { return subtrees_.size(); }

 private:
  std::size_t width_;
  std::vector<Waiting> subtrees_;
  std::vector<double> opened_;  // D(n, 2) to D(n, width) of each
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
    for (std::uint32_t pair = run.end; pair-- > run.begin;) {
      Costs left{}, right{}, opened{};
      Waiting left_part, right_part;
      if (!close(2 * pair + 1, stack, left_part, left) || !close(2 * pair + 2, stack, right_part, right)) return false;
      if (right_part.first - left_part.first != left_part.count) return false;
      Choice choice;
      for (int trees = 2; trees <= width_; ++trees) {
        int best = 1;
        double cost = left[1] + right[std::size_t(trees) - 1];
        for (int k = 2; k < trees; ++k) {
          const double candidate = left[std::size_t(k)] + right[std::size_t(trees - k)];
          if (candidate < cost) cost = candidate, best = k;
        }
        opened[std::size_t(trees)] = cost;
        if (trees > 2) choice.set_left_trees(trees, best);
      }
      out_.choices[pair] = choice;
      out_.counts[pair] = left_part.count + right_part.count;
      stack.push({pair, left_part.first, left_part.count + right_part.count}, opened);
    }
    return true;
  }

  /// C(n, 1) to C(n, width) of a node whose subtree is done: on top of the stack, or a leaf.
  bool close(std::uint32_t n, Stack& stack, Waiting& part, Costs& costs) const {
    const tree::Node& node = tree_.nodes[n];
    const double node_area = weight(n) + least_area_;
    if (node.is_leaf()) {
      part = {0, node.first, node.count};
      if (node.first > tree_.references.size() || node.count > tree_.references.size() - node.first) return false;
      price_leaf(node_area, node.first, node.count, costs);
      return true;
    }
    if (!stack.pop(part, costs) || node.first != 2 * part.pair + 1) return false;
    Choice& choice = out_.choices[part.pair];
    double whole = node_area * node_cost_ + costs[std::size_t(width_)];
    if (part.count <= largest_leaf_) {
      // The fewest blocks first: most subtrees that are no leaf are none at any number.
      double leaf = node_area * double(divide_up(part.count, block_));
      if (leaf <= whole && leaf_blocks_) leaf = node_area * double(blocks_of(part.first, part.count));
      if (leaf <= whole) whole = leaf, choice.set_leaf();
    }
    costs[1] = whole;
    int from = 2;
    while (from <= width_ && !(costs[std::size_t(from)] < whole)) costs[std::size_t(from++)] = whole;
    if (from <= width_) choice.set_opened_from(from);
    return true;
  }

 private:
  double weight(std::uint32_t n) const {
    return node_weights_.empty() ? area(tree_.nodes[n].bounds) : double(node_weights_[n]);
  }

  /// Blocks of a leaf, or of all chunks of one above the limit.
  std::uint64_t blocks_of(std::uint32_t first, std::uint32_t count) const {
    if (!leaf_blocks_) return divide_up(count, block_);
    const std::span<const std::uint32_t> all = tree_.references.span();
    std::uint64_t blocks = 0;
    for (std::uint32_t done = 0; done < count; done += largest_leaf_)
      blocks += leaf_blocks_(all.subspan(first + done, std::min(largest_leaf_, count - done)));
    return blocks;
  }

  void price_leaf(double node_area, std::uint32_t first, std::uint32_t count, Costs& costs) const {
    const double blocks = double(blocks_of(first, count));
    const std::uint64_t chunks = divide_up(count, largest_leaf_);
    for (int trees = 1; trees <= width_; ++trees) {
      const double nodes = double(chunk_nodes(chunks, std::uint64_t(trees), std::uint64_t(width_)));
      costs[std::size_t(trees)] = node_area * (blocks + node_cost_ * nodes);
    }
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
  std::vector<Stack> stacks(tasks.size(), Stack(options.width));
  std::vector<std::uint8_t> good(tasks.size());
  executor.for_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t, std::size_t) {
    good[task] = programme.evaluate(runs[tasks[task]], stacks[task]) && stacks[task].size() == 1;
  });

  Stack stack(options.width);
  Waiting part;
  Costs costs{};
  std::size_t task = tasks.size();
  for (std::size_t r = runs.size(); r-- > 0;) {
    if (task > 0 && tasks[task - 1] == r) {
      if (!good[--task]) return malformed;
      stacks[task].pop(part, costs);
      stack.push(part, costs);
    } else if (!programme.evaluate(runs[r], stack)) {
      return malformed;
    }
  }
  if (!programme.close(0, stack, part, costs) || stack.size() != 0) return malformed;
  if (part.first != 0 || part.count != tree.references.size()) return malformed;
  out.root_cost = costs[1];
  return out;
}

}  // namespace boxwood::optimizers
