// The bins against a plain double-precision re-statement.
#include "builders/parts/bins.h"

#include <gtest/gtest.h>

#include "builders/parts/area_scale.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood::builders {
namespace {

double half_area(const Box& b) {
  if (b.is_empty()) return 0;
  const double x = double(b.upper.x) - b.lower.x, y = double(b.upper.y) - b.lower.y, z = double(b.upper.z) - b.lower.z;
  return x * y + y * z + z * x;
}

Box4 centroid_box(const testing::Boxes& boxes) {
  Box box;
  for (const Box& b : boxes) box.grow(b.lower + b.upper);
  return Box4::of(box);
}

int bin_of(const BinGrid& grid, const Box& box, int axis) {
  alignas(16) float origin[4], scale[4];
  grid.origin.store(origin);
  grid.scale.store(scale);
  return static_cast<int>((box.lower[axis] + box.upper[axis] - origin[axis]) * scale[axis]);
}

double split_cost(const testing::Boxes& boxes, const BinGrid& grid, int axis, int bin) {
  Box sides[2];
  int counts[2] = {};
  for (const Box& box : boxes) {
    const bool right = bin_of(grid, box, axis) >= bin;
    sides[right].grow(box);
    ++counts[right];
  }
  return half_area(sides[0]) * counts[0] + half_area(sides[1]) * counts[1];
}

TEST(Bins, BestSplitIsTheCheapestOfAllAxes) {
  for (const int count : {2, 3, 8, 16, 256}) {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      SCOPED_TRACE(std::to_string(count) + " bins, seed " + std::to_string(seed));
      const testing::Boxes boxes = testing::soup(5 + 40 * seed, seed);
      const auto set = testing::reference_set(boxes);
      const BinGrid grid = BinGrid::over(centroid_box(boxes), count, -1);
      Bins bins(count);
      bins.add(grid, set.references.data(), set.references.size());
      const BinSplit best = bins.best_split(grid, 1);
      double cheapest = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis)
        for (int bin = 1; bin < count; ++bin) cheapest = std::min(cheapest, split_cost(boxes, grid, axis, bin));
      ASSERT_GE(best.axis, 0);
      EXPECT_NEAR(best.cost / cheapest, 1, 1e-5);
      EXPECT_NEAR(split_cost(boxes, grid, best.axis, best.bin) / cheapest, 1, 1e-5);

      Box left, right;
      std::uint32_t left_count = 0;
      for (const Box& box : boxes) {
        const bool is_left = bin_of(grid, box, best.axis) < best.bin;
        (is_left ? left : right).grow(box);
        left_count += is_left;
      }
      EXPECT_EQ(best.left.box(), left);
      EXPECT_EQ(best.right.box(), right);
      EXPECT_EQ(best.left_count, left_count);
    }
  }
}

TEST(Bins, PartsAddUpToTheWhole) {
  const testing::Boxes boxes = testing::soup(1000, 50);
  const auto set = testing::reference_set(boxes);
  const BinGrid grid = BinGrid::over(centroid_box(boxes), 16, -1);
  Bins whole(16), first(16), second(16);
  whole.add(grid, set.references.data(), 1000);
  first.add(grid, set.references.data(), 300);
  second.add(grid, set.references.data() + 300, 700);
  first.add(second);
  const BinSplit a = whole.best_split(grid, 1), b = first.best_split(grid, 1);
  EXPECT_EQ(a.axis, b.axis);
  EXPECT_EQ(a.bin, b.bin);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.left_count, b.left_count);
  EXPECT_EQ(a.left.box(), b.left.box());
}

TEST(Bins, OneAxisOnly) {
  const testing::Boxes boxes = testing::soup(300, 51);
  const auto set = testing::reference_set(boxes);
  for (int axis = 0; axis < 3; ++axis) {
    const BinGrid grid = BinGrid::over(centroid_box(boxes), 16, axis);
    Bins bins(16);
    bins.add(grid, set.references.data(), set.references.size());
    EXPECT_EQ(bins.best_split(grid, 1).axis, axis);
  }
}

TEST(Bins, CoincidingCentroidsGiveNoSplit) {
  const testing::Boxes boxes(10, Box{{1, 2, 3}, {4, 5, 6}});
  const auto set = testing::reference_set(boxes);
  const BinGrid grid = BinGrid::over(centroid_box(boxes), 16, -1);
  EXPECT_FALSE(grid.any_usable());
  Bins bins(16);
  bins.add(grid, set.references.data(), set.references.size());
  EXPECT_EQ(bins.best_split(grid, 1).axis, -1);
}

TEST(Bins, ExtremeCentroidsFallIntoTheFirstAndLastBin) {
  for (const float scale : {1.0f, 1e18f, 1e-30f, 3.3e-7f}) {
    const testing::Boxes boxes{{{0, 0, 0}, {0, 0, 0}}, {Vec3{1, 1, 1} * scale, Vec3{1, 1, 1} * scale}};
    for (int count = 2; count <= kMostBins; ++count) {
      const BinGrid grid = BinGrid::over(centroid_box(boxes), count, -1);
      ASSERT_TRUE(grid.any_usable());
      EXPECT_EQ(bin_of(grid, boxes[0], 0), 0);
      EXPECT_EQ(bin_of(grid, boxes[1], 0), count - 1);
    }
  }
}

TEST(AreaScale, BringsAnyBoxNearOne) {
  for (const float size : {1e18f, 1.0f, 3e-7f, 1e-30f}) {
    const Box box{{-size, 0, 0}, {size, size / 2, size / 4}};
    const float scale = area_scale(box);
    EXPECT_GE(2 * size * scale, 0.5f);
    EXPECT_LE(2 * size * scale, 1.0f);
    EXPECT_GT(scaled_half_area(box, scale), 0.1f);
  }
  EXPECT_EQ(area_scale({{1, 1, 1}, {1, 1, 1}}), 1.0f);
  EXPECT_TRUE(std::isfinite(area_scale({{0, 0, 0}, {1e-45f, 0, 0}})));
}

}  // namespace
}  // namespace boxwood::builders
