#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "boxwood/optimizers.h"
#include "optimizers/reinsertion_search.h"
#include "unit/optimizers/binary_shapes.h"

namespace boxwood {
namespace {

using optimizers::Reinsertion;
using optimizers::ReinsertionOptions;
using optimizers::ReinsertionReport;

tree::BinaryTree clone(const tree::BinaryTree& tree) {
  tree::BinaryTree copy;
  copy.nodes = tree.nodes.clone();
  copy.references = tree.references.clone();
  copy.primitive_count = tree.primitive_count;
  copy.splits_references = tree.splits_references;
  copy.notes = tree.notes;
  return copy;
}

double price(const tree::BinaryTree& tree) {
  double sum = 0;
  for (const tree::Node& node : tree.nodes)
    if (!node.is_leaf()) sum += double(node.bounds.half_area());
  return sum;
}

/// Box and references of each leaf, sorted: what no optimizer may change.
std::vector<std::array<float, 8>> leaves(const tree::BinaryTree& tree) {
  std::vector<std::array<float, 8>> all;
  for (const tree::Node& node : tree.nodes)
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const Box& b = node.bounds;
      all.push_back({float(tree.references[node.first + i]), float(node.count), b.lower.x, b.lower.y, b.lower.z,
                     b.upper.x, b.upper.y, b.upper.z});
    }
  std::sort(all.begin(), all.end());
  return all;
}

Status validate(const tree::BinaryTree& tree) {
  std::vector<Box> boxes(tree.primitive_count);
  for (const tree::Node& node : tree.nodes)
    for (std::uint32_t i = 0; i < node.count; ++i) boxes[tree.references[node.first + i]] = node.bounds;
  return tree::validate(tree, {.primitive_boxes = boxes});
}

tree::BinaryTree reinserted(const tree::BinaryTree& tree, const ReinsertionOptions& options = {.share = 1},
                            ReinsertionReport* report = nullptr) {
  SequentialExecutor executor;
  auto result = optimizers::reinsert(clone(tree), options, executor, report);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

// ---- An independent answer: trees as vectors of children, moved by the definition and priced anew -----------------

struct Plain {
  std::vector<Box> boxes;
  std::vector<std::array<int, 2>> children;  // -1: a leaf
  int root = 0;
};

Plain plain(const tree::BinaryTree& tree) {
  Plain out;
  for (const tree::Node& node : tree.nodes) {
    out.boxes.push_back(node.bounds);
    out.children.push_back({node.is_leaf() ? -1 : int(node.first), node.is_leaf() ? -1 : int(node.first) + 1});
  }
  return out;
}

Box refit(Plain& tree, int node, double& sum) {
  const auto [left, right] = tree.children[std::size_t(node)];
  if (left < 0) return tree.boxes[std::size_t(node)];
  const Box box = merge(refit(tree, left, sum), refit(tree, right, sum));
  sum += double(box.half_area());
  return box;
}

bool holds(const Plain& tree, int node, int other) {
  if (node == other) return true;
  const auto [left, right] = tree.children[std::size_t(node)];
  return left >= 0 && (holds(tree, left, other) || holds(tree, right, other));
}

int parent_of(const Plain& tree, int node) {
  for (std::size_t i = 0; i < tree.children.size(); ++i)
    if (tree.children[i][0] == node || tree.children[i][1] == node) return int(i);
  return -1;
}

/// The price after `node` has been put beside `target`; that of the tree as it is when it can't be.
double price_after(Plain tree, int node, int target) {
  const auto child = [&](int parent, int which) -> int& {
    auto& pair = tree.children[std::size_t(parent)];
    return pair[0] == which ? pair[0] : pair[1];
  };
  const int parent = parent_of(tree, node);
  if (parent >= 0 && target != parent && !holds(tree, node, target)) {
    const auto pair = tree.children[std::size_t(parent)];
    const int sibling = pair[0] == node ? pair[1] : pair[0];
    if (target != sibling) {
      const int grandparent = parent_of(tree, parent);
      if (grandparent < 0)
        tree.root = sibling;
      else
        child(grandparent, parent) = sibling;
      const int above = parent_of(tree, target);
      if (above < 0 || target == tree.root)
        tree.root = parent;
      else
        child(above, target) = parent;
      tree.children[std::size_t(parent)] = {node, target};
    }
  }
  double sum = 0;
  refit(tree, tree.root, sum);
  return sum;
}

double best_by_trial(const tree::BinaryTree& tree, int node) {
  const Plain start = plain(tree);
  double best = price_after(start, node, node);
  for (std::size_t target = 0; target < tree.nodes.size(); ++target)
    best = std::min(best, price_after(start, node, int(target)));
  return best;
}

TEST(ReinsertionSearch, finds_what_trying_all_places_finds) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const tree::BinaryTree tree = test::random_tree(seed, 3 + seed * 2, 2);
    optimizers::PairedTree paired;
    paired.nodes = AlignedBuffer<tree::Node>(tree.nodes.size() + 1);
    paired.parents.resize(paired.nodes.size() / 2);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      tree::Node& node = paired.nodes[i == 0 ? 0 : i + 1] = tree.nodes[i];
      if (!node.is_leaf()) paired.parents[++node.first / 2] = std::uint32_t(i == 0 ? 0 : i + 1);
    }
    const auto area = [](const Box& box) { return box.half_area(); };
    optimizers::ReinsertionSearch<decltype(area)> search(paired, area);
    const double before = price(tree);
    for (std::uint32_t node = 2; node < paired.nodes.size(); ++node) {
      const Reinsertion found = search.best_place(node);
      EXPECT_NEAR(before - double(found.gain), best_by_trial(tree, int(node) - 1), 1e-4 * before) << "node " << node;
    }
  }
}

