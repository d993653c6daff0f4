// PLOC, AAC and EBBVH: what each of them promises beyond a valid tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "unit/builders/morton_builder_cases.h"
#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

using namespace test;

double volume_cost(const tree::BinaryTree& tree) {
  return metrics::surface_area_cost(tree, {1, 1});
}

tree::BinaryTree build_mesh(const TriangleMesh& mesh, const char* id, const Settings& settings = {}) {
  SequentialExecutor executor;
  auto set = refs::make_references(mesh, executor);
  EXPECT_TRUE(set);
  auto tree = builders::build(std::move(*set), {id, settings}, {executor});
  EXPECT_TRUE(tree) << tree.error().message;
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) boxes.push_back(mesh.view().triangle(t).bounds());
  const Status valid = tree::validate(*tree, {.primitive_boxes = boxes});
  EXPECT_TRUE(valid) << valid.error().message;
  return std::move(*tree);
}

double note(const tree::BinaryTree& tree, const std::string& name) {
  for (const auto& [key, value] : tree.notes)
    if (key == name) return value;
  ADD_FAILURE() << "no note " << name;
  return -1;
}

/// Greedy agglomerative clustering over all pairs: the closest pair merges first. Boxes at random, so no ties.
double agglomerative_cost(std::vector<Box> boxes) {
  double sum = 0;
  for (const Box& box : boxes) sum += double(box.half_area());
  while (boxes.size() > 1) {
    std::size_t a = 0, b = 1;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t k = i + 1; k < boxes.size(); ++k)
        if (merge(boxes[i], boxes[k]).half_area() < merge(boxes[a], boxes[b]).half_area()) a = i, b = k;
    boxes[a].grow(boxes[b]);
    sum += double(boxes[a].half_area());
    boxes.erase(boxes.begin() + std::ptrdiff_t(b));
  }
  return sum / double(boxes[0].half_area());
}

TEST(Aac, FewReferencesClusterLikeAllPairs) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const auto boxes = random_boxes(9, seed, 6);  // fewer than delta: the Morton order decides nothing
    const auto tree = build_valid(boxes, "aac", {{"leaf.max", "1"}});
    // Nine are reduced to ten, so all merges are the root's.
    EXPECT_NEAR(volume_cost(tree), agglomerative_cost(boxes), 1e-4) << seed;
  }
}

TEST(Ploc, WideRadiusMergesAllMutualNeighbours) {
  // Two far groups of two: whatever the order, each finds its own.
  const std::vector<Box> boxes{
      {{0, 0, 0}, {1, 1, 1}}, {{50, 0, 0}, {51, 1, 1}}, {{0, 1, 0}, {1, 2, 1}}, {{50, 0, 1}, {51, 1, 2}}};
  const auto tree = build_valid(boxes, "ploc", {{"leaf.max", "1"}});
  EXPECT_EQ(tree.nodes[1].bounds, (Box{{0, 0, 0}, {1, 2, 1}}));
  EXPECT_EQ(tree.nodes[2].bounds, (Box{{50, 0, 0}, {51, 1, 2}}));
}

TEST(Ploc, EqualBoxesMakeABalancedTree) {
  const std::vector<Box> boxes(4096, Box{{1, 1, 1}, {2, 2, 2}});
  EXPECT_EQ(tree::statistics(build_valid(boxes, "ploc", {{"leaf.max", "1"}})).max_depth, 12u);
}

TEST(Ploc, NestedBoxesDoNotTakeARoundEach) {
  std::vector<Box> boxes;
  for (int i = 1; i <= 20000; ++i) boxes.push_back({{-float(i), -float(i), -float(i)}, {float(i), float(i), float(i)}});
  EXPECT_LE(tree::statistics(build_valid(boxes, "ploc", {{"leaf.max", "1"}})).max_depth, 160u);
}

TEST(BottomUp, BetterThanTheMortonTreeTheyStartFrom) {
  const auto boxes = scan_boxes(50);
  const double lbvh = volume_cost(build_valid(boxes, "lbvh", {{"leaf.max", "1"}}));
  EXPECT_LT(volume_cost(build_valid(boxes, "ploc", {{"leaf.max", "1"}})), lbvh);
  EXPECT_LT(volume_cost(build_valid(boxes, "aac", {{"leaf.max", "1"}})), lbvh);
  EXPECT_LT(volume_cost(build_valid(boxes, "aac", {{"leaf.max", "1"}, {"quality", "fast"}})), lbvh);
}

