#include "tree/join_pieces.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "unit/tree/trees.h"

namespace boxwood {
namespace {

/// A canonical tree taken to pieces: each stands at some place among the slots, its references at some other.
class TakenApart {
 public:
  /// Subtrees of at most `most` inner nodes, and some larger ones, become pieces.
  TakenApart(const tree::BinaryTree& tree, std::uint32_t most, std::uint32_t seed)
      : tree_(tree), most_(most), random_(seed) {
    inner_.resize(tree.nodes.size());
    for (std::size_t n = tree.nodes.size(); n-- > 0;)
      if (const tree::Node& node = tree.nodes[n]; !node.is_leaf())
        inner_[n] = 1 + inner_[node.first] + inner_[node.first + 1];
    top.resize(1);
    root = take(0);
    for (const auto& [node, slot] : first_pair_) top[node].pairs = slots.data() + slot;
  }

  std::vector<tree::TopNode> top;
  std::uint32_t root;
  std::vector<tree::Node> slots;
  std::vector<std::uint32_t> references;
  std::size_t pieces = 0;

 private:
  std::uint32_t take(std::uint32_t n) {
    const tree::Node& node = tree_.nodes[n];
    if (node.is_leaf() || inner_[n] <= most_ || random_() % 50 == 0) return take_piece(n);
    const std::uint32_t right = take(node.first + 1), left = take(node.first);  // whatever comes first
    top.push_back({.root = node, .left = left, .right = right});
    top.back().root.first = 0xdeadbeef;  // parents' boxes alone count
    return std::uint32_t(top.size() - 1);
  }

  std::uint32_t first_leaf(std::uint32_t n) const {
    while (!tree_.nodes[n].is_leaf()) n = tree_.nodes[n].first;
    return tree_.nodes[n].first;
  }
  std::uint32_t references_of(std::uint32_t n) const {
    const tree::Node& node = tree_.nodes[n];
    return node.is_leaf() ? node.count : references_of(node.first) + references_of(node.first + 1);
  }

  std::uint32_t take_piece(std::uint32_t n) {
    ++pieces;
    slots.resize(slots.size() + random_() % 5);
    references.resize(references.size() + random_() % 5, 0xdeadbeef);
    const auto slot = std::uint32_t(slots.size()), reference = std::uint32_t(references.size());
    const std::uint32_t first = first_leaf(n), count = references_of(n);
    tree::Node whole = tree_.nodes[n];
    const std::uint32_t pairs = whole.first;
    const auto moved = [&](tree::Node node) {
      node.first = node.is_leaf() ? node.first - first + reference : node.first - pairs + slot;
      return node;
    };
    for (std::uint32_t i = 0; i < 2 * inner_[n]; ++i) slots.push_back(moved(tree_.nodes[pairs + i]));
    for (std::uint32_t i = 0; i < count; ++i) references.push_back(tree_.references[first + i]);
    top.push_back({.root = moved(whole), .inner = inner_[n], .first_reference = reference, .reference_count = count});
    first_pair_.push_back({top.size() - 1, slot});
    return std::uint32_t(top.size() - 1);
  }

  const tree::BinaryTree& tree_;
  std::uint32_t most_;
  std::mt19937 random_;
  std::vector<std::uint32_t> inner_;
  std::vector<std::pair<std::size_t, std::uint32_t>> first_pair_;
};

TEST(JoinPieces, GivesTheTreeThatWasTakenApart) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  for (const std::size_t leaves : {1, 2, 3, 10, 1000, 5000})
    for (const std::uint32_t most : {0, 1, 7, 10000}) {
      const tree::BinaryTree tree = testing::canonical(testing::random_tree(leaves, std::uint32_t(leaves)));
      const TakenApart apart(tree, most, 1);
      EXPECT_EQ(apart.pieces == 1, leaves <= most + 1) << leaves << " leaves, at most " << most;
      for (const int threads : {1, 2, 8}) {
        ThreadExecutor executor(threads);
        const tree::BinaryTree joined =
            tree::join_pieces(apart.top, apart.root, apart.references, tree.primitive_count, executor);
        ASSERT_EQ(joined.nodes.size(), tree.nodes.size());
        EXPECT_EQ(joined.primitive_count, tree.primitive_count);
        EXPECT_EQ(tree::hash(joined), tree::hash(tree)) << leaves << " leaves, at most " << most;
      }
    }
}

TEST(JoinPieces, NeedsNoStackForChains) {
  const tree::BinaryTree tree = testing::canonical(testing::chain(200000, false));
  // Every leaf a piece, every inner node a top node.
  std::vector<tree::TopNode> top(1);
  std::vector<std::uint32_t> number(tree.nodes.size());
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    const tree::Node& node = tree.nodes[n];
    number[n] = std::uint32_t(top.size());
    if (node.is_leaf())
      top.push_back({.root = node, .first_reference = node.first, .reference_count = node.count});
    else
      top.push_back({.root = node, .left = number[node.first], .right = number[node.first + 1]});
  }
  SequentialExecutor executor;
  const tree::BinaryTree joined =
      tree::join_pieces(top, number[0], tree.references.span(), tree.primitive_count, executor);
  EXPECT_EQ(tree::hash(joined), tree::hash(tree));
}

}  // namespace
}  // namespace boxwood
