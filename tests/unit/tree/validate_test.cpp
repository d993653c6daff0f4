// The validator must accept what is right and name what is wrong: each test breaks one thing.
#include <gtest/gtest.h>

#include <functional>

#include "unit/tree/trees.h"

namespace boxwood {
namespace {

class Validate : public ::testing::Test {
 protected:
  const testing::LooseTree loose_ = testing::random_tree(50, 1);
  const tree::BinaryTree good_ = testing::canonical(loose_);

  Status check(const tree::BinaryTree& tree) const { return tree::validate(tree, {.primitive_boxes = loose_.boxes}); }

  void expect_error(const std::function<void(tree::BinaryTree&)>& damage, const std::string& sentence) const {
    tree::BinaryTree tree = testing::copy(good_);
    damage(tree);
    const Status status = check(tree);
    ASSERT_FALSE(status) << "expected: " << sentence;
    EXPECT_EQ(status.error().code, ErrorCode::malformed);
    EXPECT_NE(status.error().message.find(sentence), std::string::npos) << status.error().message;
  }

  std::uint32_t some_leaf(std::uint32_t least_references = 1) const {
    for (std::uint32_t i = 20; i < good_.nodes.size(); ++i)
      if (good_.nodes[i].count >= least_references) return i;
    return 0;
  }
  std::uint32_t some_inner() const {
    for (std::uint32_t i = 10; i < good_.nodes.size(); ++i)
      if (!good_.nodes[i].is_leaf()) return i;
    return 0;
  }
};

std::string node(std::uint32_t i) {
  return "node " + std::to_string(i);
}

TEST_F(Validate, AcceptsAGoodTree) {
  EXPECT_TRUE(check(good_));
  EXPECT_TRUE(tree::validate(good_, {.primitive_boxes = loose_.boxes, .max_leaf = 4}));
  EXPECT_TRUE(tree::validate(tree::BinaryTree{}, {}));
}

TEST_F(Validate, ChildrenInTheWrongPlace) {
  const std::uint32_t i = some_inner();
  expect_error([&](auto& t) { t.nodes[i].first += 2; }, node(i) + " has its children at");
  expect_error([&](auto& t) { t.nodes[i].first = 0; }, node(i) + " has its children at 0");
  expect_error([&](auto& t) { t.nodes[i].first = 0xffffffff; }, node(i) + " has its children at 4294967295");
}

TEST_F(Validate, LeafTurnedIntoInnerNodeAndBack) {
  const std::uint32_t leaf = some_leaf(), inner = some_inner();
  expect_error([&](auto& t) { t.nodes[leaf].count = 0; }, node(leaf) + " has its children at");
  expect_error([&](auto& t) { t.nodes[inner].count = 1; }, "leaf " + node(inner) + " begins at reference");
}

TEST_F(Validate, NodesMissingOrTooMany) {
  expect_error([](auto& t) { t.nodes.truncate(t.nodes.size() - 2); }, "past the last of");
  expect_error(
      [](auto& t) {
        AlignedBuffer<tree::Node> more(t.nodes.size() + 2);
        std::copy(t.nodes.begin(), t.nodes.end(), more.begin());
        more[t.nodes.size()] = more[t.nodes.size() + 1] = t.nodes[t.nodes.size() - 1];
        t.nodes = std::move(more);
      },
      "nodes can be reached from the root");
  expect_error([](auto& t) { t.nodes.truncate(0); }, "the leaves hold 0 references");
}

TEST_F(Validate, BoxesTooSmallOrTooLarge) {
  for (const std::uint32_t i : {some_inner(), some_leaf()}) {
    expect_error([&](auto& t) { t.nodes[i].bounds.lower.y = -1e6f; },
                 node(i) + " reaches out of the box of its parent");
    expect_error([&](auto& t) { t.nodes[i].bounds.upper.z = std::nanf(""); }, node(i));
  }
  expect_error([](auto& t) { t.nodes[0].bounds.upper.x += 1; }, "node 0 has a larger box than its children together");
  expect_error([](auto& t) { t.nodes[0].bounds.upper.x -= 0.5f; }, "reaches out of the box of its parent, node 0");
}

TEST_F(Validate, PrimitiveOutsideItsLeaf) {
  tree::BinaryTree tree = testing::copy(good_);
  std::vector<Box> boxes = loose_.boxes;
  boxes[tree.references[0]].upper.x += 2000;
  const Status status = tree::validate(tree, {.primitive_boxes = boxes});
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("whose box reaches out of the leaf's"), std::string::npos)
      << status.error().message;
}

TEST_F(Validate, LeavesOutOfOrderOrTooLong) {
  const std::uint32_t i = some_leaf();
  expect_error([&](auto& t) { ++t.nodes[i].first; }, "leaf " + node(i) + " begins at reference");
  expect_error([&](auto& t) { t.nodes[i].count = 0xffffffff; }, "leaf " + node(i) + " ends past the last of");
}

TEST_F(Validate, ReferencesMissingOrTooMany) {
  expect_error([](auto& t) { t.references.truncate(t.references.size() - 1); }, "ends past the last of");
  expect_error(
      [](auto& t) {
        AlignedBuffer<std::uint32_t> more(t.references.size() + 1);
        std::copy(t.references.begin(), t.references.end(), more.begin());
        more[t.references.size()] = 0;
        t.references = std::move(more);
      },
      "but the tree has");
}

TEST_F(Validate, PrimitivesUnknownTwiceOrMissing) {
  const std::uint32_t last = static_cast<std::uint32_t>(loose_.boxes.size());
  expect_error([&](auto& t) { t.references[7] = last; }, "holds primitive " + std::to_string(last) + " of only");

  const std::uint32_t leaf = some_leaf(2), first = good_.nodes[leaf].first;
  expect_error([&](auto& t) { t.references[first + 1] = t.references[first]; }, "which an earlier leaf holds too");

  std::vector<Box> boxes = loose_.boxes;
  boxes[3] = Box{};
  Status status = tree::validate(good_, {.primitive_boxes = boxes});
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("primitive 3, which must not be in the tree"), std::string::npos);

