// The generic builder and the geometric partitioner: what their settings promise.
#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "builders/parts/configuration.h"
#include "support/effort.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood {
namespace {

using Settings = std::map<std::string, std::string>;

tree::BinaryTree build(const testing::Boxes& boxes, const char* id, const Settings& settings) {
  SequentialExecutor executor;
  auto tree = builders::build(testing::reference_set(boxes), {id, settings}, {executor});
  EXPECT_TRUE(tree) << tree.error().message;
  const Status valid = tree::validate(*tree, {.primitive_boxes = boxes});
  EXPECT_TRUE(valid) << valid.error().message;
  return std::move(*tree);
}

const Settings kCentroidsOnly{{"oracle.kd", "0"}, {"oracle.grid", "0"}, {"overlap", "0"}};

TEST(Generic, CentroidsAloneAreTheFullSweep) {
  for (const testing::Boxes& boxes :
       {testing::soup(3000, 1), testing::height_field(60), testing::soup(5000, 2, 1e-3f)}) {
    const tree::BinaryTree sweep = build(boxes, "sweep-sah", {}), generic = build(boxes, "generic", kCentroidsOnly);
    EXPECT_EQ(metrics::surface_area_cost(generic), metrics::surface_area_cost(sweep));
    EXPECT_EQ(generic.references.size(), boxes.size());
  }
}

TEST(Generic, NoOracleIsRefusedWithTheirNames) {
  SequentialExecutor executor;
  const auto tree =
      builders::build(testing::reference_set(testing::soup(10, 1)),
                      {"generic", {{"oracle.centroid", "0"}, {"oracle.kd", "0"}, {"oracle.grid", "0"}}}, {executor});
  ASSERT_FALSE(tree);
  EXPECT_EQ(tree.error().code, ErrorCode::invalid_argument);
  for (const char* name : {"oracle.centroid", "oracle.kd", "oracle.grid"})
    EXPECT_NE(tree.error().message.find(name), std::string::npos);
}

TEST(Generic, KeepsToItsNumberOfReferences) {
  const testing::Boxes boxes = testing::soup(1500, 3);
  for (const char* oracle : {"oracle.kd", "oracle.grid"})
    for (const char* growth : {"1", "1.5", "3"}) {
      const Settings settings{{oracle, "0"}, {"growth", growth}};
      EXPECT_LE(static_cast<double>(build(boxes, "generic", settings).references.size()), 1500 * std::atof(growth));
    }
}

/// The largest share of its parent's volume that two siblings have in common.
double largest_overlap(const tree::BinaryTree& tree) {
  double largest = 0;
  for (const tree::Node& node : tree.nodes)
    if (!node.is_leaf())
      largest = std::max(largest, builders::overlap_share(tree.nodes[node.first].bounds,
                                                          tree.nodes[node.first + 1].bounds, node.bounds));
  return largest;
}

TEST(Generic, APriceOnOverlapSubdividesSpaceWhileThereAreReferencesToSpare) {
  const testing::Boxes boxes = testing::soup(300, 4);
  for (const auto& settings : {Settings{{"growth", "64"}, {"leaf.max", "0"}},
                               Settings{{"growth", "64"}, {"leaf.max", "0"}, {"oracle.centroid", "0"}},
                               Settings{{"growth", "64"}, {"leaf.max", "0"}, {"oracle.kd", "0"}}})
    EXPECT_EQ(largest_overlap(build(boxes, "generic", settings)), 0);
  EXPECT_GT(largest_overlap(build(boxes, "generic", {{"overlap", "0"}})), 0.01);
}

TEST(Geometric, NestsBoxesWhoseCentroidsCoincide) {
  // Figure 1 of the paper: without an order of centroids there is nothing to sweep over, but nested boxes pay.
  testing::Boxes boxes(8, Box{{-1, -1, -1}, {1, 1, 1}});
  boxes.resize(10, Box{{-50, -50, -50}, {50, 50, 50}});
  EXPECT_EQ(build(boxes, "sweep-sah", {}).nodes.size(), 1u);
  EXPECT_EQ(build(boxes, "geometric", {{"grid.k", "4096"}}).nodes.size(), 3u);
}

TEST(Geometric, BothWaysToCountGiveTheSameTree) {
  const testing::Boxes boxes = testing::soup(2000, 5);
  EXPECT_EQ(tree::hash(build(boxes, "geometric", {})), tree::hash(build(boxes, "geometric", {{"counting", "tree"}})));
}

TEST(Geometric, EveryOptionChangesTheTree) {
  const testing::Boxes boxes = testing::soup(test::effort(1500, 3), 6);
  const std::uint64_t plain = tree::hash(build(boxes, "geometric", {}));
  for (const auto& [key, value] :
       Settings{{"cost", "recursive"}, {"exact.max", "6"}, {"grid.k", "512"}, {"grid.rule", "text"}})
    EXPECT_NE(tree::hash(build(boxes, "geometric", {{key, value}})), plain) << key;
}

}  // namespace
}  // namespace boxwood
