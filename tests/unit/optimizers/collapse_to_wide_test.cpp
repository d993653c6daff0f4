#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>

#include "boxwood/optimizers.h"
#include "unit/optimizers/binary_shapes.h"

namespace boxwood {
namespace {

using optimizers::CollapseOptions;
using test::canonical_tree;
using test::chain_tree;
using test::random_tree;
using test::ShapeNode;
using tree::BinaryTree;
using tree::WideTree;

double area(const Box& b) {
  const double x = double(b.upper.x) - b.lower.x, y = double(b.upper.y) - b.lower.y, z = double(b.upper.z) - b.lower.z;
  return x * y + y * z + z * x;
}

WideTree collapse(const BinaryTree& binary, const CollapseOptions& options) {
  SequentialExecutor executor;
  auto wide = optimizers::collapse_to_wide(binary, options, executor);
  EXPECT_TRUE(wide) << (wide ? "" : wide.error().message);
  return wide ? std::move(*wide) : WideTree{};
}

/// Price of the wide tree as it stands. A root that is one leaf costs no node.
double price(const WideTree& wide, const CollapseOptions& options) {
  const std::size_t nodes = wide.first_child.size() - 1;
  double sum = 0;
  const bool leaf_root = nodes == 1 && wide.children.size() == 1;
  if (!leaf_root) sum += area(wide.bounds) * double(options.node_cost);
  for (const auto& child : wide.children) {
    const double blocks = std::ceil(double(child.count) / options.block);
    sum += area(child.bounds) * (child.count == 0 ? double(options.node_cost) : blocks);
  }
  return sum;
}

/// Everything a wide tree promises, by one walk over all of it.
void check_structure(const BinaryTree& binary, const WideTree& wide, const CollapseOptions& options) {
  const std::size_t nodes = wide.first_child.size() - 1;
  ASSERT_EQ(wide.width, options.width);
  ASSERT_EQ(wide.bounds, binary.bounds());
  ASSERT_EQ(wide.first_child[0], 0u);
  ASSERT_EQ(wide.first_child[nodes], wide.children.size());

  std::vector<Box> owner(binary.references.size());  // box of the binary leaf of each reference
  for (const auto& node : binary.nodes)
    if (node.is_leaf())
      for (std::uint32_t r = 0; r < node.count; ++r) owner[node.first + r] = node.bounds;

  std::vector<std::size_t> stack_below(nodes);
  for (std::size_t n = nodes; n-- > 0;) {
    const std::size_t first = wide.first_child[n], last = wide.first_child[n + 1];
    ASSERT_LT(first, last);
    ASSERT_LE(last - first, std::size_t(options.width));
    ASSERT_TRUE(nodes == 1 || last - first >= 2) << "node " << n << " has one child";
    std::size_t deepest = 1;
    for (std::size_t c = first; c < last; ++c) {
      if (wide.children[c].count > 0) continue;
      ASSERT_GT(wide.children[c].first, n) << "child before its parent";
      ASSERT_LT(wide.children[c].first, nodes);
      deepest = std::max(deepest, stack_below[wide.children[c].first]);
    }
    stack_below[n] = last - first - 1 + deepest;
  }
  ASSERT_EQ(wide.max_stack, stack_below[0]);

  std::size_t reference = 0, visited = 0;
  std::vector<std::pair<std::uint32_t, Box>> open{{0, wide.bounds}};
  std::vector<std::uint32_t> walk;  // children still to be walked, so that leaves come from left to right
  const auto enter = [&](std::uint32_t n, const Box& bounds) {
    ASSERT_EQ(n, visited) << "nodes are numbered depth first";
    ++visited;
    Box together;
    for (std::uint32_t c = wide.first_child[n]; c < wide.first_child[n + 1]; ++c)
      together.grow(wide.children[c].bounds);
    ASSERT_EQ(together, bounds);
    for (std::uint32_t c = wide.first_child[n + 1]; c-- > wide.first_child[n];) walk.push_back(c);
  };
  enter(0, wide.bounds);
  while (!walk.empty() && !testing::Test::HasFatalFailure()) {
    const auto& child = wide.children[walk.back()];
    walk.pop_back();
    if (child.count == 0) {
      enter(child.first, child.bounds);
      continue;
    }
    ASSERT_LE(child.count, std::uint32_t(options.block * options.max_leaf_blocks));
    ASSERT_EQ(child.first, reference) << "leaves own the references in order";
    Box together;
    for (std::uint32_t r = 0; r < child.count; ++r) together.grow(owner[reference + r]);
    ASSERT_EQ(together, child.bounds);
    reference += child.count;
  }
  ASSERT_EQ(reference, binary.references.size());
  ASSERT_EQ(visited, nodes);
}

/// Cheapest wide tree by trying everything: all ways to cut a subtree into a forest, without dynamic programming.
class ExhaustiveSearch {
 public:
  ExhaustiveSearch(const BinaryTree& tree, const CollapseOptions& options) : tree_(tree), options_(options) {}

