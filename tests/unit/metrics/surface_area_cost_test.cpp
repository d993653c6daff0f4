#include "boxwood/metrics.h"

#include <gtest/gtest.h>

#include "unit/tree/trees.h"

namespace boxwood {
namespace {

double half_area(const Box& b) {
  const double x = double(b.upper.x) - b.lower.x, y = double(b.upper.y) - b.lower.y, z = double(b.upper.z) - b.lower.z;
  return x * y + y * z + z * x;
}

/// The recursive definition: C_T plus what the children cost, weighted by the chance to reach each from its parent.
double recursive_cost(const tree::BinaryTree& tree, std::uint32_t index, double traversal, double intersection) {
  const tree::Node& node = tree.nodes[index];
  if (node.is_leaf()) return node.count * intersection;
  double sum = traversal;
  for (const std::uint32_t child : {node.first, node.first + 1})
    sum += half_area(tree.nodes[child].bounds) / half_area(node.bounds) *
           recursive_cost(tree, child, traversal, intersection);
  return sum;
}

TEST(SurfaceAreaCost, EqualsTheRecursiveDefinition) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const tree::BinaryTree tree = testing::canonical(testing::random_tree(1 + 37 * seed, seed));
    EXPECT_NEAR(metrics::surface_area_cost(tree) / recursive_cost(tree, 0, 1, 1.5), 1, 1e-12);
    EXPECT_NEAR(metrics::surface_area_cost(tree, {2, 3}) / recursive_cost(tree, 0, 2, 3), 1, 1e-12);
    EXPECT_NEAR(metrics::surface_area_cost(tree, {0, 1}) / recursive_cost(tree, 0, 0, 1), 1, 1e-12);
  }
}

TEST(SurfaceAreaCost, ByHand) {
  testing::LooseTree loose;
  loose.boxes = {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}};
  loose.references = {0, 1, 2};
  loose.nodes = {{{{0, 0, 0}, {2, 1, 1}}, 1, 0}, {loose.boxes[0], 0, 1}, {loose.boxes[1], 1, 2}};
  const tree::BinaryTree tree = testing::canonical(loose);
  EXPECT_DOUBLE_EQ(metrics::surface_area_cost(tree, {2, 3}), 2 + 3.0 / 5 * 3 + 3.0 / 5 * 6);
}

TEST(SurfaceAreaCost, EmptyTreeAndSingleLeaf) {
  EXPECT_EQ(metrics::surface_area_cost({}), 0.0);
  EXPECT_DOUBLE_EQ(metrics::surface_area_cost(testing::canonical(testing::random_tree(1, 3)), {7, 2}),
                   2.0 * static_cast<double>(testing::random_tree(1, 3).references.size()));
}

TEST(SurfaceAreaCost, RootWithoutAreaCountsNodesAlike) {
  testing::LooseTree loose;
  const Box line{{0, 0, 0}, {5, 0, 0}};
  loose.boxes = {line, line, line};
  loose.references = {0, 1, 2};
  loose.nodes = {{line, 1, 0}, {line, 0, 1}, {line, 1, 2}};
  EXPECT_DOUBLE_EQ(metrics::surface_area_cost(testing::canonical(loose), {2, 3}), 2 + 3 * 3);
}

TEST(SurfaceAreaCost, DoesNotDependOnTheScale) {
  const tree::BinaryTree tree = testing::canonical(testing::random_tree(200, 9));
  const double cost = metrics::surface_area_cost(tree);
  for (const float scale : {0x1p49f, 0x1p-120f}) {
    tree::BinaryTree scaled = testing::copy(tree);
    for (tree::Node& node : scaled.nodes) node.bounds = {node.bounds.lower * scale, node.bounds.upper * scale};
    EXPECT_DOUBLE_EQ(metrics::surface_area_cost(scaled), cost);
  }
}

}  // namespace
}  // namespace boxwood
