// Subdivided meshes: as closed as before, over the same surface, cut where references would be.
#include <gtest/gtest.h>

#include <cstring>

#include "boxwood/refs.h"
#include "support/meshes.h"

namespace boxwood::refs {
namespace {

SequentialExecutor sequential;

Subdivision subdivide_it(const MeshView& mesh, const std::string& text, Executor& executor = sequential) {
  auto result = subdivide(mesh, *parse_presplit(text), executor);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

/// A long closed body, turned, with vertices far from the origin: every midpoint is rounded.
TriangleMesh cigar(Vec3 offset) {
  TriangleMesh mesh = test::icosphere(2);
  for (Vec3& v : mesh.vertices) v = v * Vec3{20, 1, 1};
  mesh::rotate(mesh, {25, 35, 45}, {});
  for (Vec3& v : mesh.vertices) v = v + offset;
  return mesh;
}

TEST(Subdivide, ClosedStaysClosed) {
  for (const Vec3 offset : {Vec3{}, Vec3{1000, -77, 12345}, Vec3{1e5f, 1e5f, 1e5f}}) {
    const TriangleMesh mesh = cigar(offset);
    ASSERT_TRUE(mesh::inspect(mesh, sequential).closed);
    for (const char* text : {"evh:t=10", "evh:t=13.5", "evh:auto,budget=8,t.most=20"}) {
      const Subdivision result = subdivide_it(mesh, text);
      EXPECT_GT(result.split, 10u) << text;
      EXPECT_EQ(result.open_edges_before, 0u);
      EXPECT_EQ(result.open_edges_expected, 0u);
      EXPECT_EQ(result.open_edges_after, 0u) << text;
      const mesh::Report report = mesh::inspect(result.mesh, sequential);
      if (report.degenerate == 0) {
        EXPECT_TRUE(report.closed && report.manifold) << text;
        EXPECT_NEAR(report.surface_area / mesh::inspect(mesh, sequential).surface_area, 1, 1e-2);
      }
    }
  }
}

TEST(Subdivide, UnsharedVerticesArePutTogetherByPosition) {
  // The same body as unconnected triangles: closed by position, and still so afterwards.
  const TriangleMesh shared = cigar({});
  TriangleMesh loose;
  for (std::uint32_t i = 0; i < shared.triangles.size(); ++i) {
    for (const std::uint32_t corner : shared.triangles[i]) loose.vertices.push_back(shared.vertices[corner]);
    loose.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Subdivision a = subdivide_it(shared, "evh:t=12"), b = subdivide_it(loose, "evh:t=12");
  EXPECT_EQ(mesh::hash(a.mesh, sequential), mesh::hash(b.mesh, sequential));
  EXPECT_EQ(a.midpoints, b.midpoints);
  EXPECT_EQ(b.open_edges_after, 0u);
}

TEST(Subdivide, OpenEdgesAreCutAsForeseen) {
  TriangleMesh mesh = test::grid(4);
  mesh::rotate(mesh, {30, 40, 20}, {});
  const Subdivision result = subdivide_it(mesh, "evh:t=12");
  EXPECT_EQ(result.open_edges_before, 16u);
  EXPECT_GT(result.open_edges_expected, 16u);
  EXPECT_EQ(result.open_edges_after, result.open_edges_expected);
  EXPECT_EQ(mesh::inspect(result.mesh, sequential).boundary_edges, result.open_edges_expected);
}

TEST(Subdivide, MakesOneTriangleForEachReference) {
  const auto made = mesh::make_scene("spaceship", {.triangles = 5000});
  const TriangleMesh& mesh = made->mesh;
  for (const char* text : {"evh:t=14", "evh:auto,budget=2,t.most=18"}) {
    const auto presplit = parse_presplit(text);
    const auto set = apply_presplit(std::move(*make_references(mesh, sequential)), mesh, *presplit, sequential);
    const Subdivision result = subdivide_it(mesh, text);
    ASSERT_EQ(result.mesh.triangles.size(), set->references.size());
    EXPECT_GT(result.split, 0u);
    for (std::size_t i = 0; i < set->references.size(); ++i)
      ASSERT_TRUE(set->references[i].box().contains(result.mesh.view().triangle(i).bounds())) << i;
    // Every vertex once: what is left after welding is no fewer.
    const auto ids = mesh::weld({result.mesh.vertices.data() + mesh.vertices.size(), result.midpoints}, sequential);
    for (std::size_t i = 0; i < ids.size(); ++i) ASSERT_EQ(ids[i], i);
  }
}

TEST(Subdivide, NothingToCutAndNothingAtAll) {
  const TriangleMesh sphere = test::icosphere(1);
  const Subdivision whole = subdivide_it(sphere, "evh:t=0");
  EXPECT_EQ(mesh::hash(whole.mesh, sequential), mesh::hash(sphere, sequential));
  EXPECT_EQ(whole.split, 0u);
  EXPECT_TRUE(subdivide_it(MeshView{}, "evh").mesh.triangles.empty());
  TriangleMesh broken = sphere;
  broken.vertices[0].x = kInfinity;
  EXPECT_EQ(subdivide_it(broken, "evh:t=0").left_out, 5u);
}

TEST(Subdivide, RefusesWhatCutsNoEdges) {
  for (const char* text : {"none", "esc"}) {
    const auto result = subdivide(test::icosphere(0), *parse_presplit(text), sequential);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::unsupported);
    EXPECT_NE(result.error().message.find("evh"), std::string::npos);
  }
}

TEST(Subdivide, IsTheSameForEveryNumberOfThreads) {
  const auto made = mesh::make_scene("spaceship", {.triangles = 30'000});
  const Subdivision one = subdivide_it(made->mesh, "evh:t=15");
  for (const int threads : {2, 8}) {
    ThreadExecutor executor(threads);
    const Subdivision many = subdivide_it(made->mesh, "evh:t=15", executor);
    EXPECT_EQ(many.mesh.triangles, one.mesh.triangles);
    ASSERT_EQ(many.mesh.vertices.size(), one.mesh.vertices.size());
    EXPECT_EQ(0, std::memcmp(many.mesh.vertices.data(), one.mesh.vertices.data(), 12 * one.mesh.vertices.size()));
  }
}

}  // namespace
}  // namespace boxwood::refs