TEST(Reinsertion, a_leaf_crosses_the_top_split) {
  // Two groups of four unit boxes far apart; one box of each group stands among the others.
  std::vector<test::ShapeNode> shape;
  const auto leaf = [&](float x) {
    shape.push_back({Box{{x, 0, 0}, {x + 1, 1, 1}}, 1});
    return shape.size() - 1;
  };
  const auto join = [&](std::size_t left, std::size_t right) {
    shape.push_back({Box{}, 0, left, right});
    return shape.size() - 1;
  };
  const auto half = [&](float a, float b, float c, float d) {
    const std::size_t left = join(leaf(a), leaf(b));
    return join(left, join(leaf(c), leaf(d)));
  };
  const std::size_t left = half(0, 1, 2, 100), right = half(3, 101, 102, 103);
  const tree::BinaryTree tree = test::canonical_tree(shape, join(left, right));
  const tree::BinaryTree better = reinserted(tree);
  EXPECT_TRUE(validate(better)) << validate(better).error().message;
  EXPECT_EQ(leaves(better), leaves(tree));
  // Root; two halves of 4 boxes; each of 2 + 2 or, as cheap, no other way.
  const double best = double(Box{{0, 0, 0}, {104, 1, 1}}.half_area()) +
                      2 * double(Box{{0, 0, 0}, {4, 1, 1}}.half_area()) +
                      4 * double(Box{{0, 0, 0}, {2, 1, 1}}.half_area());
  EXPECT_NEAR(price(better), best, 1e-3);
}

TEST(Reinsertion, trees_stay_valid_keep_their_leaves_and_get_cheaper) {
  for (std::uint32_t seed = 20; seed < 28; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const tree::BinaryTree tree = test::random_tree(seed, 200 * (seed - 19), 3, 0.5f);
    ReinsertionReport report;
    const tree::BinaryTree better = reinserted(tree, {.passes = 20, .share = 1, .least_gain = 0}, &report);
    EXPECT_TRUE(validate(better)) << validate(better).error().message;
    EXPECT_EQ(leaves(better), leaves(tree));
    EXPECT_LT(price(better), 0.5 * price(tree)) << "random trees are far from good ones";
    EXPECT_NEAR(report.price_after / report.price_before, price(better) / price(tree), 1e-4);
    EXPECT_GT(report.moves, 0u);
  }
}

TEST(Reinsertion, no_move_is_left_once_it_has_converged) {
  const tree::BinaryTree tree = test::random_tree(77, 24, 1);
  const tree::BinaryTree better = reinserted(tree, {.passes = 1000, .share = 1, .least_gain = 0});
  const double end = price(better);
  for (std::size_t node = 1; node < better.nodes.size(); ++node)
    EXPECT_GE(best_by_trial(better, int(node)), end * (1 - 1e-4)) << "node " << node;
}

TEST(Reinsertion, another_price_makes_another_tree) {
  const tree::BinaryTree tree = test::random_tree(5, 300, 1, 0.5f);
  ReinsertionOptions options{.passes = 10, .share = 1, .least_gain = 0};
  options.price = [](const Box& box) { return box.extent().x; };
  const auto widths = [](const tree::BinaryTree& t) {
    double sum = 0;
    for (const tree::Node& node : t.nodes)
      if (!node.is_leaf()) sum += double(node.bounds.extent().x);
    return sum;
  };
  const tree::BinaryTree narrow = reinserted(tree, options),
                         small = reinserted(tree, {.passes = 10, .share = 1, .least_gain = 0});
  EXPECT_TRUE(validate(narrow));
  EXPECT_LT(widths(narrow), 0.9 * widths(small));
  EXPECT_LT(price(small), 0.9 * price(narrow));
}

TEST(Reinsertion, same_bits_on_every_executor) {
  const tree::BinaryTree tree = test::random_tree(9, 5000, 2, 0.3f);
  const std::uint64_t expected = tree::hash(reinserted(tree));
  for (const int threads : {1, 2, 7}) {
    ThreadExecutor executor(threads);
    auto result = optimizers::reinsert(clone(tree), {.share = 1}, executor);
    ASSERT_TRUE(result);
    EXPECT_EQ(tree::hash(*result), expected) << threads << " threads";
  }
}

