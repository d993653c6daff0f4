#include <gtest/gtest.h>

#include "unit/tree/trees.h"

namespace boxwood {
namespace {

TEST(Statistics, EmptyTree) {
  const tree::Statistics s = tree::statistics({});
  EXPECT_EQ(s.nodes + s.inner + s.leaves + s.references + s.max_depth + s.max_leaf, 0u);
  EXPECT_EQ(s.average_leaf, 0.0);
  EXPECT_TRUE(s.leaf_histogram.empty());
}

TEST(Statistics, CountsByHand) {
  // A leaf of 3 at depth 1, leaves of 1 and 2 at depth 2.
  testing::LooseTree loose;
  loose.boxes.assign(6, Box{{0, 0, 0}, {1, 1, 1}});
  loose.references = {0, 1, 2, 3, 4, 5};
  loose.nodes = {{loose.boxes[0], 1, 0},
                 {loose.boxes[0], 0, 3},
                 {loose.boxes[0], 3, 0},
                 {loose.boxes[0], 3, 1},
                 {loose.boxes[0], 4, 2}};
  const tree::Statistics s = tree::statistics(testing::canonical(loose));
  EXPECT_EQ(s.nodes, 5u);
  EXPECT_EQ(s.inner, 2u);
  EXPECT_EQ(s.leaves, 3u);
  EXPECT_EQ(s.references, 6u);
  EXPECT_EQ(s.max_depth, 2u);
  EXPECT_EQ(s.max_leaf, 3u);
  EXPECT_EQ(s.average_leaf, 2.0);
  EXPECT_DOUBLE_EQ(s.average_leaf_depth, 5.0 / 3.0);
  EXPECT_EQ(s.leaf_histogram, (std::vector<std::size_t>{0, 1, 1, 1}));
}

TEST(Statistics, AddUpOnRandomTrees) {
  const tree::BinaryTree tree = testing::canonical(testing::random_tree(3000, 4));
  const tree::Statistics s = tree::statistics(tree);
  EXPECT_EQ(s.leaves, 3000u);
  EXPECT_EQ(s.inner, 2999u);
  std::size_t leaves = 0, references = 0;
  for (std::size_t n = 0; n < s.leaf_histogram.size(); ++n)
    leaves += s.leaf_histogram[n], references += n * s.leaf_histogram[n];
  EXPECT_EQ(leaves, s.leaves);
  EXPECT_EQ(references, s.references);
}

TEST(Hash, SeesEveryBit) {
  const tree::BinaryTree tree = testing::canonical(testing::random_tree(100, 4));
  const std::uint64_t hash = tree::hash(tree);
  EXPECT_EQ(tree::hash(testing::copy(tree)), hash);
  for (std::size_t byte = 0; byte < tree.nodes.bytes(); byte += 13) {
    tree::BinaryTree changed = testing::copy(tree);
    reinterpret_cast<unsigned char*>(changed.nodes.data())[byte] ^= 1;
    EXPECT_NE(tree::hash(changed), hash);
  }
  for (std::size_t i = 0; i < tree.references.size(); i += 7) {
    tree::BinaryTree changed = testing::copy(tree);
    changed.references[i] ^= 1;
    EXPECT_NE(tree::hash(changed), hash);
  }
  EXPECT_NE(tree::hash({}), hash);
}

}  // namespace
}  // namespace boxwood