TEST(Ebbvh, CubeIsPairedIntoItsSides) {
  const auto tree = build_mesh(test::exploded(test::cube()), "ebbvh", {{"rounds", "1"}, {"leaf.max", "1"}});
  EXPECT_EQ(note(tree, "pairs of round 1"), 6);
  EXPECT_EQ(note(tree, "roots"), 6);
  std::size_t sides = 0;  // inner nodes over two triangles of one side
  for (const tree::Node& node : tree.nodes)
    if (!node.is_leaf() && tree.nodes[node.first].is_leaf() && tree.nodes[node.first + 1].is_leaf())
      sides +=
          tree.references[tree.nodes[node.first].first] / 2 == tree.references[tree.nodes[node.first + 1].first] / 2;
  EXPECT_EQ(sides, 6u);
}

TEST(Ebbvh, IndicesAloneDoNotConnectAnExplodedMesh) {
  const auto tree = build_mesh(test::exploded(test::cube()), "ebbvh", {{"weld", "index"}});
  EXPECT_EQ(note(tree, "roots"), 12);
}

TEST(Ebbvh, ConnectedMeshEndsInOneRoot) {
  const auto tree = build_mesh(test::wave(40, 30), "ebbvh");
  EXPECT_EQ(note(tree, "roots"), 1);
  EXPECT_EQ(tree.references.size(), 2400u);
}

TEST(Ebbvh, GatesKeepClustersSmall) {
  const auto mesh = test::wave(40, 30);
  EXPECT_GE(note(build_mesh(mesh, "ebbvh", {{"gate.size", "4"}}), "roots"), 600);
  EXPECT_EQ(note(build_mesh(mesh, "ebbvh", {{"gate.area", "0.01"}}), "roots"), 2400);
  EXPECT_EQ(note(build_mesh(mesh, "ebbvh", {{"pair_cutoff", "1000000"}}), "rounds"), 1);
}

TEST(Ebbvh, EveryTopGivesAValidTree) {
  const auto mesh = test::wave(25, 20);
  for (const char* id : {"ebbvh", "ebbvh-gated"})
    for (const builders::OptionSpec& spec : builders::find(id)->options)
      if (std::string_view(spec.key) == "top") {
        for (const char* top : spec.choices)
          for (const char* leaf : {"0", "1", "4"})
            build_mesh(mesh, id, {{"top", top}, {"rounds", "2"}, {"leaf.max", leaf}});
        EXPECT_GE(spec.choices.size(), 6u);
      }
}

TEST(Ebbvh, TopsThatSplitReferencesAreRefused) {
  for (const builders::BuilderInfo& info : builders::registry()) {
    if (!info.splits_references) continue;
    const auto options = builders::resolve_options("ebbvh", {{"top", info.id}});
    ASSERT_FALSE(options);
    EXPECT_NE(options.error().message.find("option 'top'"), std::string::npos);
  }
}

TEST(EdgeClusters, RoundsOfAStripHalveItsClusters) {
  const auto mesh = test::wave(8, 1);
  SequentialExecutor executor;
  const auto set = refs::make_references(mesh, executor);
  ASSERT_TRUE(set);
  std::size_t last = 16;
  for (std::uint32_t rounds = 0; rounds <= 4; ++rounds) {
    const auto clusters = builders::edge_clusters(*set, rounds, mesh::Weld::position, {executor});
    ASSERT_TRUE(clusters);
    ASSERT_EQ(clusters->size(), 16u);
    const std::set<std::uint32_t> distinct(clusters->begin(), clusters->end());
    EXPECT_EQ(*distinct.rbegin(), distinct.size() - 1) << "numbered without gaps";
    if (rounds == 0) {
      EXPECT_EQ(distinct.size(), 16u);
    } else {
      EXPECT_LT(distinct.size(), last);
    }
    last = distinct.size();
  }
}

TEST(EdgeClusters, TrianglesWithoutAReferenceHaveNoCluster) {
  auto mesh = test::wave(3, 1);
  mesh.vertices.push_back({NAN, 0, 0});
  mesh.triangles.push_back({0, 1, std::uint32_t(mesh.vertices.size() - 1)});
  SequentialExecutor executor;
  const auto set = refs::make_references(mesh, executor);
  ASSERT_TRUE(set);
  const auto clusters = builders::edge_clusters(*set, 5, mesh::Weld::index, {executor});
  ASSERT_TRUE(clusters);
  EXPECT_EQ(clusters->back(), builders::kNoCluster);
  EXPECT_EQ(clusters->front(), 0u);
}

}  // namespace
}  // namespace boxwood
