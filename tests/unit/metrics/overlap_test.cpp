#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "boxwood/render.h"
#include "support/meshes.h"
#include "unit/tree/trees.h"

namespace boxwood {
namespace {

tree::BinaryTree build(const MeshView& mesh, const char* builder, Executor& executor) {
  auto references = refs::make_references(mesh, executor);
  EXPECT_TRUE(references);
  auto tree = builders::build(std::move(*references), {.builder = builder}, {executor});
  EXPECT_TRUE(tree);
  return std::move(*tree);
}

bool owns(const tree::BinaryTree& tree, std::uint32_t index, std::uint32_t primitive) {
  const tree::Node& node = tree.nodes[index];
  if (!node.is_leaf()) return owns(tree, node.first, primitive) || owns(tree, node.first + 1, primitive);
  for (std::uint32_t i = 0; i < node.count; ++i)
    if (tree.references[node.first + i] == primitive) return true;
  return false;
}

/// Points at random places of triangles instead of clipped polygons: an estimate with its standard error.
metrics::Estimate overlap_by_points(const tree::BinaryTree& tree, const MeshView& mesh, const tree::CostModel& cost) {
  test::Random random(7);
  double areas = 0, sum = 0, variance = 0;
  constexpr int kPoints = 400;
  for (std::uint32_t id = 0; id < mesh.triangle_count; ++id) {
    const Triangle t = mesh.triangle(id);
    const double area = 0.5 * length(t.normal());
    areas += area;
    std::vector<std::uint32_t> foreign;
    for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
      if (!owns(tree, n, id)) foreign.push_back(n);
    double first = 0, second = 0;
    for (int i = 0; i < kPoints; ++i) {
      float u = random(), v = random();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 point = t.v0 + u * (t.v1 - t.v0) + v * (t.v2 - t.v0);
      double paid = 0;
      for (const std::uint32_t n : foreign) {
        const tree::Node& node = tree.nodes[n];
        if (node.bounds.contains({point, point}))
          paid += node.is_leaf() ? node.count * double(cost.intersection) : cost.traversal;
      }
      first += paid / kPoints, second += paid * paid / kPoints;
    }
    sum += area * first;
    variance += area * area * (second - first * first) / kPoints;
  }
  return {sum / areas, std::sqrt(variance) / areas};
}

TEST(EndPointOverlap, EqualsWhatRandomPointsPay) {
  const TriangleMesh mesh = test::soup(60, 2);
  SequentialExecutor executor;
  const tree::CostModel cost{2, 3};
  for (const char* builder : {"middle", "sweep-sah"}) {
    const auto tree = build(mesh, builder, executor);
    const auto points = overlap_by_points(tree, mesh, cost);
    const auto exact = metrics::end_point_overlap(tree, mesh, cost, 0, executor);
    EXPECT_EQ(exact.error, 0);
    EXPECT_GT(exact.value, 0.5);
    EXPECT_NEAR(exact.value, points.value, 5 * points.error) << builder;
  }
}

TEST(EndPointOverlap, OfTwoSquaresByHand) {
  // Two unit squares in planes z = 0 and z = 1, two triangles each; the leaf over the first is given a box that reaches
  // over a quarter of the second one's.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}, {5, 7, 6}};
  testing::LooseTree loose;
  loose.nodes = {{{{0, 0, 0}, {1, 1, 1}}, 1, 0}, {{{0, 0, 0}, {0.5f, 0.5f, 1}}, 0, 2}, {{{0, 0, 1}, {1, 1, 1}}, 2, 2}};
  loose.references = {0, 1, 2, 3};
  loose.boxes.resize(4);
  SequentialExecutor executor;
  const auto overlap = metrics::end_point_overlap(testing::canonical(loose), mesh, {1, 1.5f}, 0, executor);
  // Area 1/4 of 2 lies in a foreign leaf of two references.
  EXPECT_NEAR(overlap.value, 0.25 / 2 * 2 * 1.5, 1e-12);
}

TEST(EndPointOverlap, SamplesAreWithinTheirErrorAndThreadsDoNotMatter) {
  const TriangleMesh mesh = test::soup(2000, 3);
  SequentialExecutor one;
  ThreadExecutor many(8);
  const auto tree = build(mesh, "binned-sah", one);
  const auto exact = metrics::end_point_overlap(tree, mesh, {}, 0, one);
  EXPECT_EQ(exact.value, metrics::end_point_overlap(tree, mesh, {}, 0, many).value);
  for (const std::size_t samples : {100, 500}) {
    const auto sampled = metrics::end_point_overlap(tree, mesh, {}, samples, one);
    EXPECT_GT(sampled.error, 0);
    EXPECT_NEAR(sampled.value, exact.value, 5 * sampled.error) << samples;
    const auto again = metrics::end_point_overlap(tree, mesh, {}, samples, many);
    EXPECT_EQ(sampled.value, again.value);
    EXPECT_EQ(sampled.error, again.error);
  }
}

TEST(EndPointOverlap, NothingWithoutSurfaceOrOverlap) {
  SequentialExecutor executor;
  EXPECT_EQ(metrics::end_point_overlap({}, TriangleMesh{}, {}, 0, executor).value, 0);
  TriangleMesh points;
  points.vertices = {{1, 2, 3}};
  points.triangles.assign(20, {0, 0, 0});
  EXPECT_EQ(metrics::end_point_overlap(build(points, "middle", executor), points, {}, 0, executor).value, 0);
  EXPECT_EQ(metrics::end_point_overlap(build(points, "middle", executor), points, {}, 9, executor).value, 0);
  for (const float scale : {1e-18f, 1e17f}) {
    TriangleMesh apart;
    for (std::uint32_t i = 0; i < 8; ++i) {
      const Vec3 at{static_cast<float>(i), 0, 0};
      for (const Vec3 corner : {Vec3{0, 0, 0}, Vec3{0.5f, 0, 0.1f}, Vec3{0, 0.5f, 0}})
        apart.vertices.push_back(scale * (at + corner));
      apart.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    EXPECT_EQ(metrics::end_point_overlap(build(apart, "middle", executor), apart, {}, 0, executor).value, 0);
  }
}

TEST(LeafCountVariability, EqualsCountingAllLeaves) {
  const TriangleMesh mesh = test::soup(500, 4);
  SequentialExecutor one;
  ThreadExecutor many(8);
  const auto tree = build(mesh, "binned-sah", one);
  auto rays = render::line_rays(tree.bounds(), 3000, 5);
  for (std::size_t i = 0; i < rays.size(); i += 7) rays[i].direction[static_cast<int>(i % 3)] = 0;
  double sum = 0, squares = 0;
  for (const Ray& ray : rays) {
    double count = 0;
    for (const tree::Node& node : tree.nodes) {
      if (!node.is_leaf()) continue;
      double near = 0, far = kInfinity;
      for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis], low = double(node.bounds.lower[axis]) - ray.origin[axis],
                     high = double(node.bounds.upper[axis]) - ray.origin[axis];
        if (d == 0 && (low > 0 || high < 0)) near = kInfinity, far = 0;
        if (d != 0)
          near = std::max(near, std::min(low / d, high / d)), far = std::min(far, std::max(low / d, high / d));
      }
      count += near <= far;
    }
    sum += count, squares += count * count;
  }
  const double n = static_cast<double>(rays.size()), expected = std::sqrt(squares / n - sum / n * sum / n);
  const auto lcv = metrics::leaf_count_variability(tree, rays, one);
  EXPECT_NEAR(lcv.value, expected, 1e-9 * expected);
  EXPECT_EQ(lcv.value, metrics::leaf_count_variability(tree, rays, many).value);
  const auto other = metrics::leaf_count_variability(tree, render::line_rays(tree.bounds(), 100000, 6), one);
  const auto lines = metrics::leaf_count_variability(tree, render::line_rays(tree.bounds(), 3000, 7), one);
  EXPECT_GT(lines.error, 0);
  EXPECT_NEAR(lines.value, other.value, 5 * lines.error);
  EXPECT_EQ(metrics::leaf_count_variability(tree, {}, one).value, 0);
  EXPECT_EQ(metrics::leaf_count_variability({}, rays, one).value, 0);
}

TEST(SiblingOverlap, ByHand) {
  testing::LooseTree loose;
  loose.nodes = {{{{0, 0, 0}, {4, 2, 2}}, 1, 0}, {{{0, 0, 0}, {3, 2, 2}}, 0, 1}, {{{2, 0, 0}, {4, 2, 2}}, 1, 1}};
  loose.references = {0, 1};
  loose.boxes.resize(2);
  const auto overlap = metrics::sibling_overlap(testing::canonical(loose));
  EXPECT_DOUBLE_EQ(overlap.area, 8.0 / 20);  // half areas of 1 x 2 x 2 and 4 x 2 x 2
  EXPECT_DOUBLE_EQ(overlap.volume, 4.0 / 16);
  const auto chain = metrics::sibling_overlap(testing::canonical(testing::chain(5, true)));
  EXPECT_EQ(chain.volume, 0);
  EXPECT_GT(chain.area, 0) << "boxes that share a side share its area";
  EXPECT_EQ(metrics::sibling_overlap({}).area, 0);
  EXPECT_EQ(metrics::sibling_overlap(testing::canonical(testing::random_tree(1, 3))).area, 0);
}

TEST(ReferencesPerPrimitive, CountsThosePresent) {
  tree::BinaryTree tree = testing::canonical(testing::chain(5, true));
  EXPECT_EQ(metrics::references_per_primitive(tree), 1);
  tree.splits_references = true;
  EXPECT_EQ(metrics::references_per_primitive(tree), 1);
  tree.references[3] = tree.references[0];
  tree.references[4] = tree.references[0];
  EXPECT_EQ(metrics::references_per_primitive(tree), 1.5);
  EXPECT_EQ(metrics::references_per_primitive({}), 0);
}

}  // namespace
}  // namespace boxwood
