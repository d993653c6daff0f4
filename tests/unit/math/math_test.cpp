#include "boxwood/math.h"

#include <gtest/gtest.h>

#include "math/clip.h"

namespace boxwood {
namespace {

TEST(Box, EmptyGrowsToWhatItIsGiven) {
  Box box;
  EXPECT_TRUE(box.is_empty());
  EXPECT_EQ(box.half_area(), 0);
  EXPECT_EQ(box.extent(), Vec3{});
  box.grow(Vec3{1, 2, 3});
  EXPECT_FALSE(box.is_empty());
  EXPECT_EQ(box.half_area(), 0);
  box.grow(Vec3{3, 5, 7});
  EXPECT_EQ(box.half_area(), 2 * 3 + 3 * 4 + 4 * 2);
  EXPECT_EQ(box.center(), (Vec3{2, 3.5f, 5}));
  EXPECT_EQ(box.widest_axis(), 2);
  EXPECT_EQ(merge(box, Box{}), box);
}

TEST(Box, Contains) {
  const Box outer{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(outer.contains(outer));
  EXPECT_TRUE(outer.contains(Box{{0.5f, 0, 0}, {1, 1, 0.5f}}));
  EXPECT_FALSE(outer.contains(Box{{0, 0, 0}, {1, 1.0001f, 1}}));
  EXPECT_TRUE(outer.contains(Box{})) << "the empty box is in every box";
}

TEST(Vec3, ProductsAndLength) {
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
  EXPECT_EQ(dot({1, 2, 3}, {4, 5, 6}), 32);
  EXPECT_EQ(length({3, 0, 4}), 5);
  EXPECT_EQ(normalize({0, 0, 0}), Vec3{});
  EXPECT_FALSE(is_finite({0, std::nanf(""), 0}));
  EXPECT_FALSE(is_finite({0, 0, -kInfinity}));
}

TEST(Triangle, BoundsAndNormal) {
  const Triangle t{{0, 0, 0}, {2, 0, 0}, {0, 3, 1}};
  EXPECT_EQ(t.bounds(), (Box{{0, 0, 0}, {2, 3, 1}}));
  EXPECT_EQ(t.normal(), (Vec3{0, -2, 6}));
}

TEST(ConvexPolygon, AreaOfWhatIsLeft) {
  ConvexPolygon polygon({{0, 0, 5}, {4, 0, 5}, {0, 4, 5}});
  EXPECT_DOUBLE_EQ(polygon.area(), 8);
  polygon.clip(0, 1, false);  // a right triangle of legs 3
  EXPECT_DOUBLE_EQ(polygon.area(), 4.5);
  polygon.clip(1, 1, true);  // less its upper part, of legs 2
  EXPECT_DOUBLE_EQ(polygon.area(), 2.5);
  ConvexPolygon touching = polygon;
  touching.clip({{0, 0, 5}, {1, 1, 5}});
  EXPECT_EQ(touching.area(), 0) << "a line is left";
  polygon.clip(2, 6, false);
  EXPECT_TRUE(polygon.is_empty());
  EXPECT_EQ(polygon.area(), 0);
}

}  // namespace
}  // namespace boxwood
