#include <gtest/gtest.h>

#include <limits>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

mesh::Report inspect(const MeshView& view) {
  SequentialExecutor executor;
  return mesh::inspect(view, executor);
}

void expect_equal(const mesh::Report& a, const mesh::Report& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.bounds, b.bounds);
  EXPECT_EQ(a.non_finite, b.non_finite);
  EXPECT_EQ(a.degenerate, b.degenerate);
  EXPECT_EQ(a.duplicate, b.duplicate);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.boundary_edges, b.boundary_edges);
  EXPECT_EQ(a.non_manifold_edges, b.non_manifold_edges);
  EXPECT_EQ(a.closed, b.closed);
  EXPECT_EQ(a.manifold, b.manifold);
  EXPECT_EQ(a.surface_area, b.surface_area);  // the same bits
}

TEST(Inspect, EmptyMeshIsNotClosed) {
  const mesh::Report report = inspect({});
  mesh::Report expected;
  expected.manifold = true;
  expect_equal(report, expected);
  EXPECT_TRUE(report.bounds.is_empty());
}

TEST(Inspect, ClosedCube) {
  const TriangleMesh cube = test::cube();
  const mesh::Report expected{.vertices = 8,
                              .triangles = 12,
                              .bounds = {{0, 0, 0}, {1, 1, 1}},
                              .components = 1,
                              .closed = true,
                              .manifold = true,
                              .surface_area = 6};
  expect_equal(inspect(cube), expected);
  expect_equal(inspect(test::TightView(cube, 12, 12, 0)), expected);
  expect_equal(inspect(test::TightView(cube, 17, 14, 1)), expected);
}

TEST(Inspect, CubeWithoutSharedVerticesIsStillClosed) {
  const TriangleMesh cube = test::exploded(test::cube());
  mesh::Report report = inspect(cube);
  EXPECT_EQ(report.vertices, 36u);
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.manifold);
  EXPECT_EQ(report.components, 1u);
  report = inspect({cube.vertices.data(), 36, nullptr, 12});
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.surface_area, 6);
}

