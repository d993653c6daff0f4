#include <gtest/gtest.h>

#include <limits>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

struct Projected {
  double x, y, depth;  // x and y from -1 to 1 inside a square picture
};

Projected project(const View& view, double px, double py, double pz) {
  const double f[3] = {double(view.look_at.x) - view.eye.x, double(view.look_at.y) - view.eye.y,
                       double(view.look_at.z) - view.eye.z};
  const double length = std::hypot(f[0], f[1], f[2]);
  const double forward[3] = {f[0] / length, f[1] / length, f[2] / length};
  const double flat = std::hypot(forward[0], forward[2]);  // up is y
  const double right[3] = {-forward[2] / flat, 0, forward[0] / flat};
  const double up[3] = {right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2],
                        right[0] * forward[1] - right[1] * forward[0]};
  const double d[3] = {px - view.eye.x, py - view.eye.y, pz - view.eye.z};
  const double depth = d[0] * forward[0] + d[1] * forward[1] + d[2] * forward[2];
  const double scale = depth * std::tan(0.5 * view.fov * 3.14159265358979 / 180);
  return {(d[0] * right[0] + d[1] * right[1] + d[2] * right[2]) / scale,
          (d[0] * up[0] + d[1] * up[1] + d[2] * up[2]) / scale, depth};
}

TEST(ViewFromBounds, ShowsEveryCornerAndFillsThePicture) {
  const Box boxes[] = {{{0, 0, 0}, {1, 1, 1}},
                       {{-5, 2, 3}, {20, 3, 4}},
                       {{0, 0, 0}, {1, 30, 2}},
                       {{0, 0, -9}, {1, 1, 9}},
                       {{0, 0, 0}, {7, 0, 5}},
                       {{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}},
                       {{1e-20f, 0, 0}, {2e-20f, 1e-20f, 1e-20f}},
                       {{1000, 1000, 1000}, {1001, 1001, 1003}}};
  for (const Box& box : boxes) {
    const View view = mesh::view_from_bounds(box);
    EXPECT_EQ(view.fov, 40);
    EXPECT_TRUE(is_finite(view.eye));
    EXPECT_GT(view.eye.y, view.look_at.y) << "not from above";
    double largest = 0, left = 1, right = -1;
    for (int corner = 0; corner < 8; ++corner) {
      const Projected p = project(view, corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                                  corner & 4 ? box.upper.z : box.lower.z);
      EXPECT_GT(p.depth, 0);
      largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
      left = std::min(left, p.x), right = std::max(right, p.x);
    }
    EXPECT_LE(largest, 1);
    EXPECT_GT(largest, 0.7);
    EXPECT_GT(right - left, 0.1);
  }
}

TEST(ViewFromBounds, PutsTheLongSideAcross) {
  for (const Box& box : {Box{{0, 0, 0}, {10, 1, 2}}, Box{{0, 0, 0}, {2, 1, 10}}}) {
    const View view = mesh::view_from_bounds(box);
    const bool x_long = box.upper.x > box.upper.z;
    const Projected begin = project(view, 0, 0, 0), end = project(view, x_long ? 10 : 0, 0, x_long ? 0 : 10);
    EXPECT_GT(std::fabs(end.x - begin.x), 1.0);
  }
}

TEST(ViewFromBounds, IsAViewForAnyBox) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const Box boxes[] = {{},
                       {{0, 0, 0}, {0, 0, 0}},
                       {{1e10f, 5, 5}, {1e10f, 5, 5}},
                       {{nan, 0, 0}, {1, 1, 1}},
                       {{-kInfinity, 0, 0}, {1, 1, 1}},
                       {{-1e18f, 1e18f, 0}, {-1e18f, 1e18f, 0}}};
  for (const Box& box : boxes) {
    const View view = mesh::view_from_bounds(box);
    EXPECT_TRUE(is_finite(view.eye));
    EXPECT_TRUE(is_finite(view.look_at));
    EXPECT_NE(view.eye, view.look_at);
  }
}

}  // namespace
}  // namespace boxwood