TEST(Reinsertion, small_trees_stay_as_they_are) {
  EXPECT_TRUE(reinserted(tree::BinaryTree{}).empty());
  for (const std::size_t count : {1u, 2u}) {
    const tree::BinaryTree tree = test::random_tree(1, count, 3);
    EXPECT_EQ(tree::hash(reinserted(tree)), tree::hash(tree));
  }
}

TEST(Reinsertion, none_left_out_where_boxes_have_no_area) {
  std::vector<test::ShapeNode> shape{{Box{{1, 2, 3}, {1, 2, 3}}, 1}};
  std::size_t root = 0;
  for (int i = 0; i < 500; ++i) {
    shape.push_back({Box{{1, 2, 3}, {1, 2, 3}}, 1});
    shape.push_back({Box{}, 0, root, shape.size() - 1});
    root = shape.size() - 1;
  }
  const tree::BinaryTree tree = test::canonical_tree(shape, root);
  EXPECT_EQ(leaves(reinserted(tree)), leaves(tree));
}

TEST(Reinsertion, huge_and_tiny_coordinates) {
  for (const float scale : {1e17f, 1e-25f}) {
    tree::BinaryTree tree = test::random_tree(3, 400, 1, 0.5f);
    const double before = price(tree);
    for (tree::Node& node : tree.nodes) node.bounds = {node.bounds.lower * scale, node.bounds.upper * scale};
    tree::BinaryTree better = reinserted(tree);
    EXPECT_TRUE(validate(better));
    for (tree::Node& node : better.nodes)
      node.bounds = {node.bounds.lower * (1 / scale), node.bounds.upper * (1 / scale)};
    EXPECT_LT(price(better), 0.7 * before) << "scale " << scale;
  }
}

TEST(Reinsertion, a_chain_of_many_levels) {
  const tree::BinaryTree tree = test::chain_tree(20000, 2);
  const tree::BinaryTree better = reinserted(tree, {.passes = 2, .share = 1});
  EXPECT_TRUE(validate(better)) << validate(better).error().message;
  EXPECT_EQ(leaves(better), leaves(tree));
}

TEST(Reinsertion, refuses_options_out_of_range) {
  SequentialExecutor executor;
  const auto message = [&](const ReinsertionOptions& options) {
    const auto result = optimizers::reinsert(test::random_tree(1, 9, 1), options, executor);
    return result ? std::string() : result.error().message;
  };
  EXPECT_NE(message({.passes = -1}).find("-1"), std::string::npos);
  EXPECT_NE(message({.passes = 1001}).find("1001"), std::string::npos);
  EXPECT_NE(message({.passes = 1, .least_gain = 2}).find("gain"), std::string::npos);
  EXPECT_NE(message({.share = 0}).find("share"), std::string::npos);
  EXPECT_NE(message({.passes = 1, .least_gain = std::nanf("")}).find("gain"), std::string::npos);
}

TEST(Optimizer, reads_what_it_writes) {
  for (const char* text : {"none", "reinsertion:passes=3,share=0.5,gain=0.25"}) {
    const auto optimizer = optimizers::parse_optimizer(text);
    ASSERT_TRUE(optimizer) << optimizer.error().message;
    EXPECT_EQ(optimizer->text(), text);
  }
  EXPECT_EQ(optimizers::parse_optimizer("reinsertion")->value("passes"), 16);
  EXPECT_TRUE(optimizers::Optimizer{}.is_none());
}

TEST(Optimizer, says_what_it_cannot_read) {
  for (const char* text : {"", "magic", "reinsertion:", "reinsertion:passes", "reinsertion:passes=x",
                           "reinsertion:passes=1,passes=2", "reinsertion:passes=2.5", "reinsertion:gain=2",
                           "reinsertion:share=0", "none:passes=1", "reinsertion:speed=1"}) {
    const auto optimizer = optimizers::parse_optimizer(text);
    ASSERT_FALSE(optimizer) << text;
    EXPECT_NE(optimizer.error().message.find("optimizer"), std::string::npos) << optimizer.error().message;
  }
}

TEST(Optimizer, runs_and_notes_what_it_did) {
  SequentialExecutor executor;
  const tree::BinaryTree tree = test::random_tree(4, 200, 1);
  const auto none = optimizers::apply_optimizer(clone(tree), {}, executor);
  EXPECT_EQ(tree::hash(*none), tree::hash(tree));
  const auto better =
      optimizers::apply_optimizer(clone(tree), *optimizers::parse_optimizer("reinsertion:passes=2"), executor);
  EXPECT_LT(price(*better), price(tree));
  EXPECT_FALSE(better->notes.empty());
}

}  // namespace
}  // namespace boxwood
