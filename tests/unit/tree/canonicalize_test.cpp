#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "unit/tree/trees.h"

namespace boxwood {
namespace {

/// The definition, word for word: children are numbered when their parent is first visited, left before right.
void number_by_definition(const testing::LooseTree& loose, std::uint32_t input, std::size_t output,
                          std::vector<tree::Node>& nodes, std::vector<std::uint32_t>& references) {
  const tree::Node& node = loose.nodes[input];
  if (node.is_leaf()) {
    nodes[output] = {node.bounds, static_cast<std::uint32_t>(references.size()), node.count};
    for (std::uint32_t i = 0; i < node.count; ++i) references.push_back(loose.references[node.first + i]);
    return;
  }
  const std::size_t children = nodes.size();
  nodes.resize(children + 2);
  nodes[output] = {node.bounds, static_cast<std::uint32_t>(children), 0};
  number_by_definition(loose, node.first, children, nodes, references);
  number_by_definition(loose, node.first + 1, children + 1, nodes, references);
}

void expect_canonical(const testing::LooseTree& loose, const tree::BinaryTree& tree) {
  std::vector<tree::Node> nodes(1);
  std::vector<std::uint32_t> references;
  number_by_definition(loose, 0, 0, nodes, references);
  ASSERT_EQ(tree.nodes.size(), nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    ASSERT_EQ(tree.nodes[i].first, nodes[i].first) << "node " << i;
    ASSERT_EQ(tree.nodes[i].count, nodes[i].count) << "node " << i;
    ASSERT_EQ(tree.nodes[i].bounds, nodes[i].bounds) << "node " << i;
  }
  ASSERT_EQ(tree.references.size(), references.size());
  EXPECT_TRUE(std::equal(references.begin(), references.end(), tree.references.begin()));
}

TEST(Canonicalize, FollowsTheDefinition) {
  for (const std::size_t leaves : {1, 2, 3, 4, 10, 100, 1000})
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
      const testing::LooseTree loose = testing::random_tree(leaves, seed);
      expect_canonical(loose, testing::canonical(loose));
    }
}

TEST(Canonicalize, LargeTreesAreCutAndComeOutTheSameForAllThreads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const testing::LooseTree loose = testing::random_tree(60000, 3);
  const tree::BinaryTree expected = testing::canonical(loose);
  expect_canonical(loose, expected);
  for (const int threads : {2, 8}) {
    ThreadExecutor executor(threads);
    const tree::BinaryTree tree =
        tree::canonicalize(loose.nodes, loose.references, loose.boxes.size(), false, executor);
    EXPECT_EQ(tree::hash(tree), tree::hash(expected));
  }
}

TEST(Canonicalize, IsIdempotent) {
  const tree::BinaryTree tree = testing::canonical(testing::random_tree(20000, 5));
  SequentialExecutor executor;
  const tree::BinaryTree again =
      tree::canonicalize(tree.nodes.span(), tree.references.span(), tree.primitive_count, false, executor);
  EXPECT_EQ(tree::hash(again), tree::hash(tree));
}

TEST(Canonicalize, VeryDeepTrees) {
  for (const bool leaf_first : {true, false}) {
    const testing::LooseTree loose = testing::chain(200000, leaf_first);
    const tree::BinaryTree tree = testing::canonical(loose);
    EXPECT_EQ(tree.nodes.size(), 400001u);
    const Status valid = tree::validate(tree, {.primitive_boxes = loose.boxes, .max_leaf = 1});
    EXPECT_TRUE(valid) << valid.error().message;
    EXPECT_EQ(tree::statistics(tree).max_depth, 200000u);
  }
}

TEST(Canonicalize, KeepsFlagsAndHandlesNothing) {
  SequentialExecutor executor;
  const tree::BinaryTree empty = tree::canonicalize({}, {}, 5, true, executor);
  EXPECT_TRUE(empty.empty());
  EXPECT_EQ(empty.references.size(), 0u);
  EXPECT_EQ(empty.primitive_count, 5u);
  EXPECT_TRUE(empty.splits_references);
}

}  // namespace
}  // namespace boxwood
