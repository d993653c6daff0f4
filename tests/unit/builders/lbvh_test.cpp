#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>

#include "unit/builders/morton_builder_cases.h"

namespace boxwood {
namespace {

using namespace test;

TEST(Lbvh, valid_on_difficult_sets) {
  for (const auto& [name, boxes] : difficult_sets()) {
    SCOPED_TRACE(name);
    SequentialExecutor executor;
    for (const char* bits : {"63", "30"})
      for (const std::size_t leaf : {1, 2, 16})
        build_valid(boxes, "lbvh", {{"bits", bits}, {"leaf.max", std::to_string(leaf)}}, executor, leaf);
  }
}

TEST(Lbvh, no_references_give_an_empty_tree) {
  const auto tree = build_valid({}, "lbvh");
  EXPECT_TRUE(tree.empty());
}

TEST(Lbvh, splits_at_the_highest_bit) {
  // Seven unit boxes at known cells of a grid of 2: the first bit of the code is x, then y, then z.
  std::vector<Box> boxes;
  for (const Vec3 p :
       {Vec3{0, 0, 0}, Vec3{0, 0, 9}, Vec3{0, 9, 0}, Vec3{9, 0, 0}, Vec3{9, 0, 9}, Vec3{9, 9, 0}, Vec3{9, 9, 9}})
    boxes.push_back({p, p + Vec3{1, 1, 1}});
  const auto tree = build_valid(boxes, "lbvh", {{"leaf.max", "1"}});
  ASSERT_EQ(tree.nodes.size(), 13u);
  const auto& left = tree.nodes[tree.nodes[0].first];
  const auto& right = tree.nodes[tree.nodes[0].first + 1];
  EXPECT_EQ(left.bounds, (Box{{0, 0, 0}, {1, 10, 10}}));
  EXPECT_EQ(right.bounds, (Box{{9, 0, 0}, {10, 10, 10}}));
  EXPECT_EQ(tree.nodes[left.first].bounds, (Box{{0, 0, 0}, {1, 1, 10}}));
  EXPECT_EQ(tree.nodes[left.first + 1].bounds, (Box{{0, 9, 0}, {1, 10, 1}}));
  EXPECT_EQ(std::vector<std::uint32_t>(tree.references.begin(), tree.references.end()),
            (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(Lbvh, equal_centroids_are_halved_by_index) {
  const std::vector<Box> boxes(100'000, Box{{1, 1, 1}, {2, 2, 2}});
  const auto tree = build_valid(boxes, "lbvh", {{"leaf.max", "1"}});
  const auto statistics = tree::statistics(tree);
  EXPECT_EQ(statistics.leaves, boxes.size());
  EXPECT_EQ(statistics.max_depth, 17u);  // ceil(log2(100000))
}

TEST(Lbvh, depth_is_bounded_by_the_bits_and_the_equal_codes) {
  std::vector<Box> boxes;  // one centroid per bit, each half as far from the corner as the one before
  for (int bit = 0; bit < 100; ++bit) {
    const float x = std::ldexp(1.0f, -bit);
    for (const Vec3 p : {Vec3{x, 0, 0}, Vec3{0, x, 0}, Vec3{0, 0, x}}) boxes.push_back({p, p});
  }
  const auto tree = build_valid(boxes, "lbvh", {{"leaf.max", "1"}});
  EXPECT_GT(tree::statistics(tree).max_depth, 60u);
  EXPECT_LE(tree::statistics(tree).max_depth, 63u + 8u);
}

TEST(Lbvh, more_bits_tell_more_centroids_apart) {
  std::vector<Box> boxes{Box{{0, 0, 0}, {0, 0, 0}}, Box{{1000, 1000, 1000}, {1000, 1000, 1000}}};
  for (const Box& box : random_boxes(2000, 6)) {  // 2000 boxes within a thousandth of the whole
    boxes.push_back({box.lower * 0.01f, box.upper * 0.01f});
    boxes.back().upper = boxes.back().lower;
  }
  const auto coarse = build_valid(boxes, "lbvh", {{"bits", "30"}, {"leaf.max", "1"}});
  const auto fine = build_valid(boxes, "lbvh", {{"bits", "63"}, {"leaf.max", "1"}});
  EXPECT_GT(metrics::surface_area_cost(coarse), metrics::surface_area_cost(fine) * 1.0000001);
}

TEST(Lbvh, leaves_are_made_where_they_are_no_dearer) {
  const auto boxes = scan_boxes(60);
  const tree::CostModel cost{2, 3};
  const auto price = [&](const char* leaf_max) {
    const auto tree =
        build_valid(boxes, "lbvh", {{"leaf.max", leaf_max}, {"cost.traversal", "2"}, {"cost.intersection", "3"}});
    return metrics::surface_area_cost(tree, cost);
  };
  const double one = price("1"), four = price("4"), unlimited = price("0");
  EXPECT_LT(four, one);
  EXPECT_LE(unlimited, four * (1 + 1e-12));

  const auto dear_nodes = build_valid(boxes, "lbvh", {{"leaf.max", "0"}, {"cost.traversal", "1000000"}});
  EXPECT_EQ(dear_nodes.nodes.size(), 1u) << "no limit and no node worth its price: one leaf";
  const auto cheap_nodes = build_valid(boxes, "lbvh", {{"cost.traversal", "0"}, {"cost.intersection", "1000"}});
  EXPECT_LT(tree::statistics(cheap_nodes).average_leaf, 1.5);
}

TEST(Lbvh, same_bits_on_every_executor) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  auto boxes = random_boxes(200'000, 7);
  boxes.resize(250'000, boxes[0]);
  const auto expected = build_valid(boxes, "lbvh");
  for (const int threads : {1, 2, 8}) {
    ThreadExecutor executor(threads);
    EXPECT_EQ(tree::hash(build_valid(boxes, "lbvh", {}, executor)), tree::hash(expected)) << threads;
  }
}

TEST(Lbvh, keeps_the_number_of_primitives_and_the_order_of_equal_codes) {
  const std::vector<Box> boxes(64, Box{{0, 0, 0}, {1, 1, 1}});
  const auto tree = build_valid(boxes, "lbvh", {{"leaf.max", "1"}});
  EXPECT_EQ(tree.primitive_count, 64u);
  for (std::uint32_t r = 0; r < 64; ++r) EXPECT_EQ(tree.references[r], r);
}

TEST(Lbvh, can_be_cancelled_and_reports_progress) {
  SequentialExecutor executor;
  const std::atomic<bool> cancel{true};
  EXPECT_FALSE(builders::build(reference_set(random_boxes(100, 1)), {"lbvh", {}}, {executor, {}, &cancel}));
  std::vector<double> shares;
  const auto tree = builders::build(reference_set(random_boxes(100, 1)), {"lbvh", {}},
                                    {executor, [&](double share) { shares.push_back(share); }});
  ASSERT_TRUE(tree);
  ASSERT_GE(shares.size(), 2u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
}

TEST(Lbvh, refuses_options_it_does_not_have) {
  SequentialExecutor executor;
  const auto refused = [&](const Settings& settings, const char* part) {
    const auto tree = builders::build(reference_set(random_boxes(10, 1)), {"lbvh", settings}, {executor});
    return !tree && tree.error().message.find(part) != std::string::npos;
  };
  EXPECT_TRUE(refused({{"bits", "31"}}, "31"));
  EXPECT_TRUE(refused({{"leaf.max", "-1"}}, "-1"));
  EXPECT_TRUE(refused({{"treelet.bits", "12"}}, "treelet.bits"));
}

}  // namespace
}  // namespace boxwood