  tree::BinaryTree tree = testing::copy(good_);
  ++tree.primitive_count;
  boxes = loose_.boxes;
  boxes.push_back({{0, 0, 0}, {1, 1, 1}});
  status = tree::validate(tree, {.primitive_boxes = boxes});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "primitive " + std::to_string(last) + " is in no leaf");
  EXPECT_FALSE(tree::validate(tree::BinaryTree{}, {.primitive_boxes = boxes}));
}

TEST_F(Validate, PrimitiveCountAndLeafLimit) {
  expect_error([](auto& t) { ++t.primitive_count; }, "not over the");
  const Status status = tree::validate(good_, {.primitive_boxes = loose_.boxes, .max_leaf = 2});
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("more than 2"), std::string::npos);
}

/// One primitive from x = 0 to 4 in two leaves that meet at x = 2.
testing::LooseTree split_tree() {
  testing::LooseTree loose;
  loose.boxes = {{{0, 0, 0}, {4, 1, 1}}};
  loose.references = {0, 0};
  loose.nodes = {{loose.boxes[0], 1, 0}, {{{0, 0, 0}, {2, 1, 1}}, 0, 1}, {{{2, 0, 0}, {4, 1, 1}}, 1, 1}};
  return loose;
}

Status check_split(const testing::LooseTree& loose, bool splits) {
  tree::BinaryTree tree = testing::canonical(loose);
  tree.splits_references = splits;
  tree.nodes[0].bounds = merge(tree.nodes[1].bounds, tree.nodes[2].bounds);
  return tree::validate(tree, {.primitive_boxes = loose.boxes});
}

TEST(ValidateSplit, PiecesMustCoverTheBox) {
  EXPECT_TRUE(check_split(split_tree(), true));
  EXPECT_FALSE(check_split(split_tree(), false)) << "only a tree that says so may split references";

  testing::LooseTree gap = split_tree();
  gap.nodes[2].bounds.lower.x = 2.5f;
  EXPECT_NE(check_split(gap, true).error().message.find("do not cover its box on axis x"), std::string::npos);

  testing::LooseTree short_end = split_tree();
  short_end.nodes[2].bounds.upper.x = 3.5f;
  EXPECT_NE(check_split(short_end, true).error().message.find("on axis x"), std::string::npos);

  testing::LooseTree thin = split_tree();
  thin.nodes[1].bounds.upper.z = thin.nodes[2].bounds.upper.z = 0.5f;
  EXPECT_NE(check_split(thin, true).error().message.find("on axis z"), std::string::npos);

  testing::LooseTree apart = split_tree();
  apart.nodes[2].bounds = {{5, 0, 0}, {6, 1, 1}};
  EXPECT_NE(check_split(apart, true).error().message.find("does not touch"), std::string::npos);

  testing::LooseTree missing = split_tree();
  missing.boxes.push_back({{0, 0, 0}, {1, 1, 1}});
  EXPECT_NE(check_split(missing, true).error().message.find("primitive 1 is in no leaf"), std::string::npos);
}

}  // namespace
}  // namespace boxwood
