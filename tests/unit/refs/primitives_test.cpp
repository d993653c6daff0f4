// Cutting triangles: both parts together hold everything, and neither is larger than it must be.
#include <gtest/gtest.h>

#include <random>

#include "boxwood/refs.h"

namespace boxwood::refs {
namespace {

TriangleMesh random_triangles(std::size_t count, float size, float offset, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> place(-1, 1);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = Vec3{place(engine), place(engine), place(engine)} * 10.0f + Vec3{offset, offset, offset};
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(at + Vec3{place(engine), place(engine), place(engine)} * size);
    const auto v = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

bool holds(const Box& box, const double (&p)[3], double slack = 0) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < box.lower[axis] - slack || p[axis] > box.upper[axis] + slack) return false;
  return true;
}

/// Cuts each triangle again and again at random planes and looks whether random points of it lie in a part's box.
void check_cuts(const TriangleMesh& mesh, unsigned seed) {
  const auto primitives = triangle_primitives(mesh);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle triangle = mesh.view().triangle(t);
    std::vector<Box> parts{triangle.bounds()};
    for (int round = 0; round < 6; ++round) {
      const std::size_t i = engine() % parts.size();
      const int axis = static_cast<int>(engine() % 3);
      const Box box = parts[i];
      const float position = box.lower[axis] + static_cast<float>(unit(engine)) * box.extent()[axis];
      if (!(position > box.lower[axis] && position < box.upper[axis])) continue;
      Box left, right;
      primitives->cut({box.lower, static_cast<std::uint32_t>(t), box.upper}, axis, position, left, right);
      ASSERT_FALSE(left.is_empty() && right.is_empty());
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
      for (const Box& part : {left, right}) {
        if (part.is_empty()) continue;
        ASSERT_TRUE(box.contains(part));
        parts.push_back(part);
      }
    }
    for (int sample = 0; sample < 50; ++sample) {
      double a = unit(engine), b = unit(engine);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      double p[3];
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = (1 - a - b) * triangle.v0[axis] + a * triangle.v1[axis] + b * triangle.v2[axis];
      // The sample itself carries rounding errors of double precision, far below those of the boxes.
      const double slack = 1e-15 * (1 + std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]));
      EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const Box& part) { return holds(part, p, slack); }))
          << "triangle " << t << ", sample " << sample;
    }
  }
}

TEST(Primitives, PartsHoldTheWholeTriangle) {
  check_cuts(random_triangles(400, 5, 0, 1), 2);
  check_cuts(random_triangles(400, 1e-3f, 0, 3), 4);
  check_cuts(random_triangles(400, 5, 1e6f, 5), 6);
  check_cuts(random_triangles(400, 1e15f, 0, 7), 8);
}

TEST(Primitives, PartsAreTight) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  const auto primitives = triangle_primitives(mesh);
  Box left, right;
  primitives->cut({{0, 0, 0}, 0, {4, 4, 0}}, 0, 3.0f, left, right);
  EXPECT_EQ(left.lower, (Vec3{0, 0, 0}));
  EXPECT_EQ(left.upper.x, 3);
  EXPECT_EQ(left.upper.y, 4);
  EXPECT_EQ(right.lower.x, 3);
  EXPECT_EQ(right.upper.x, 4);
  EXPECT_GE(right.upper.y, 1);
  EXPECT_LE(right.upper.y, 1.000001f);
  const Box corner = primitives->clip({{0, 0, 0}, 0, {4, 4, 0}}, Box{{1, 1, -1}, {9, 9, 1}});
  EXPECT_EQ(corner.lower, (Vec3{1, 1, 0}));
  EXPECT_LE(corner.upper.x, 3.000001f);
  EXPECT_GE(corner.upper.x, 3);
  EXPECT_TRUE(primitives->clip({{0, 0, 0}, 0, {4, 4, 0}}, Box{{3, 3, -1}, {9, 9, 1}}).is_empty());
}

TEST(Primitives, APlaneBesideAThinPartLeavesItWhole) {
  // The reference's box reaches below the plane, its triangle does not.
  TriangleMesh mesh;
  mesh.vertices = {{0, 2, 0}, {1, 3, 0}, {0, 3, 0}};
  mesh.triangles = {{0, 1, 2}};
  Box left, right;
  triangle_primitives(mesh)->cut({{0, 0, 0}, 0, {1, 3, 0}}, 1, 1.0f, left, right);
  EXPECT_TRUE(left.is_empty());
  EXPECT_EQ(right, (Box{{0, 2, 0}, {1, 3, 0}}));
}

TEST(Primitives, BoxesAreCutAsTheyAre) {
  Box left, right;
  box_primitives()->cut({{0, 0, 0}, 0, {4, 4, 4}}, 2, 1.0f, left, right);
  EXPECT_EQ(left, (Box{{0, 0, 0}, {4, 4, 1}}));
  EXPECT_EQ(right, (Box{{0, 0, 1}, {4, 4, 4}}));
}

TEST(Primitives, ChoppingGivesThePartsOfCuttingOnceAfterTheOther) {
  const TriangleMesh mesh = random_triangles(200, 1, 3, 12);
  const std::shared_ptr<const Primitives> kinds[] = {triangle_primitives(mesh), box_primitives()};
  for (const auto& primitives : kinds)
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Box box = mesh.view().triangle(t).bounds();
      const int axis = static_cast<int>(t % 3), other = (axis + 1) % 3;
      if (t % 2 == 1) box.upper[other] = box.center()[other];  // a part, no whole triangle
      std::vector<float> positions;
      for (int i = 1; i < 6; ++i) positions.push_back(box.lower[axis] + static_cast<float>(i) / 6 * box.extent()[axis]);
      std::vector<Box> parts(6);
      primitives->chop({box.lower, t, box.upper, 0}, axis, positions, parts);
      Box rest = box;
      for (std::size_t i = 0; i < 6; ++i) {
        Box below = rest, above;
        if (i < 5 && rest.lower[axis] < positions[i] && positions[i] < rest.upper[axis])
          primitives->cut({rest.lower, t, rest.upper, 0}, axis, positions[i], below, above);
        else if (i < 5 && !rest.is_empty() && rest.lower[axis] >= positions[i])
          below = {}, above = rest;
        rest = above;
        if (below.extent()[axis] < 1e-5f) continue;  // what rounding outwards has left over
        ASSERT_FALSE(parts[i].is_empty()) << "triangle " << t << ", part " << i;
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(parts[i].lower[k], below.lower[k], 1e-5f) << "triangle " << t << ", part " << i;
          EXPECT_NEAR(parts[i].upper[k], below.upper[k], 1e-5f) << "triangle " << t << ", part " << i;
        }
      }
    }
}

}  // namespace
}  // namespace boxwood::refs
