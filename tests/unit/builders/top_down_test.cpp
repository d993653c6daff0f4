// The top-down builders against plain re-statements of their rules.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood {
namespace {

using Settings = std::map<std::string, std::string>;
using Ids = std::vector<std::uint32_t>;

tree::BinaryTree build(const testing::Boxes& boxes, const char* id, const Settings& settings = {}) {
  ThreadExecutor executor(2);
  auto tree = builders::build(testing::reference_set(boxes), {id, settings}, {executor});
  EXPECT_TRUE(tree) << tree.error().message;
  return std::move(*tree);
}

double half_area(const Box& b) {
  const double x = double(b.upper.x) - b.lower.x, y = double(b.upper.y) - b.lower.y, z = double(b.upper.z) - b.lower.z;
  return x * y + y * z + z * x;
}

double box_cost(const testing::Boxes& boxes, const Ids& ids) {
  Box box;
  for (const std::uint32_t id : ids) box.grow(boxes[id]);
  return half_area(box) * static_cast<double>(ids.size());
}

/// The cheapest split of the primitives by centroid over all axes and places, priced one by one.
double cheapest_split(const testing::Boxes& boxes, Ids ids) {
  double best = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
      const float x = boxes[a].lower[axis] + boxes[a].upper[axis], y = boxes[b].lower[axis] + boxes[b].upper[axis];
      return x < y || (x == y && a < b);
    });
    for (std::size_t i = 1; i < ids.size(); ++i)
      best = std::min(
          best, box_cost(boxes, Ids(ids.begin(), ids.begin() + i)) + box_cost(boxes, Ids(ids.begin() + i, ids.end())));
  }
  return best;
}

/// The references below each node, by number.
std::vector<Ids> ids_below(const tree::BinaryTree& tree) {
  std::vector<Ids> below(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const tree::Node& node = tree.nodes[i];
    if (node.is_leaf()) {
      below[i].assign(tree.references.begin() + node.first, tree.references.begin() + node.first + node.count);
    } else {
      below[i] = below[node.first];
      below[i].insert(below[i].end(), below[node.first + 1].begin(), below[node.first + 1].end());
    }
  }
  return below;
}

void expect_cheapest_everywhere(const testing::Boxes& boxes, double traversal, double intersection) {
  const tree::BinaryTree tree = build(boxes, "sweep-sah",
                                      {{"cost.traversal", std::to_string(traversal)},
                                       {"cost.intersection", std::to_string(intersection)},
                                       {"leaf.max", "0"}});
  const std::vector<Ids> below = ids_below(tree);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const tree::Node& node = tree.nodes[i];
    if (below[i].size() < 2) continue;
    const double cheapest = cheapest_split(boxes, below[i]);
    const double area = half_area(node.bounds);
    const double leaf_cost = intersection * area * static_cast<double>(below[i].size());
    const double split_cost = traversal * area + intersection * cheapest;
    if (node.is_leaf()) {
      EXPECT_LE(leaf_cost, split_cost * (1 + 1e-6)) << "node " << i;
      continue;
    }
    EXPECT_LE(split_cost, leaf_cost * (1 + 1e-6)) << "node " << i;
    const double made = box_cost(boxes, below[node.first]) + box_cost(boxes, below[node.first + 1]);
    EXPECT_NEAR(made / cheapest, 1, 1e-5) << "node " << i;
  }
}

TEST(SweepSah, MakesTheCheapestSplitOfAll) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_cheapest_everywhere(testing::soup(2 + seed, seed), 1, 1.5);
    expect_cheapest_everywhere(testing::soup(30, 100 + seed), 2, 3);
    expect_cheapest_everywhere(testing::soup(20, 200 + seed, 1e-30f), 4, 1);
    expect_cheapest_everywhere(testing::soup(20, 300 + seed, 9e17f), 0.1, 1);
  }
}

TEST(SweepSah, DoesNotDependOnTheOrderOfTheReferences) {
  const testing::Boxes boxes = testing::soup(3000, 17);
  SequentialExecutor executor;
  refs::ReferenceSet shuffled = testing::reference_set(boxes);
  std::reverse(shuffled.references.begin(), shuffled.references.end());
  const auto tree = builders::build(std::move(shuffled), {"sweep-sah", {}}, {executor});
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree::hash(*tree), tree::hash(build(boxes, "sweep-sah")));
}

TEST(SweepSah, IsNeverAboveBinnedByMuchAndBinnedNearsItWithMoreBins) {
  const testing::Boxes boxes = testing::height_field(120);
  const double sweep = metrics::surface_area_cost(build(boxes, "sweep-sah"));
  const double coarse = metrics::surface_area_cost(build(boxes, "binned-sah", {{"bins", "4"}}));
  const double fine = metrics::surface_area_cost(build(boxes, "binned-sah", {{"bins", "64"}}));
  EXPECT_LT(sweep, 1.01 * fine);
  EXPECT_LT(fine, coarse);
  EXPECT_LT(fine, 1.03 * sweep);
}

TEST(TopDown, QualityIsInTheExpectedOrder) {
  const testing::Boxes boxes = testing::height_field(120);
  const double binned = metrics::surface_area_cost(build(boxes, "binned-sah"));
  const double longest = metrics::surface_area_cost(build(boxes, "binned-sah", {{"axes", "longest"}}));
  const double middle = metrics::surface_area_cost(build(boxes, "middle"));
  EXPECT_LE(binned, longest);
  EXPECT_LT(longest, middle);
}

