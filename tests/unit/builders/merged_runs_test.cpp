// Builders over runs of references: which runs there are, and that their members stay together and all arrive.
#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "support/effort.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood {
namespace {

using Settings = std::map<std::string, std::string>;

/// The first reference of each run, from the definition.
std::vector<std::uint32_t> first_of_runs(const testing::Boxes& boxes, std::size_t most, float growth) {
  constexpr std::size_t kChunk = 16384;  // runs do not cross the borders of chunks
  std::vector<std::uint32_t> first;
  std::size_t length = most;
  Box box;
  float parts = 0;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const Box joined = merge(box, boxes[i]);
    const float with_this = parts + boxes[i].half_area();
    const bool joins = length < most && i % kChunk != 0 && joined.half_area() <= growth * with_this;
    if (!joins) first.push_back(i);
    length = joins ? length + 1 : 1;
    box = joins ? joined : boxes[i];
    parts = joins ? with_this : boxes[i].half_area();
  }
  return first;
}

tree::BinaryTree build(refs::ReferenceSet&& set, const char* builder, const Settings& settings) {
  SequentialExecutor executor;
  auto tree = builders::build(std::move(set), {builder, settings}, {executor});
  EXPECT_TRUE(tree) << tree.error().message;
  return std::move(*tree);
}

double merged(const tree::BinaryTree& tree) {
  for (const auto& [key, value] : tree.notes)
    if (key == "references after merging") return value;
  return -1;
}

constexpr const char* kBuilders[] = {"binned-sah", "sweep-sah", "lbvh", "hlbvh"};

TEST(MergedRuns, AreThoseOfTheDefinitionAndStayTogether) {
  const testing::Boxes boxes = testing::height_field(test::effort(130, 2));
  for (const std::size_t most : {2u, 3u, 16u}) {
    const auto first = first_of_runs(boxes, most, 1);
    ASSERT_LT(first.size(), boxes.size()) << "nothing to be merged";
    for (const char* builder : kBuilders) {
      const Settings settings{{"merge.most", std::to_string(most)}, {"merge.growth", "1"}};
      const auto tree = build(testing::reference_set(boxes), builder, settings);
      const Status valid = tree::validate(tree, {.primitive_boxes = boxes, .max_leaf = 16});
      EXPECT_TRUE(valid) << builder << ": " << valid.error().message;
      EXPECT_EQ(tree.references.size(), boxes.size());
      EXPECT_EQ(merged(tree), double(first.size())) << builder;
      std::vector<std::uint32_t> leaf_of(boxes.size());
      for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
        for (std::uint32_t r = 0; tree.nodes[n].is_leaf() && r < tree.nodes[n].count; ++r)
          leaf_of[tree.references[tree.nodes[n].first + r]] = n;
      for (std::size_t run = 0; run < first.size(); ++run) {
        const std::size_t last = run + 1 < first.size() ? first[run + 1] : boxes.size();
        for (std::size_t i = first[run]; i < last; ++i)
          ASSERT_EQ(leaf_of[i], leaf_of[first[run]]) << builder << ", reference " << i;
      }
    }
  }
}

TEST(MergedRuns, AreLeftOutWhereTheySaveTooFew) {
  // Every third box has a partner: a third of the references is saved, wherever one looks.
  testing::Boxes boxes;
  for (std::size_t i = 0; i < test::effort(30000, 4); ++i) {
    const float x = 3 * float(i / 3) + (i % 3 == 2 ? 2.0f : 0.0f);
    boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
  }
  for (const char* builder : kBuilders) {
    const auto with = [&](const char* least) {
      return build(testing::reference_set(boxes), builder,
                   {{"merge.most", "2"}, {"merge.growth", "0.8"}, {"merge.least", least}});
    };
    EXPECT_NEAR(merged(with("0.3")), 2.0 / 3 * double(boxes.size()), 20) << builder;
    EXPECT_EQ(merged(with("0.37")), -1) << builder;
    EXPECT_EQ(tree::hash(with("0.37")), tree::hash(build(testing::reference_set(boxes), builder, {})));
    EXPECT_EQ(tree::hash(with("0")), tree::hash(with("0.3")));
  }
}

TEST(MergedRuns, NoLeafHasMoreThanItsLimit) {
  const testing::Boxes boxes = testing::height_field(20);
  for (const char* builder : kBuilders) {
    for (const std::uint32_t limit : {2u, 3u, 5u, 16u}) {
      const auto tree = build(testing::reference_set(boxes), builder,
                              {{"merge.most", "4"}, {"merge.growth", "2"}, {"leaf.max", std::to_string(limit)}});
      const Status valid = tree::validate(tree, {.primitive_boxes = boxes, .max_leaf = limit});
      EXPECT_TRUE(valid) << builder << ": " << valid.error().message;
      EXPECT_LT(merged(tree), double(boxes.size()));
    }
    const auto single = build(testing::reference_set(boxes), builder, {{"merge.most", "4"}, {"leaf.max", "1"}});
    EXPECT_EQ(tree::hash(single), tree::hash(build(testing::reference_set(boxes), builder, {{"leaf.max", "1"}})));
    EXPECT_EQ(merged(single), -1) << "leaves of one reference leave nothing to merge";
  }
}

TEST(MergedRuns, PartsOfOnePrimitiveAreNotPutTogetherAgain) {
  const testing::Boxes boxes = testing::soup(300, 12);
  refs::ReferenceSet set = testing::reference_set(boxes);
  set.references = AlignedBuffer<refs::Reference>(2 * boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    Box low = boxes[i], high = boxes[i];
    low.upper.x = high.lower.x = boxes[i].center().x;
    set.references[2 * i] = {low.lower, i, low.upper, 0};
    set.references[2 * i + 1] = {high.lower, i, high.upper, 0};
  }
  const auto tree = build(std::move(set), "binned-sah", {{"merge.most", "2"}, {"merge.growth", "1"}});
  EXPECT_TRUE(tree.splits_references);
  EXPECT_GT(merged(tree), 1.5 * double(boxes.size()));
  const Status valid = tree::validate(tree, {.primitive_boxes = boxes});
  EXPECT_TRUE(valid) << valid.error().message;
}

TEST(MergedRuns, ReferencesNeedNotBeNumberedLikeTheirPrimitives) {
  testing::Boxes boxes = testing::height_field(30);
  for (std::size_t i = 0; i < boxes.size(); i += 7) boxes[i] = Box{};
  refs::ReferenceSet set = testing::reference_set(boxes);
  std::size_t kept = 0;
  for (const refs::Reference& reference : set.references)
    if (!reference.box().is_empty()) set.references[kept++] = reference;
  set.references.truncate(kept);
  const auto tree = build(std::move(set), "hlbvh", {{"merge.most", "2"}, {"merge.growth", "1"}});
  EXPECT_LT(merged(tree), double(kept));
  const Status valid = tree::validate(tree, {.primitive_boxes = boxes});
  EXPECT_TRUE(valid) << valid.error().message;
}

}  // namespace
}  // namespace boxwood
