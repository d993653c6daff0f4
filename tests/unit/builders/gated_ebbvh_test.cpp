// Gated EBBVH: pairs below a binned top, and the best of all trees over the last few.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "unit/builders/morton_builder_cases.h"
#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

using namespace test;

constexpr tree::CostModel kCost{1, 1.5f};

/// The cheapest binary tree over the boxes of a set, by trying all of them, times the area of everything.
double best_cost(const std::vector<Box>& boxes, std::uint32_t set, std::uint32_t leaf_max) {
  Box box;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (set >> i & 1) box.grow(boxes[i]), ++count;
  const double area = double(box.half_area());
  double best = count == 1 || count <= leaf_max ? double(kCost.intersection) * count * area : INFINITY;
  for (std::uint32_t left = (set - 1) & set; left != 0; left = (left - 1) & set)
    best = std::min(best, double(kCost.traversal) * area + best_cost(boxes, left, leaf_max) +
                              best_cost(boxes, set ^ left, leaf_max));
  return best;
}

tree::BinaryTree build_gated(const TriangleMesh& mesh, Executor& executor, const Settings& settings = {}) {
  auto set = refs::make_references(mesh, executor);
  EXPECT_TRUE(set);
  auto tree = builders::build(std::move(*set), {"ebbvh-gated", settings}, {executor});
  EXPECT_TRUE(tree) << tree.error().message;
  std::vector<Box> boxes(mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    if (mesh::is_usable(mesh.view().triangle(t))) boxes[t] = mesh.view().triangle(t).bounds();
  const Status valid = tree::validate(*tree, {.primitive_boxes = boxes});
  EXPECT_TRUE(valid) << valid.error().message;
  return std::move(*tree);
}

double roots(const tree::BinaryTree& tree) {
  for (const auto& [key, value] : tree.notes)
    if (key == "roots") return value;
  return -1;
}

TEST(GatedEbbvh, FewReferencesGetTheBestTree) {
  for (std::uint32_t count = 2; count <= 4; ++count)
    for (std::uint32_t seed = 1; seed <= 40; ++seed)
      for (const std::uint32_t leaf_max : {1u, 2u, 16u}) {
        const auto boxes = random_boxes(count, seed, 5);
        const auto tree = build_valid(boxes, "ebbvh-gated", {{"leaf.max", std::to_string(leaf_max)}});
        const double root_area = double(tree.bounds().half_area());
        EXPECT_NEAR(metrics::surface_area_cost(tree, kCost) * root_area, best_cost(boxes, (1u << count) - 1, leaf_max),
                    1e-4 * root_area)
            << count << " boxes, seed " << seed << ", leaf.max " << leaf_max;
      }
}

TEST(GatedEbbvh, TrianglesThatFillTheirBoxTogetherArePairs) {
  SequentialExecutor executor;
  const TriangleMesh cube = exploded(test::cube());
  const auto tree = build_gated(cube, executor);
  EXPECT_EQ(roots(tree), 6);
  // Both halves of a side have the side's box: nothing is gained by taking them apart.
  for (const tree::Node& node : tree.nodes)
    if (node.is_leaf()) {
      EXPECT_EQ(node.count, 2u);
      EXPECT_EQ(tree.references[node.first] / 2, tree.references[node.first + 1] / 2);
    }
  for (const tree::Node& node : build_gated(cube, executor, {{"leaf.max", "1"}}).nodes) EXPECT_LE(node.count, 1u);
  EXPECT_EQ(roots(build_gated(cube, executor, {{"weld", "index"}})), 12);
}

TEST(GatedEbbvh, NearbySearchPairsWhatFollowsSoonAndSharesAnEdge) {
  SequentialExecutor executor;
  const auto pairs = [&](const TriangleMesh& mesh, const char* search) {
    return double(mesh.triangles.size()) - roots(build_gated(mesh, executor, {{"search", search}}));
  };
  TriangleMesh quads = wave(20, 15);  // both halves of a quad stand side by side
  EXPECT_GT(pairs(quads, "near"), 200);
  // Six triangles after each other are looked at: five strangers between the halves are not too many, six are.
  const auto apart = [&](std::size_t between) {
    TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}});
    for (std::size_t i = 0; i < between; ++i) {
      const auto first = std::uint32_t(mesh.vertices.size());
      for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}})
        mesh.vertices.push_back(corner + Vec3{0, 9, 4 * float(i)});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    mesh.triangles.push_back({0, 2, 3});
    return mesh;
  };
  EXPECT_EQ(pairs(apart(5), "near"), 1);
  EXPECT_EQ(pairs(apart(6), "near"), 0);
  EXPECT_EQ(pairs(apart(6), "all"), 1);
  // A box that is filled together is not enough: these cross, and have no corner in common.
  const TriangleMesh cross = test::make_mesh(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0.01f}, {0, 1, 0.01f}, {1, 1, 0.01f}}, {{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(pairs(cross, "near"), 0);
  TriangleMesh touching = cross;
  touching.triangles[1] = {0, 4, 2};
  EXPECT_EQ(pairs(touching, "near"), 1);
}

TEST(GatedEbbvh, PartsOfOneTriangleAreNoPair) {
  SequentialExecutor executor;
  const TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {8, 0, 0}, {8, 8, 0.5f}}, {{0, 1, 2}});
  for (const char* search : {"near", "all"}) {
    auto set = refs::make_references(mesh, executor);
    ASSERT_TRUE(set);
    auto split = refs::apply_presplit(std::move(*set), mesh, *refs::parse_presplit("esc:k=1000"), executor);
    ASSERT_TRUE(split);
    const auto parts = double(split->references.size());
    ASSERT_GT(parts, 1);
    const auto tree = builders::build(std::move(*split), {"ebbvh-gated", {{"search", search}}}, {executor});
    ASSERT_TRUE(tree) << tree.error().message;
    EXPECT_EQ(roots(*tree), parts) << search;
  }
}

TEST(GatedEbbvh, GatesRefusePairs) {
  SequentialExecutor executor;
  const TriangleMesh mesh = wave(20, 15);
  EXPECT_EQ(roots(build_gated(mesh, executor, {{"gate.area", "0.01"}})), 600);
  EXPECT_EQ(roots(build_gated(mesh, executor, {{"gate.size", "1"}})), 600);
  EXPECT_LT(roots(build_gated(mesh, executor, {{"gate.area", "0"}})), 400);
}

TEST(GatedEbbvh, NumbersOfTrianglesSurviveUnusableOnes) {
  SequentialExecutor executor;
  TriangleMesh mesh = wave(20, 15);
  mesh.vertices.push_back({NAN, 0, 0});
  const auto bad = std::uint32_t(mesh.vertices.size() - 1);
  mesh.triangles.insert(mesh.triangles.begin() + 7, {0, 1, bad});
  mesh.triangles.insert(mesh.triangles.begin(), {bad, 0, 1});
  EXPECT_EQ(build_gated(mesh, executor).references.size(), 600u);
}

TEST(GatedEbbvh, SameBitsForEveryNumberOfThreads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const TriangleMesh mesh = wave(140, 140);  // several chunks of triangles
  SequentialExecutor sequential;
  const std::uint64_t hash = tree::hash(build_gated(mesh, sequential));
  for (const int threads : {2, 8}) {
    ThreadExecutor executor(threads);
    EXPECT_EQ(tree::hash(build_gated(mesh, executor)), hash) << threads;
  }
}

}  // namespace
}  // namespace boxwood
