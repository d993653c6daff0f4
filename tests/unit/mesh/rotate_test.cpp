// Rotation of meshes and views, and the defects that scenes can be given.
#include <gtest/gtest.h>

#include "boxwood/mesh.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

SequentialExecutor sequential;

TEST(Rotate, QuarterTurnsAreExact) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}, {4, 5, 6}, {-7, 8, 9}};
  mesh.triangles = {{0, 1, 2}};
  mesh::rotate(mesh, {90, 0, 0}, {});
  EXPECT_EQ(mesh.vertices[0], (Vec3{1, -3, 2}));  // y to z, z to -y
  mesh::rotate(mesh, {-90, 360, 0}, {});
  EXPECT_EQ(mesh.vertices[0], (Vec3{1, 2, 3}));
  mesh::rotate(mesh, {0, 0, 180}, {1, 2, 0});
  EXPECT_EQ(mesh.vertices[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(mesh.vertices[1], (Vec3{-2, -1, 6}));
}

TEST(Rotate, KeepsLengthsAndTheViewSeesTheSame) {
  TriangleMesh mesh = test::icosphere(2, 3, {10, 20, 30});
  const TriangleMesh before = mesh;
  const View view{.eye = {0, 25, 50}, .look_at = {10, 20, 30}, .up = {0, 1, 0}, .fov = 33};
  mesh::rotate(mesh, {30, 40, 20}, {1, 2, 3});
  const View turned = mesh::rotate(view, {30, 40, 20}, {1, 2, 3});
  EXPECT_EQ(turned.fov, 33);
  EXPECT_NEAR(length(turned.up), 1, 1e-6);
  EXPECT_NEAR(dot(turned.up, turned.look_at - turned.eye), dot(view.up, view.look_at - view.eye), 1e-4);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR(length(mesh.vertices[i] - turned.eye), length(before.vertices[i] - view.eye), 1e-4);
    EXPECT_NEAR(dot(mesh.vertices[i] - turned.eye, turned.up), dot(before.vertices[i] - view.eye, view.up), 1e-4);
  }
}

TEST(SceneDefects, AnOutlierAndASpikeReachAsFarAsAsked) {
  const auto plain = mesh::make_scene("atrium", {.triangles = 1000});
  const Box box = mesh::bounds(plain->mesh, sequential);
  const float diagonal = length(box.extent());
  for (const float distance : {1.0f, 1000.0f, 1e9f}) {
    const auto outlier = mesh::make_scene("atrium", {.triangles = 1000, .outlier = distance});
    const auto spike = mesh::make_scene("atrium", {.triangles = 1000, .spike = distance});
    for (const auto* made : {&outlier, &spike}) {
      ASSERT_TRUE(*made);
      const TriangleMesh& mesh = (*made)->mesh;
      EXPECT_EQ(mesh.triangles.size(), plain->mesh.triangles.size() + 1);
      EXPECT_EQ(mesh::inspect(mesh, sequential).degenerate, 0u);
      const float reach = length(mesh::bounds(mesh, sequential).upper - box.center());
      EXPECT_NEAR(reach / (distance * diagonal), 1, 0.6 / distance + 0.01);
      EXPECT_EQ((*made)->view.eye, plain->view.eye);
    }
    // Only the spike's triangle also reaches back to the scene.
    const auto size = [](const mesh::Scene& scene) {
      return length(scene.mesh.view().triangle(scene.mesh.triangles.size() - 1).bounds().extent());
    };
    EXPECT_LT(size(*outlier), 0.01f * diagonal * maximum(1.0f, distance * 0x1p-10f));
    EXPECT_GT(size(*spike), 0.9f * distance * diagonal);
  }
  for (const float wrong : {-1.0f, 2e9f, std::nanf("")}) {
    EXPECT_EQ(mesh::make_scene("atrium", {.outlier = wrong}).error().code, ErrorCode::out_of_range);
    EXPECT_EQ(mesh::make_scene("atrium", {.spike = wrong}).error().code, ErrorCode::out_of_range);
  }
}

}  // namespace
}  // namespace boxwood