TEST(TopDown, TheLongestAxisIsTheOneOfTheCentroids) {
  // Long boxes along x whose centroids spread along y only: a split on x could part nothing.
  const testing::Boxes boxes = testing::make_boxes(64, [](std::size_t i) {
    const float y = static_cast<float>(i);
    return Box{{-1000, y, 0}, {1000, y + 0.5f, 1}};
  });
  const tree::BinaryTree tree = build(boxes, "binned-sah", {{"axes", "longest"}, {"leaf.max", "1"}});
  ASSERT_FALSE(tree.nodes[0].is_leaf());
  EXPECT_LT(tree.nodes[1].bounds.upper.y, tree.nodes[2].bounds.lower.y);
}

TEST(Middle, SplitsAtTheMiddleOfTheCentroids) {
  const testing::Boxes boxes = testing::soup(500, 31);
  const tree::BinaryTree tree = build(boxes, "middle");
  const std::vector<Ids> below = ids_below(tree);
  EXPECT_EQ(tree::statistics(tree).max_leaf, 1u);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const tree::Node& node = tree.nodes[i];
    if (node.is_leaf()) continue;
    Box centroids;
    for (const std::uint32_t id : below[i]) centroids.grow(boxes[id].lower + boxes[id].upper);
    const int axis = centroids.widest_axis();
    for (int side = 0; side < 2; ++side)
      for (const std::uint32_t id : below[node.first + side])
        EXPECT_EQ(boxes[id].lower[axis] + boxes[id].upper[axis] >= centroids.center()[axis], side == 1);
  }
}

TEST(EqualCounts, HalvesTheReferencesAtTheMedian) {
  const testing::Boxes boxes = testing::soup(777, 32);
  const tree::BinaryTree tree = build(boxes, "equal-counts");
  const std::vector<Ids> below = ids_below(tree);
  EXPECT_EQ(tree::statistics(tree).max_depth, 10u);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const tree::Node& node = tree.nodes[i];
    if (node.is_leaf()) continue;
    EXPECT_EQ(below[node.first].size(), below[i].size() / 2);
    Box left, right;
    for (const std::uint32_t id : below[node.first]) left.grow(boxes[id].lower + boxes[id].upper);
    for (const std::uint32_t id : below[node.first + 1]) right.grow(boxes[id].lower + boxes[id].upper);
    const int axis = merge(left, right).widest_axis();
    EXPECT_LE(left.upper[axis], right.lower[axis]);
  }
}

TEST(TopDown, EqualBoxesMakeOneLeafWithoutALimitAndAShallowTreeWithOne) {
  const testing::Boxes boxes(100000, Box{{0, 0, 0}, {1, 2, 3}});
  for (const char* id : {"middle", "equal-counts", "binned-sah", "sweep-sah"}) {
    const tree::Statistics unlimited = tree::statistics(build(boxes, id, {{"leaf.max", "0"}}));
    EXPECT_EQ(unlimited.nodes, 1u) << id;
    EXPECT_EQ(unlimited.max_leaf, 100000u) << id;
    const tree::Statistics limited = tree::statistics(build(boxes, id, {{"leaf.max", "4"}}));
    EXPECT_LE(limited.max_leaf, 4u) << id;
    EXPECT_LE(limited.max_depth, 17u) << id;
  }
}

TEST(TopDown, DepthStaysBoundedWhereEverySplitPeelsOffOneReference) {
  // Each box is half the size of the one before, over all exponents a float has, many times over.
  const testing::Boxes boxes = testing::make_boxes(20000, [](std::size_t i) {
    const float x = std::ldexp(1.0f, 58 - static_cast<int>(i % 180));
    return Box{{x, 0, 0}, {x, x, x}};
  });
  for (const char* id : {"middle", "equal-counts", "binned-sah", "sweep-sah"}) {
    const tree::BinaryTree tree = build(boxes, id, {{"leaf.max", "1"}});
    EXPECT_TRUE(tree::validate(tree, {.primitive_boxes = boxes, .max_leaf = 1})) << id;
    EXPECT_LE(tree::statistics(tree).max_depth, 96u + 15u) << id;
  }
}

TEST(TopDown, ScalingByAPowerOfTwoChangesNothingButTheBoxes) {
  const testing::Boxes boxes = testing::soup(2000, 41);
  for (const char* id : {"binned-sah", "sweep-sah"}) {
    const tree::BinaryTree plain = build(boxes, id);
    for (const float scale : {0x1p-90f, 0x1p59f}) {
      testing::Boxes scaled = boxes;
      for (Box& box : scaled) box = {box.lower * scale, box.upper * scale};
      const tree::BinaryTree tree = build(scaled, id);
      ASSERT_EQ(tree.nodes.size(), plain.nodes.size()) << id;
      EXPECT_TRUE(std::equal(tree.references.begin(), tree.references.end(), plain.references.begin())) << id;
    }
  }
}

TEST(TopDown, DearTraversalMakesLeavesUpToTheLimit) {
  const testing::Boxes boxes = testing::soup(1000, 42);
  for (const char* id : {"binned-sah", "sweep-sah"}) {
    const tree::Statistics one_leaf =
        tree::statistics(build(boxes, id, {{"cost.traversal", "1e6"}, {"leaf.max", "0"}}));
    EXPECT_EQ(one_leaf.nodes, 1u) << id;
    const tree::Statistics free = tree::statistics(build(boxes, id, {{"cost.traversal", "0"}}));
    EXPECT_GT(free.leaves, 900u) << id;
  }
}

}  // namespace
}  // namespace boxwood
