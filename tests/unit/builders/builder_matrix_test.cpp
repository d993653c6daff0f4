// Every builder of the registry on every awkward shape with several settings: the tree must be valid.
#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "support/builder_names.h"
#include "support/effort.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood {
namespace {

using builders::BuilderInfo;
using Settings = std::map<std::string, std::string>;

bool has_option(const BuilderInfo& info, std::string_view key) {
  for (const builders::OptionSpec& spec : info.options)
    if (key == spec.key) return true;
  return false;
}

class BuilderMatrix : public ::testing::TestWithParam<std::size_t> {
 protected:
  const BuilderInfo& info() const { return builders::registry()[GetParam()]; }

  void check(const testing::Shape& shape, const Settings& settings) {
    SCOPED_TRACE(std::string(info().id) + " on " + shape.name);
    SequentialExecutor executor;
    const auto tree = builders::build(testing::reference_set(shape.boxes), {info().id, settings}, {executor});
    ASSERT_TRUE(tree) << tree.error().message;
    tree::Expectation expectation{.primitive_boxes = shape.boxes};
    // Without a fall-back leaves may have any size: that is what the option is there to show.
    const auto fallback = settings.find("fallback");
    if (has_option(info(), "leaf.max") && (fallback == settings.end() || fallback->second != "none"))
      expectation.max_leaf = builders::resolve_options(info().id, settings)->integer("leaf.max");
    const Status valid = tree::validate(*tree, expectation);
    EXPECT_TRUE(valid) << valid.error().message;
    EXPECT_LE(tree::statistics(*tree).max_depth, 300u);
    EXPECT_TRUE(std::isfinite(metrics::surface_area_cost(*tree)));
  }
};

INSTANTIATE_TEST_SUITE_P(All, BuilderMatrix, ::testing::Range<std::size_t>(0, builders::registry().size()),
                         test::builder_name);

TEST_P(BuilderMatrix, DefaultsAreValidOnAwkwardShapes) {
  for (const testing::Shape& shape : testing::awkward_shapes()) check(shape, {});
}

TEST_P(BuilderMatrix, LeafLimitsHold) {
  if (!has_option(info(), "leaf.max")) GTEST_SKIP() << "this builder has no leaf limit";
  std::vector<const char*> limits = {"0", "2"};
  if (!test::kInstrumented) limits.insert(limits.end(), {"1", "5"});
  for (const testing::Shape& shape : testing::awkward_shapes())
    for (const char* limit : limits) check(shape, {{"leaf.max", limit}});
}

TEST_P(BuilderMatrix, CostsAtTheEndsOfTheirRangesAreValid) {
  for (const testing::Shape& shape : testing::awkward_shapes()) {
    check(shape, {{"cost.traversal", "0"}});
    check(shape, {{"cost.traversal", "1e6"}, {"cost.intersection", "1e-6"}});
    check(shape, {{"cost.intersection", "1e6"}});
  }
}

TEST_P(BuilderMatrix, EveryOptionTakesBothEndsOfItsRange) {
  const testing::Shape shape{"soup", testing::soup(test::effort(600, 4), 9)};
  for (const builders::OptionSpec& spec : info().options) {
    for (const char* choice : spec.choices) check(shape, {{spec.key, choice}});
    if (!spec.choices.empty()) continue;
    check(shape, {{spec.key, std::to_string(spec.lowest)}});
    check(shape, {{spec.key, std::to_string(spec.highest)}});
  }
}

TEST_P(BuilderMatrix, EmptySetGivesEmptyTree) {
  SequentialExecutor executor;
  refs::ReferenceSet set;
  set.primitive_count = 3;
  set.excluded = 3;
  const auto tree = builders::build(std::move(set), {info().id, {}}, {executor});
  ASSERT_TRUE(tree);
  EXPECT_TRUE(tree->empty());
  EXPECT_EQ(tree->references.size(), 0u);
  EXPECT_EQ(tree->primitive_count, 3u);
  EXPECT_TRUE(tree::validate(*tree, {.primitive_boxes = std::vector<Box>(3)}));
}

TEST_P(BuilderMatrix, ExcludedPrimitivesAndGapsStayOut) {
  testing::Boxes boxes = testing::soup(500, 11);
  for (std::size_t i = 0; i < boxes.size(); i += 3) boxes[i] = Box{};
  refs::ReferenceSet set = testing::reference_set(boxes);
  std::size_t kept = 0;
  for (const refs::Reference& reference : set.references)
    if (!reference.box().is_empty()) set.references[kept++] = reference;
  set.references.truncate(kept);
  SequentialExecutor executor;
  const auto tree = builders::build(std::move(set), {info().id, {}}, {executor});
  ASSERT_TRUE(tree) << tree.error().message;
  EXPECT_TRUE(tree::validate(*tree, {.primitive_boxes = boxes}));
}

TEST_P(BuilderMatrix, PartsOfSplitPrimitivesAreAllKept) {
  // Two halves of each box, as a pre-split would hand in.
  const testing::Boxes boxes = testing::soup(400, 12);
  refs::ReferenceSet set = testing::reference_set(boxes);
  set.references = AlignedBuffer<refs::Reference>(2 * boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Box low = boxes[i], high = boxes[i];
    low.upper.x = high.lower.x = boxes[i].center().x;
    const auto id = static_cast<std::uint32_t>(i);
    set.references[i] = {low.lower, id, low.upper, 0};
    set.references[boxes.size() + i] = {high.lower, id, high.upper, 0};
  }
  SequentialExecutor executor;
  const auto tree = builders::build(std::move(set), {info().id, {}}, {executor});
  ASSERT_TRUE(tree) << tree.error().message;
  EXPECT_TRUE(tree->splits_references);
  // Parts that meet in a leaf are one reference there.
  const double growth = has_option(info(), "growth") ? builders::resolve_options(info().id, {})->number("growth") : 1;
  EXPECT_LE(static_cast<double>(tree->references.size()), growth * 2 * static_cast<double>(boxes.size()));
  EXPECT_GE(tree->references.size(), boxes.size());
  const Status valid = tree::validate(*tree, {.primitive_boxes = boxes});
  EXPECT_TRUE(valid) << valid.error().message;
}

}  // namespace
}  // namespace boxwood
