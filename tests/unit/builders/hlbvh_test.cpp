#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>

#include "unit/builders/morton_builder_cases.h"

namespace boxwood {
namespace {

using namespace test;

TEST(Hlbvh, valid_on_difficult_sets) {
  for (const auto& [name, boxes] : difficult_sets()) {
    SCOPED_TRACE(name);
    SequentialExecutor executor;
    for (const char* bits : {"63", "30"})
      for (const char* treelet_bits : {"1", "12", "30"})
        for (const std::size_t leaf : {1, 16})
          build_valid(boxes, "hlbvh",
                      {{"bits", bits}, {"treelet.bits", treelet_bits}, {"leaf.max", std::to_string(leaf)}}, executor,
                      leaf);
  }
}

TEST(Hlbvh, no_references_give_an_empty_tree) {
  EXPECT_TRUE(build_valid({}, "hlbvh").empty());
}

TEST(Hlbvh, equal_centroids_stay_one_balanced_treelet) {
  const std::vector<Box> boxes(100'000, Box{{1, 1, 1}, {2, 2, 2}});
  const auto tree = build_valid(boxes, "hlbvh", {{"leaf.max", "1"}});
  EXPECT_EQ(tree::statistics(tree).max_depth, 17u);
}

TEST(Hlbvh, treelets_without_area_are_halved) {
  std::vector<Box> boxes;  // points on a line: no split is cheaper than another
  for (int i = 0; i < 4096; ++i) boxes.push_back({{float(i), 0, 0}, {float(i), 0, 0}});
  const auto tree = build_valid(boxes, "hlbvh", {{"leaf.max", "1"}, {"treelet.bits", "30"}});
  EXPECT_LE(tree::statistics(tree).max_depth, 16u);
}

TEST(Hlbvh, better_than_lbvh_on_a_scan) {
  const auto boxes = scan_boxes(150);
  const tree::CostModel cost{2, 3};
  for (const char* leaf : {"1", "16"}) {
    const Settings settings{{"leaf.max", leaf}, {"cost.traversal", "2"}, {"cost.intersection", "3"}};
    const double lbvh = metrics::surface_area_cost(build_valid(boxes, "lbvh", settings), cost);
    const double hlbvh = metrics::surface_area_cost(build_valid(boxes, "hlbvh", settings), cost);
    EXPECT_LT(hlbvh, lbvh);
    EXPECT_GT(hlbvh, 0.7 * lbvh) << "so much better is not to be believed";
  }
}

TEST(Hlbvh, more_treelets_come_closer_to_the_heuristic) {
  const auto boxes = scan_boxes(100);
  const auto price = [&](const char* treelet_bits) {
    return metrics::surface_area_cost(build_valid(boxes, "hlbvh", {{"treelet.bits", treelet_bits}}));
  };
  const double few = price("3"), some = price("12"), many = price("21");
  EXPECT_LT(some, few);
  EXPECT_LT(many, some);
}

TEST(Hlbvh, bins_and_axes_change_the_tree) {
  const auto boxes = random_boxes(20'000, 8, 1.0f);
  const auto standard = build_valid(boxes, "hlbvh");
  EXPECT_NE(tree::hash(build_valid(boxes, "hlbvh", {{"bins", "2"}})), tree::hash(standard));
  EXPECT_NE(tree::hash(build_valid(boxes, "hlbvh", {{"bins", "256"}})), tree::hash(standard));
  EXPECT_NE(tree::hash(build_valid(boxes, "hlbvh", {{"axes", "longest"}})), tree::hash(standard));
}

TEST(Hlbvh, one_bit_divides_along_x_first) {
  std::vector<Box> boxes;
  for (const Box& box : random_boxes(500, 9)) boxes.push_back(box);
  const auto tree = build_valid(boxes, "hlbvh", {{"treelet.bits", "1"}});
  const auto lbvh = build_valid(boxes, "lbvh");
  EXPECT_EQ(tree::hash(tree), tree::hash(lbvh)) << "two treelets can be joined in one way only";
}

TEST(Hlbvh, same_bits_on_every_executor) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  auto boxes = random_boxes(200'000, 7);
  boxes.resize(250'000, boxes[0]);
  for (const char* treelet_bits : {"12", "30"}) {  // few treelets; more than one thread bins at once
    const Settings settings{{"treelet.bits", treelet_bits}};
    const auto expected = build_valid(boxes, "hlbvh", settings);
    for (const int threads : {1, 2, 8}) {
      ThreadExecutor executor(threads);
      EXPECT_EQ(tree::hash(build_valid(boxes, "hlbvh", settings, executor)), tree::hash(expected)) << threads;
    }
  }
}

TEST(Hlbvh, can_be_cancelled_and_reports_progress) {
  SequentialExecutor executor;
  const std::atomic<bool> cancel{true};
  EXPECT_FALSE(builders::build(reference_set(random_boxes(100, 1)), {"hlbvh", {}}, {executor, {}, &cancel}));
  std::vector<double> shares;
  const auto tree = builders::build(reference_set(random_boxes(100, 1)), {"hlbvh", {}},
                                    {executor, [&](double share) { shares.push_back(share); }});
  ASSERT_TRUE(tree);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
}

}  // namespace
}  // namespace boxwood