  double one_tree(std::uint32_t n) const {
    const tree::Node& node = tree_.nodes[n];
    double best = INFINITY;
    const std::uint32_t count = references(n);
    if (count <= limit()) best = area(node.bounds) * std::ceil(double(count) / options_.block);
    if (count > limit() || !node.is_leaf())
      for (const auto& [trees, cost] : opened(n))
        if (trees <= options_.width) best = std::min(best, area(node.bounds) * double(options_.node_cost) + cost);
    return best;
  }

 private:
  using Forests = std::vector<std::pair<int, double>>;  // number of trees and their price

  std::uint32_t limit() const { return std::uint32_t(options_.block * options_.max_leaf_blocks); }
  std::uint32_t references(std::uint32_t n) const {
    const tree::Node& node = tree_.nodes[n];
    return node.is_leaf() ? node.count : references(node.first) + references(node.first + 1);
  }
  /// All forests of two trees and more below a node, up to the width.
  Forests opened(std::uint32_t n) const {
    const tree::Node& node = tree_.nodes[n];
    if (node.is_leaf()) return chunk_forests(area(node.bounds), node.count);
    const Forests left = forests(node.first), right = forests(node.first + 1);
    Forests both;
    for (const auto& [a, cost_a] : left)
      for (const auto& [b, cost_b] : right)
        if (a + b <= options_.width) both.push_back({a + b, cost_a + cost_b});
    return both;
  }
  Forests forests(std::uint32_t n) const {
    Forests all{{1, one_tree(n)}};
    if (!tree_.nodes[n].is_leaf() || tree_.nodes[n].count > limit())
      for (const auto& forest : opened(n)) all.push_back(forest);
    return all;
  }
  /// A leaf above the limit as two trees or more: each first tree takes any number of chunks.
  Forests chunk_forests(double a, std::uint32_t count) const {
    Forests all;
    const int chunks = int((count + limit() - 1) / limit());
    const double blocks = std::ceil(double(count) / options_.block);
    for (int trees = 2; trees <= std::min(chunks, options_.width); ++trees)
      all.push_back({trees, a * (blocks + double(options_.node_cost) * fewest_nodes(chunks, trees))});
    return all;
  }
  int fewest_nodes(int chunks, int trees) const {
    if (trees == 1 && chunks == 1) return 0;
    int best = 1 << 20;
    if (trees == 1) {
      for (int below = 2; below <= std::min(chunks, options_.width); ++below)
        best = std::min(best, 1 + fewest_nodes(chunks, below));
    } else {
      for (int first = 1; first <= chunks - (trees - 1); ++first)
        best = std::min(best, fewest_nodes(first, 1) + fewest_nodes(chunks - first, trees - 1));
    }
    return best;
  }

