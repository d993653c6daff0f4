// The same bits from two and eight threads and from one without a pool, on inputs that enter the parallel paths.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "boxwood/builders.h"
#include "support/builder_names.h"
#include "support/effort.h"
#include "unit/builders/box_count.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood {
namespace {

bool equal_bits(const tree::BinaryTree& a, const tree::BinaryTree& b) {
  return a.nodes.size() == b.nodes.size() && a.references.size() == b.references.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.bytes()) == 0 &&
         std::memcmp(a.references.data(), b.references.data(), a.references.bytes()) == 0;
}

class BuilderDeterminism : public ::testing::TestWithParam<std::size_t> {
 protected:
  static std::size_t count(std::size_t wanted, std::size_t few) {
    return testing::box_count(builders::registry()[GetParam()], wanted, few);
  }

  void check(const testing::Boxes& boxes, const std::map<std::string, std::string>& settings = {}) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
    const char* const id = builders::registry()[GetParam()].id;
    SequentialExecutor sequential;
    const auto expected = builders::build(testing::reference_set(boxes), {id, settings}, {sequential});
    ASSERT_TRUE(expected) << expected.error().message;
    const Status valid = tree::validate(*expected, {.primitive_boxes = boxes});
    ASSERT_TRUE(valid) << valid.error().message;
    for (const int threads : test::thread_counts()) {
      ThreadExecutor executor(threads);
      const auto tree = builders::build(testing::reference_set(boxes), {id, settings}, {executor});
      ASSERT_TRUE(tree) << tree.error().message;
      EXPECT_TRUE(equal_bits(*expected, *tree)) << id << " at " << threads << " threads";
      EXPECT_EQ(tree::hash(*expected), tree::hash(*tree));
    }
  }
};

INSTANTIATE_TEST_SUITE_P(All, BuilderDeterminism, ::testing::Range<std::size_t>(0, builders::registry().size()),
                         test::builder_name);

TEST_P(BuilderDeterminism, Soup) {
  check(testing::soup(count(200000, 6000), 21));
}

TEST_P(BuilderDeterminism, Surface) {
  check(testing::height_field(count(320, 75)));
}

TEST_P(BuilderDeterminism, RunsTakenAsOne) {
  const builders::BuilderInfo& info = builders::registry()[GetParam()];
  if (builders::resolve_options(info.id, {})->has("merge.most"))
    check(testing::height_field(count(240, 75)), {{"merge.most", "3"}, {"merge.growth", "1"}});
}

TEST_P(BuilderDeterminism, EqualBoxes) {
  check(testing::Boxes(count(100000, 6000), Box{{1, 2, 3}, {2, 3, 4}}));
}

TEST_P(BuilderDeterminism, FewCentroidsManyTies) {
  testing::Random random(5);
  check(testing::make_boxes(count(100000, 6000), [&](std::size_t) {
    const auto cell = [&] { return std::floor(4 * random()); };
    const Vec3 p{cell(), cell(), cell()};
    return Box{p, p + Vec3{1, 1, 1}};
  }));
}

TEST_P(BuilderDeterminism, OneBigClusterAndAFewOutliers) {
  // Splits that peel off a handful of references keep ranges above the size that is worked on in parallel.
  testing::Boxes boxes = testing::soup(count(100000, 6000), 22, 1e-3f);
  for (int i = 0; i < 40; ++i) {
    const float x = std::ldexp(1.0f, i);
    boxes[static_cast<std::size_t>(i) * (boxes.size() / 100)] = {{x, x, x}, {1.5f * x, x, x}};
  }
  check(boxes);
}

}  // namespace
}  // namespace boxwood
