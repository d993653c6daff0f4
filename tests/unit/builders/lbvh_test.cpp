#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <bit>

#include "builders/parts/morton_order.h"
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

/// The tree by its definition: divided from the top at the highest bit, a leaf where that is no dearer.
class PlainRadixTree {
 public:
  PlainRadixTree(const refs::ReferenceSet& set, int bits_per_axis, std::size_t largest, tree::CostModel cost)
      : set_(set), largest_(largest), cost_(cost) {
    SequentialExecutor executor;
    order_ = builders::morton_order(set.references.span(), bits_per_axis, executor);
  }

  /// Nodes that are not as they must be.
  int differences(const tree::BinaryTree& tree) { return compare(tree, 0, make(0, order_.size())); }

 private:
  struct Made {
    Box box;
    double price;
    std::size_t first, last;
    std::vector<Made> children;
  };
  Made make(std::size_t first, std::size_t last) {
    Made made{{}, 0, first, last, {}};
    const double traversal = double(cost_.traversal), intersection = double(cost_.intersection);
    for (std::size_t i = first; i < last; ++i) made.box.grow(set_.references[order_[i].index].box());
    const double area = double(made.box.half_area()), leaf_price = area * intersection * double(last - first);
    made.price = leaf_price;
    if (last - first == 1) return made;
    std::size_t middle = first + (last - first) / 2;
    if (const std::uint64_t bits = order_[first].key ^ order_[last - 1].key; bits != 0)
      for (middle = first; !(order_[middle].key & std::bit_floor(bits));) ++middle;
    Made left = make(first, middle), right = make(middle, last);
    const double price = area * traversal + left.price + right.price;
    if ((largest_ == 0 || last - first <= largest_) && leaf_price <= price) return made;
    made.price = price;
    made.children.push_back(std::move(left)), made.children.push_back(std::move(right));
    return made;
  }
  int compare(const tree::BinaryTree& tree, std::uint32_t n, const Made& made) {
    const tree::Node& node = tree.nodes[n];
    int wrong = !(node.bounds == made.box) + (node.is_leaf() != made.children.empty());
    if (wrong) return wrong;
    if (!node.is_leaf())
      return compare(tree, node.first, made.children[0]) + compare(tree, node.first + 1, made.children[1]);
    if (node.first != made.first || node.count != made.last - made.first) return 1;
    for (std::size_t i = made.first; i < made.last; ++i)
      wrong += tree.references[i] != set_.references[order_[i].index].primitive;
    return wrong;
  }

  const refs::ReferenceSet& set_;
  AlignedBuffer<KeyedIndex> order_;
  std::size_t largest_;
  tree::CostModel cost_;
};

TEST(Lbvh, is_the_tree_of_its_definition) {
  auto sets = difficult_sets();
  sets["scan"] = scan_boxes(40);
  // Crowds of up to forty equal codes among others.
  for (const Box& box : random_boxes(300, 8))
    sets["crowds"].insert(sets["crowds"].end(), 1 + sets["crowds"].size() % 41, box);
  for (const auto& [name, boxes] : sets)
    for (const int bits : {63, 30})
      for (const char* leaf_max : {"0", "1", "3", "16"})
        for (const char* intersection : {"0.01", "0.15", "0.25", "0.5", "1", "3"}) {
          const auto set = reference_set(boxes);
          const auto tree = build_valid(
              boxes, "lbvh",
              {{"bits", std::to_string(bits)}, {"leaf.max", leaf_max}, {"cost.intersection", intersection}});
          PlainRadixTree plain(set, bits / 3, std::stoul(leaf_max), {1, std::stof(intersection)});
          ASSERT_EQ(plain.differences(tree), 0)
              << name << ", bits " << bits << ", leaf.max " << leaf_max << ", intersection " << intersection;
        }
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