  const BinaryTree& tree_;
  const CollapseOptions& options_;
};

TEST(CollapseToWide, is_as_cheap_as_exhaustive_search) {
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    CollapseOptions options;
    options.width = 2 + int(seed % 5);
    options.block = 1 + int(seed / 3 % 4);
    options.max_leaf_blocks = 1 + int(seed / 5 % 3);
    options.node_cost = 0.25f * float(1 + seed % 7);
    const auto binary = random_tree(seed, 1 + seed % 9, seed % 3 == 0 ? 9 : 2, seed % 2 ? 0.5f : 6.0f);
    const auto wide = collapse(binary, options);
    SCOPED_TRACE("seed " + std::to_string(seed));
    check_structure(binary, wide, options);
    const double expected = ExhaustiveSearch(binary, options).one_tree(0);
    ASSERT_NEAR(price(wide, options), expected, 1e-9 * expected);
  }
}

TEST(CollapseToWide, wider_nodes_and_larger_leaves_are_never_dearer) {
  const auto binary = random_tree(7, 3000, 3, 0.3f);
  CollapseOptions options;
  double last = INFINITY;
  for (options.width = 2; options.width <= 16; ++options.width) {
    const auto wide = collapse(binary, options);
    check_structure(binary, wide, options);
    const double now = price(wide, options);
    EXPECT_LE(now, last * (1 + 1e-9)) << options.width;
    last = now;
  }
  last = INFINITY;
  options.width = 8;
  for (options.max_leaf_blocks = 1; options.max_leaf_blocks <= 8; ++options.max_leaf_blocks) {
    const auto wide = collapse(binary, options);
    check_structure(binary, wide, options);
    const double now = price(wide, options);
    EXPECT_LE(now, last * (1 + 1e-9)) << options.max_leaf_blocks;
    last = now;
  }
}

TEST(CollapseToWide, node_cost_trades_nodes_for_blocks) {
  const auto binary = random_tree(11, 2000, 1, 0.3f);
  CollapseOptions cheap, dear;
  cheap.node_cost = 0.05f;
  dear.node_cost = 20;
  EXPECT_GT(collapse(binary, cheap).first_child.size(), collapse(binary, dear).first_child.size());
}

TEST(CollapseToWide, empty_tree_gives_no_nodes) {
  const auto wide = collapse(BinaryTree{}, {});
  EXPECT_EQ(wide.width, 8);
  EXPECT_EQ(wide.first_child, LargeVector<std::uint32_t>{0});
  EXPECT_TRUE(wide.children.empty());
  EXPECT_TRUE(wide.bounds.is_empty());
  EXPECT_EQ(wide.max_stack, 0u);
}

TEST(CollapseToWide, single_leaf_is_one_node_with_one_child) {
  const auto binary = random_tree(1, 1, 1);
  const auto wide = collapse(binary, {});
  check_structure(binary, wide, {});
  ASSERT_EQ(wide.children.size(), 1u);
  EXPECT_EQ(wide.children[0].count, 1u);
  EXPECT_EQ(wide.max_stack, 1u);
}

TEST(CollapseToWide, leaf_of_a_thousand_references_is_cut_into_chunks) {
  for (const int width : {2, 3, 4, 8, 16}) {
    const auto binary = canonical_tree({{Box{{0, 0, 0}, {1, 2, 3}}, 1000}}, 0);
    CollapseOptions options;
    options.width = width;
    const auto wide = collapse(binary, options);
    check_structure(binary, wide, options);
    const std::size_t chunks = 125, nodes = wide.first_child.size() - 1;
    EXPECT_EQ(wide.children.size(), chunks + nodes - 1);
    EXPECT_EQ(nodes, (chunks - 1 + std::size_t(width) - 2) / std::size_t(width - 1)) << "fewest nodes there can be";
    const double levels = std::ceil(std::log(double(chunks)) / std::log(double(width)));
    EXPECT_LE(wide.max_stack, std::size_t(levels) * std::size_t(width - 1) + 1) << "chunk tree is not balanced";
  }
}

TEST(CollapseToWide, large_leaf_inside_a_tree) {
  const Box big{{0, 0, 0}, {5, 5, 5}}, small{{9, 9, 9}, {10, 10, 10}};
  const auto binary = canonical_tree(
      {{small, 3}, {big, 333}, {small, 2}, {big, 9}, {Box{}, 0, 0, 1}, {Box{}, 0, 2, 3}, {Box{}, 0, 4, 5}}, 6);
  for (const int width : {2, 4, 8}) {
    CollapseOptions options;
    options.width = width;
    const auto wide = collapse(binary, options);
    check_structure(binary, wide, options);
    for (const auto& child : wide.children)
      EXPECT_TRUE(child.count == 0 || child.bounds != big || child.count % 4 == 0 || child.count < 8) << "whole blocks";
  }
}

TEST(CollapseToWide, chain_of_a_hundred_thousand_levels) {
  for (const int side : {0, 1, 2}) {
    const auto binary = chain_tree(100'000, side);
    CollapseOptions options;
    options.node_cost = 1e-3f;  // leaves as small as they come, so that the wide tree is deep, too
    const auto wide = collapse(binary, options);
    check_structure(binary, wide, options);
    EXPECT_GT(wide.first_child.size(), 5'000u);
    EXPECT_GT(wide.max_stack, 50'000u);
  }
}

TEST(CollapseToWide, points_without_area_are_packed_into_few_nodes) {
  std::vector<ShapeNode> shape(4096, {Box{{1, 1, 1}, {1, 1, 1}}, 1});
  std::size_t first = 0;
  for (std::size_t n = 4096; n > 1; n /= 2) {
    for (std::size_t i = 0; i < n; i += 2) shape.push_back({Box{}, 0, first + i, first + i + 1});
    first += n;
  }
  const auto binary = canonical_tree(shape, shape.size() - 1);
  const auto wide = collapse(binary, {});
  check_structure(binary, wide, {});
  EXPECT_EQ(wide.children.size() - (wide.first_child.size() - 2), 512u) << "leaves of two full blocks";
  EXPECT_LE(wide.first_child.size() - 1, 80u) << "nodes of nearly eight children";
}

TEST(CollapseToWide, huge_and_tiny_coordinates) {
  for (const float scale : {1e17f, 1e-30f, 1e-40f}) {
    auto binary = random_tree(5, 500, 2, 1.0f);
    for (auto& node : binary.nodes) {
      node.bounds.lower = node.bounds.lower * scale;
      node.bounds.upper = node.bounds.upper * scale;
    }
    check_structure(binary, collapse(binary, {}), {});
  }
}

void expect_equal(const WideTree& a, const WideTree& b) {
  ASSERT_EQ(a.children.size(), b.children.size());
  EXPECT_EQ(std::memcmp(a.children.data(), b.children.data(), a.children.size() * sizeof(WideTree::Child)), 0);
  EXPECT_EQ(a.first_child, b.first_child);
  EXPECT_EQ(a.max_stack, b.max_stack);
}

TEST(CollapseToWide, same_bits_on_every_executor) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const auto random = random_tree(3, 150'000, 3, 0.1f), chain = chain_tree(50'000, 2);
  for (const auto* binary : {&random, &chain}) {
    const auto expected = collapse(*binary, {});
    check_structure(*binary, expected, {});
    for (const int threads : {1, 2, 8}) {
      ThreadExecutor executor(threads);
      const auto wide = optimizers::collapse_to_wide(*binary, {}, executor);
      ASSERT_TRUE(wide);
      expect_equal(*wide, expected);
    }
  }
}

// Blocks of eight that say they hold four are blocks of four.
TEST(CollapseToWide, asks_how_many_blocks_a_leaf_takes) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const auto binary = random_tree(seed, 400, seed % 2 ? 3 : 40, 1.0f);
    CollapseOptions fours{.block = 4, .max_leaf_blocks = 4}, eights{.block = 8, .max_leaf_blocks = 2};
    eights.leaf_blocks = [&](std::span<const std::uint32_t> references) {
      EXPECT_LE(references.size(), 16u);
      EXPECT_GE(references.data(), binary.references.data());
      EXPECT_LE(&references.back(), &binary.references[binary.references.size() - 1]);
      return std::uint32_t(references.size() + 3) / 4;
    };
    expect_equal(collapse(binary, fours), collapse(binary, eights));
  }
  // And where every reference takes a block of its own, large leaves don't pay.
  const auto binary = random_tree(3, 400, 1, 1.0f);
  CollapseOptions options{.block = 8};
  const auto full = collapse(binary, options);
  options.leaf_blocks = [](std::span<const std::uint32_t> references) { return std::uint32_t(references.size()); };
  EXPECT_LT(full.first_child.size(), collapse(binary, options).first_child.size());
}

TEST(CollapseToWide, refuses_options_out_of_range) {
  const auto binary = random_tree(1, 5, 2);
  SequentialExecutor executor;
  const auto error = [&](auto change) {
    CollapseOptions options;
    change(options);
    const auto wide = optimizers::collapse_to_wide(binary, options, executor);
    EXPECT_FALSE(wide);
    if (wide) return std::string();
    EXPECT_EQ(wide.error().code, ErrorCode::out_of_range);
    return wide.error().message;
  };
  EXPECT_NE(error([](auto& o) { o.width = 1; }).find("width is 1"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.width = 17; }).find("width is 17"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.block = 0; }).find("block is 0"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.block = 17; }).find("block is 17"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.max_leaf_blocks = 0; }).find("max_leaf_blocks is 0"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.max_leaf_blocks = 9; }).find("max_leaf_blocks is 9"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.node_cost = 0; }).find("node_cost is 0"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.node_cost = NAN; }).find("node_cost is nan"), std::string::npos);
  EXPECT_NE(error([](auto& o) { o.node_cost = INFINITY; }).find("node_cost is inf"), std::string::npos);
}