TEST(Inspect, OneTriangleAndOpenQuad) {
  const TriangleMesh quad = test::make_mesh({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  expect_equal(inspect(quad), {.vertices = 4,
                               .triangles = 2,
                               .bounds = {{0, 0, 0}, {2, 1, 0}},
                               .components = 1,
                               .boundary_edges = 4,
                               .manifold = true,
                               .surface_area = 2});
  MeshView one = quad;
  one.triangle_count = 1;
  EXPECT_EQ(inspect(one).boundary_edges, 3u);
  EXPECT_EQ(inspect(one).components, 1u);
}

TEST(Inspect, FanOfThreeTrianglesOnOneEdgeIsNotManifold) {
  const TriangleMesh fan =
      test::make_mesh({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const mesh::Report report = inspect(fan);
  EXPECT_FALSE(report.manifold);
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_EQ(report.boundary_edges, 6u);
  EXPECT_EQ(report.components, 1u);
}

TEST(Inspect, TwoCubesTouchingAtOneVertexAreOneComponent) {
  const auto two_cubes = [](float shift) {
    TriangleMesh mesh = test::cube();
    for (const auto& t : test::cube().triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    for (const Vec3& v : test::cube().vertices) mesh.vertices.push_back(v + Vec3{shift, shift, shift});
    return mesh;
  };
  EXPECT_EQ(inspect(two_cubes(1)).components, 1u);
  EXPECT_EQ(inspect(two_cubes(2)).components, 2u);
  EXPECT_TRUE(inspect(two_cubes(2)).closed);
}

TEST(Inspect, CountsDuplicatesInAnyOrderAndOrientation) {
  TriangleMesh cube = test::cube();
  for (const auto t : {std::array<std::uint32_t, 3>{1, 5, 0}, {5, 1, 0}, {0, 1, 5}}) cube.triangles.push_back(t);
  const auto extra = std::uint32_t(cube.vertices.size());  // the same positions under other numbers
  for (const int v : {4, 5, 7}) cube.vertices.push_back(cube.vertices[v]);
  cube.triangles.push_back({extra + 2, extra + 1, extra});
  const mesh::Report report = inspect(cube);
  EXPECT_EQ(report.duplicate, 4u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_EQ(report.non_manifold_edges, 6u);  // three edges of each face that was doubled
}

TEST(Inspect, DegenerateTrianglesHaveNoEdges) {
  // A point, a doubled corner, and three collinear points that are exact in double only as products.
  const TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {0.1f, 0.2f, 0.3f}, {0.2f, 0.4f, 0.6f}},
                                            {{0, 0, 0}, {0, 1, 1}, {0, 1, 2}, {0, 3, 4}});
  const mesh::Report report = inspect(mesh);
  EXPECT_EQ(report.degenerate, 4u);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_FALSE(report.closed);  // there is no surface that could be
  EXPECT_EQ(report.surface_area, 0);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.bounds, (Box{{0, 0, 0}, {3, 3, 3}}));
}

TEST(Inspect, TinyAndHugeTrianglesAreNotDegenerate) {
  for (const float s : {1e-44f, 1e-30f, 1e-3f, 1e10f, 1e18f}) {
    const TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {s, 0, 0}, {0, s, 0}}, {{0, 1, 2}});
    const mesh::Report report = inspect(mesh);
    EXPECT_EQ(report.degenerate, 0u) << s;
    EXPECT_EQ(report.non_finite, 0u) << s;
    EXPECT_DOUBLE_EQ(report.surface_area, 0.5 * double(s) * double(s)) << s;
  }
}

TEST(Inspect, NonFiniteTrianglesAreCountedAndLeftOut) {
  TriangleMesh cube = test::cube();
  const auto bad = std::uint32_t(cube.vertices.size());
  for (const Vec3 v : {Vec3{kNan, 0, 0}, Vec3{0, kInfinity, 0}, Vec3{0, 0, 2e18f}}) cube.vertices.push_back(v);
  for (std::uint32_t i = 0; i < 3; ++i)
    cube.triangles.push_back({0, 1, bad + i}), cube.triangles.push_back({0, 1, bad + i});
  mesh::Report report = inspect(cube);
  EXPECT_EQ(report.non_finite, 6u);
  EXPECT_EQ(report.duplicate, 0u);
  EXPECT_EQ(report.bounds, (Box{{0, 0, 0}, {1, 1, 1}}));
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.manifold);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.surface_area, 6);
  cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 12);
  report = inspect(cube);
  EXPECT_EQ(report.components, 0u);
  EXPECT_FALSE(report.closed);
  EXPECT_TRUE(report.bounds.is_empty());
}

TEST(Inspect, GivesTheSameReportForEachExecutor) {
  TriangleMesh mesh = test::wave(170, 190);
  for (std::uint32_t i = 0; i < 3000; ++i) mesh.triangles.push_back(mesh.triangles[i * 7]);
  for (std::uint32_t i = 0; i < 1000; ++i) mesh.triangles.push_back({i, i, i + 1});
  mesh.vertices[1234].y = kNan;
  const mesh::Report expected = inspect(mesh);
  EXPECT_EQ(expected.components, 1u);
  EXPECT_GT(expected.non_finite, 5u);
  EXPECT_GT(expected.boundary_edges, 600u);
  test::with_each_executor([&](Executor& executor) { expect_equal(mesh::inspect(mesh, executor), expected); });
}

TEST(Inspect, ALongChainOfTrianglesOnOneVertex) {
  // All triangles stand on vertex 0: one bucket of the edge table, one set.
  TriangleMesh fan;
  constexpr std::uint32_t kCount = 200'000;
  fan.vertices.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i <= kCount; ++i) fan.vertices.push_back({float(i), 1, float(i % 3)});
  for (std::uint32_t i = kCount; i-- > 0;) fan.triangles.push_back({0, i + 1, i + 2});
  const mesh::Report report = inspect(fan);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.boundary_edges, kCount + 2u);
  EXPECT_TRUE(report.manifold);
}

}  // namespace
}  // namespace boxwood
