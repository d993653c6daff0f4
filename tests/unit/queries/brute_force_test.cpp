#include <gtest/gtest.h>

#include "boxwood/queries.h"
#include "support/meshes.h"

namespace boxwood::queries {
namespace {

TEST(BruteForce, KnownTriangle) {
  const Triangle t{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const ExactHit hit = exact_intersection(t, {{0.5f, 1, 3}, 0, {0, 0, -2}, kInfinity});
  EXPECT_DOUBLE_EQ(hit.t, 1.5);
  EXPECT_DOUBLE_EQ(hit.u, 0.25);
  EXPECT_DOUBLE_EQ(hit.v, 0.5);
  EXPECT_DOUBLE_EQ(hit.margin, 0.25);
  EXPECT_EQ(exact_intersection(t, {{1.5f, 1, 3}, 0, {0, 0, -2}, kInfinity}).t, kInfinity);
  EXPECT_EQ(exact_intersection(t, {{0.5f, 1, 3}, 0, {1, 0, 0}, kInfinity}).t, kInfinity) << "parallel";
  EXPECT_EQ(exact_intersection({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0.5f, 0, 3}, 0, {0, 0, -1}, kInfinity}).t,
            kInfinity)
      << "degenerate";
}

TEST(BruteForce, NearestWithinTheInterval) {
  const TriangleMesh sphere = test::icosphere(3);
  const Ray ray{{0.01f, 0.02f, -5}, 0, {0, 0, 1}, kInfinity};
  const ExactHit front = brute_force_closest(sphere, ray);
  EXPECT_NEAR(front.t, 4, 0.02);
  Ray later = ray;
  later.tmin = 4.5f;
  EXPECT_NEAR(brute_force_closest(sphere, later).t, 6, 0.02);
  later.tmax = 5.5f;
  EXPECT_EQ(brute_force_closest(sphere, later).primitive, layouts::kInvalidPrimitive);
}

TEST(BruteForce, PassesOverUnusableTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{std::nanf(""), 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 1}, {1, -1, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(brute_force_closest(mesh, {{0, 0, -1}, 0, {0, 0, 1}, kInfinity}).primitive, 1u);
}

}  // namespace
}  // namespace boxwood::queries