TEST(CollapseToWide, refuses_trees_that_are_not_canonical) {
  SequentialExecutor executor;
  const auto refused = [&](std::size_t leaves, auto change) {
    auto binary = random_tree(2, leaves, 2);
    change(binary);
    const auto wide = optimizers::collapse_to_wide(binary, {}, executor);
    return !wide && wide.error().code == ErrorCode::malformed;
  };
  for (const std::size_t leaves : {9, 60'000}) {
    EXPECT_FALSE(refused(leaves, [](BinaryTree&) {}));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.nodes[0].first = 3; }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.nodes[0].first = 0; }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.nodes[0].count = 1; }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.nodes.truncate(t.nodes.size() - 1); }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.nodes.truncate(t.nodes.size() - 2); }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.nodes[t.nodes.size() - 1].first = 4'000'000'000u; }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) { t.references.truncate(t.references.size() - 1); }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) {
      for (auto& node : t.nodes) {
        if (!node.is_leaf()) continue;
        node.first += 1;
        break;
      }
    }));
    EXPECT_TRUE(refused(leaves, [](BinaryTree& t) {
      for (std::size_t n = 1; n < t.nodes.size(); ++n) {
        if (t.nodes[n].is_leaf()) continue;
        t.nodes[n].first -= 2;
        break;
      }
    }));
  }
}

}  // namespace
}  // namespace boxwood
