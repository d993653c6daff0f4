#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "boxwood/refs.h"

namespace boxwood {
namespace {

TriangleMesh random_mesh(std::size_t triangles, std::uint32_t seed) {
  TriangleMesh mesh;
  const auto random = [&seed] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<float>(seed >> 8) * 0x1p-20f - 8;
  };
  for (std::size_t i = 0; i < triangles + 2; ++i) {
    const float x = random(), y = random(), z = random();
    mesh.vertices.push_back({x, y, z});
  }
  for (std::uint32_t i = 0; i < triangles; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

void expect_exact(const TriangleMesh& mesh, const refs::ReferenceSet& set) {
  std::size_t next = 0;
  Box bounds;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.view().triangle(i);
    if (!mesh::is_usable(triangle)) continue;
    ASSERT_LT(next, set.references.size());
    const refs::Reference& reference = set.references[next++];
    ASSERT_EQ(reference.primitive, i);
    ASSERT_EQ(reference.box(), triangle.bounds());
    ASSERT_EQ(reference.reserved, 0u);
    bounds.grow(triangle.bounds());
  }
  EXPECT_EQ(set.references.size(), next);
  EXPECT_EQ(set.excluded, mesh.triangles.size() - next);
  EXPECT_EQ(set.primitive_count, mesh.triangles.size());
  EXPECT_EQ(set.bounds, bounds);
}

TEST(MakeReferences, OnePerTriangleInOrder) {
  SequentialExecutor executor;
  for (const std::size_t count : {0, 1, 2, 100, 16384, 16385, 50000}) {
    const TriangleMesh mesh = random_mesh(count, 1);
    const auto set = refs::make_references(mesh, executor);
    ASSERT_TRUE(set);
    expect_exact(mesh, *set);
    EXPECT_EQ(set->excluded, 0u);
  }
}

TEST(MakeReferences, LeavesOutWhatIsNotFinite) {
  SequentialExecutor executor;
  const float bad[] = {std::nanf(""), kInfinity, -kInfinity, 2e18f, -2e18f};
  TriangleMesh mesh = random_mesh(60000, 2);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 77) mesh.vertices[i][static_cast<int>(i % 3)] = bad[i % 5];
  for (std::size_t i = 17000; i < 34000; ++i) mesh.vertices[i].y = std::nanf("");  // a whole chunk
  const auto set = refs::make_references(mesh, executor);
  ASSERT_TRUE(set);
  EXPECT_GT(set->excluded, 17000u);
  expect_exact(mesh, *set);
}

TEST(MakeReferences, NothingUsable) {
  SequentialExecutor executor;
  TriangleMesh mesh = random_mesh(10, 3);
  for (Vec3& vertex : mesh.vertices) vertex.z = kInfinity;
  const auto set = refs::make_references(mesh, executor);
  ASSERT_TRUE(set);
  EXPECT_TRUE(set->references.empty());
  EXPECT_EQ(set->excluded, 10u);
  EXPECT_TRUE(set->bounds.is_empty());
}

TEST(MakeReferences, DegenerateTrianglesStayIn) {
  SequentialExecutor executor;
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}, {4, 5, 6}};
  mesh.triangles = {{0, 0, 0}, {0, 1, 0}};
  const auto set = refs::make_references(mesh, executor);
  ASSERT_TRUE(set);
  expect_exact(mesh, *set);
  EXPECT_EQ(set->references.size(), 2u);
}

TEST(MakeReferences, IndicesPastTheVerticesAreRefused) {
  SequentialExecutor executor;
  TriangleMesh mesh = random_mesh(100, 4);
  mesh.triangles[55][1] = 102;
  const auto set = refs::make_references(mesh, executor);
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("55"), std::string::npos) << set.error().message;
  EXPECT_NE(set.error().message.find("102"), std::string::npos) << set.error().message;
}

TEST(MakeReferences, UnindexedAndStridedViews) {
  SequentialExecutor executor;
  const TriangleMesh mesh = random_mesh(20, 5);
  std::vector<unsigned char> bytes(20 * 3 * 13);  // 13 bytes a vertex: nothing is aligned
  for (std::size_t i = 0; i < 60; ++i) {
    const Vec3 vertex = mesh.vertices[mesh.triangles[i / 3][i % 3]];
    std::memcpy(bytes.data() + 13 * i, &vertex, 12);
  }
  bytes.resize(13 * 59 + 12);  // up to the last byte that is needed
  bytes.shrink_to_fit();
  MeshView view;
  view.positions = bytes.data();
  view.vertex_count = 60;
  view.triangle_count = 20;
  view.vertex_stride = 13;
  const auto set = refs::make_references(view, executor);
  ASSERT_TRUE(set) << set.error().message;
  expect_exact(mesh, *set);
}

TEST(MakeReferences, SameForAllThreads) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  TriangleMesh mesh = random_mesh(200000, 6);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 1001) mesh.vertices[i].x = kInfinity;
  SequentialExecutor sequential;
  const auto expected = refs::make_references(mesh, sequential);
  ASSERT_TRUE(expected);
  for (const int threads : {2, 8}) {
    ThreadExecutor executor(threads);
    const auto set = refs::make_references(mesh, executor);
    ASSERT_TRUE(set);
    ASSERT_EQ(set->references.size(), expected->references.size());
    EXPECT_EQ(std::memcmp(set->references.data(), expected->references.data(), set->references.bytes()), 0);
    EXPECT_EQ(set->bounds, expected->bounds);
  }
}

}  // namespace
}  // namespace boxwood
