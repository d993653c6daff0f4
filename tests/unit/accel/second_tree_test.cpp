// Level `best` builds over split and over whole triangles and keeps the tree that rays will pass faster.
#include <gtest/gtest.h>

#include "boxwood/accel.h"
#include "boxwood/metrics.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

tree::BinaryTree build(const TriangleMesh& mesh, const TreePlan& plan, Executor& executor, TreeReport* report = nullptr,
                       std::vector<std::uint32_t>* split = nullptr) {
  auto tree = build_tree(mesh, plan, {executor}, report, split);
  EXPECT_TRUE(tree) << tree.error().message;
  return std::move(*tree);
}

/// The plan of `best` without one of its two trees.
TreePlan only(const builders::BuildOptions& build) {
  return *plan_tree(build, "none", "reinsertion");
}

void expect_the_cheaper_tree(const TriangleMesh& mesh, bool whole) {
  SCOPED_TRACE(mesh.name);
  SequentialExecutor executor;
  const auto plan = plan_tree({"best", {}});
  ASSERT_TRUE(plan);
  TreeReport report;
  std::vector<std::uint32_t> split;
  const tree::BinaryTree kept = build(mesh, *plan, executor, &report, &split);
  const tree::BinaryTree first = build(mesh, only(plan->build), executor);
  const tree::BinaryTree second = build(mesh, only(plan->second), executor);

  EXPECT_EQ(report.second_tree_cost, metrics::surface_area_cost(second) / metrics::surface_area_cost(first));
  EXPECT_EQ(report.kept_second_tree(), whole);
  EXPECT_EQ(tree::hash(kept), tree::hash(whole ? second : first));
  EXPECT_NE(tree::hash(first), tree::hash(second)) << "there would be nothing to choose from";
  std::size_t marked = 0;
  for (const std::uint32_t mark : split) marked += mark;
  EXPECT_EQ(marked > 0, kept.references.size() > mesh.triangles.size());
  for (const int threads : test::thread_counts()) {
    ThreadExecutor threaded(threads);
    EXPECT_EQ(tree::hash(build(mesh, *plan, threaded)), tree::hash(kept)) << threads;
  }
}

TEST(SecondTree, IsKeptWhereSplittingGainsNothing) {
  expect_the_cheaper_tree(mesh::make_scene("city", {.triangles = test::effort(4000, 2)})->mesh, true);
}

TEST(SecondTree, IsDroppedWhereSplittingPays) {
  expect_the_cheaper_tree(mesh::make_scene("spaceship", {.triangles = test::effort(4000, 2)})->mesh, false);
}

TEST(SecondTree, TakesTheSettingsThatItsBuilderHas) {
  const auto plan = plan_tree({"best", {{"growth", "1.5"}, {"leaf.max", "8"}, {"alpha", "0.5"}}});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->build.settings.at("alpha"), "0.5") << "what is asked for goes before the level's";
  EXPECT_EQ(plan->second.builder, "sweep-sah");
  EXPECT_EQ(plan->second.settings.size(), 1u);
  EXPECT_EQ(plan->second.settings.at("leaf.max"), "8");
  const auto sbvh = plan_tree({"sbvh", {}});
  EXPECT_TRUE(sbvh && sbvh->second.builder.empty()) << "a builder by its name is built alone";
}

TEST(SecondTree, ProgressNeverGoesBack) {
  const TriangleMesh mesh = test::soup(2000, 3);
  SequentialExecutor executor;
  double last = 0;
  const auto tree = build_tree(mesh, *plan_tree({"best", {}}), {executor, [&](double done) {
                                                                  EXPECT_GE(done, last);
                                                                  EXPECT_LE(done, 1);
                                                                  last = done;
                                                                }});
  EXPECT_TRUE(tree);
  EXPECT_GT(last, 0.9);
}

TEST(SecondTree, AnEmptyMeshIsBuilt) {
  SequentialExecutor executor;
  TreeReport report;
  EXPECT_TRUE(build(TriangleMesh{}, *plan_tree({"best", {}}), executor, &report).nodes.empty());
  EXPECT_EQ(report.second_tree_cost, 0);
}

}  // namespace
}  // namespace boxwood
