// Leaves keep one reference to each primitive, in the order they had.
#include <gtest/gtest.h>

#include "boxwood/tree.h"

namespace boxwood::tree {
namespace {

TEST(RemoveDuplicates, EachLeafKeepsTheFirstOfEach) {
  BinaryTree tree;
  tree.primitive_count = 100;
  tree.splits_references = true;
  const Box box{{0, 0, 0}, {1, 1, 1}};
  std::vector<std::uint32_t> ids{3, 1, 3, 1, 2, 2, 2};
  for (std::uint32_t i = 0; i < 80; ++i) ids.push_back(i / 2);  // long enough for the other way of looking
  tree.nodes = AlignedBuffer<Node>(5);
  tree.nodes[0] = {box, 1, 0};
  tree.nodes[1] = {box, 3, 0};
  tree.nodes[2] = {box, 7, 80};
  tree.nodes[3] = {box, 0, 4};
  tree.nodes[4] = {box, 4, 3};
  tree.references = AlignedBuffer<std::uint32_t>(ids.size());
  std::copy(ids.begin(), ids.end(), tree.references.begin());
  remove_duplicates(tree);
  std::vector<std::uint32_t> expected{3, 1, 2};
  for (std::uint32_t i = 0; i < 40; ++i) expected.push_back(i);
  EXPECT_EQ(std::vector<std::uint32_t>(tree.references.begin(), tree.references.end()), expected);
  EXPECT_EQ(tree.nodes[3].first, 0u);
  EXPECT_EQ(tree.nodes[3].count, 2u);
  EXPECT_EQ(tree.nodes[4].first, 2u);
  EXPECT_EQ(tree.nodes[4].count, 1u);
  EXPECT_EQ(tree.nodes[2].first, 3u);
  EXPECT_EQ(tree.nodes[2].count, 40u);
}

}  // namespace
}  // namespace boxwood::tree
