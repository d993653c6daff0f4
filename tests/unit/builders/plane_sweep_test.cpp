// Plane sweeps and chopped bins against trying every plane with every reference.
#include "builders/parts/plane_sweep.h"

#include <gtest/gtest.h>

#include "builders/parts/area_scale.h"
#include "builders/parts/spatial_bins.h"
#include "support/meshes.h"

namespace boxwood::builders {
namespace {

struct Fixture {
  TriangleMesh mesh;
  std::shared_ptr<const refs::Primitives> primitives;
  std::vector<refs::Reference> references;
  Box bounds;

  explicit Fixture(TriangleMesh made) : mesh(std::move(made)), primitives(refs::triangle_primitives(mesh)) {
    SequentialExecutor executor;
    const auto set = refs::make_references(mesh, executor);
    references.assign(set->references.begin(), set->references.end());
    bounds = set->bounds;
  }
  SweepInput input(SideAreas areas, std::uint64_t spare) const {
    return {references, *primitives, bounds, area_scale(bounds), spare, areas};
  }
};

/// Small triangles whose corners lie on a coarse grid: many coincide, many are flat on an axis.
TriangleMesh grid_soup(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto corner = [&] {
      return Vec3{static_cast<float>(random.index(8)), static_cast<float>(random.index(8)),
                  static_cast<float>(random.index(4))};
    };
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(corner());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

struct Priced {
  double cost = kInfinity;
  std::size_t left = 0, right = 0;
};

/// What a plane makes of the references, cut one by one.
Priced price(const Fixture& f, const PlaneSplit& plane, SideAreas areas) {
  Box left, right;
  Priced priced;
  for (const refs::Reference& reference : f.references) {
    Box below, above;
    if (reference.upper[plane.axis] < plane.position ||
        (reference.upper[plane.axis] == plane.position &&
         (reference.lower[plane.axis] < plane.position || plane.flat_left))) {
      below = reference.box();
      ++priced.left;
    } else if (reference.lower[plane.axis] >= plane.position) {
      above = reference.box();
      ++priced.right;
    } else {
      f.primitives->cut(reference, plane.axis, plane.position, below, above);
      ++priced.left, ++priced.right;
    }
    left.grow(below), right.grow(above);
  }
  if (areas == SideAreas::region) {
    left = right = f.bounds;
    left.upper[plane.axis] = right.lower[plane.axis] = plane.position;
  }
  const float scale = area_scale(f.bounds);
  if (priced.left != 0 && priced.right != 0)
    priced.cost = static_cast<double>(scaled_half_area(left, scale)) * static_cast<double>(priced.left) +
                  static_cast<double>(scaled_half_area(right, scale)) * static_cast<double>(priced.right);
  return priced;
}

/// The cheapest plane through a side of a box.
Priced best_of_all(const Fixture& f, SideAreas areas, std::uint64_t spare) {
  Priced best;
  for (int axis = 0; axis < 3; ++axis)
    for (const refs::Reference& reference : f.references)
      for (const float position : {reference.lower[axis], reference.upper[axis]})
        for (const bool flat_left : {true, false}) {
          const Priced priced = price(f, {.axis = axis, .position = position, .flat_left = flat_left}, areas);
          if (priced.left + priced.right - f.references.size() <= spare && priced.cost < best.cost) best = priced;
        }
  return best;
}

class PlaneSweep : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  std::vector<Fixture> fixtures() const {
    std::vector<Fixture> all;
    all.emplace_back(test::soup(20 + GetParam() % 30, GetParam()));
    all.emplace_back(grid_soup(20 + GetParam() % 30, GetParam()));
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Seeds, PlaneSweep, ::testing::Range<std::uint64_t>(1, 25));

TEST_P(PlaneSweep, FindsTheCheapestPlane) {
  SequentialExecutor executor;
  for (const Fixture& f : fixtures())
    for (const SideAreas areas : {SideAreas::region, SideAreas::tight})
      for (const std::uint64_t spare : {0, 3, 1000}) {
        const SweepResult found = sweep_planes(f.input(areas, spare), executor);
        const Priced expected = best_of_all(f, areas, spare);
        SCOPED_TRACE("spare " + std::to_string(spare) + (areas == SideAreas::tight ? ", tight" : ", region"));
        ASSERT_EQ(found.best.exists(), expected.cost < kInfinity);
        if (!found.best.exists()) continue;
        EXPECT_NEAR(found.best.cost, expected.cost, 1e-5 * expected.cost);
        const Priced priced = price(f, found.best, areas);
        EXPECT_EQ(found.best.left, priced.left);
        EXPECT_EQ(found.best.right, priced.right);
        EXPECT_NEAR(found.best.cost, priced.cost, 1e-5 * priced.cost);
        const double unlimited = best_of_all(f, areas, 1000).cost;
        if (std::fabs(unlimited - expected.cost) < 1e-5 * unlimited) continue;
        EXPECT_EQ(found.overruns(), unlimited < expected.cost);
      }
}

TEST_P(PlaneSweep, PlanesBetweenEventsAreNoDearer) {
  SequentialExecutor executor;
  for (const Fixture& f : fixtures()) {
    const PlaneSplit tight = sweep_planes(f.input(SideAreas::tight, 1000), executor).best;
    const PlaneSplit between = sweep_planes(f.input(SideAreas::between, 1000), executor).best;
    EXPECT_LE(between.cost, tight.cost);
    EXPECT_NEAR(between.cost, price(f, between, SideAreas::tight).cost, 1e-5 * between.cost);
  }
}

TEST(PlaneSweepBetween, FindsThePapersPlaneThroughTheMiddle) {
  // Two triangles that cross: no side of a box parts them, the plane through the crossing does (Popov et al., figure
  // 7).
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 4}, {0, 1, 0}, {0, 0, 4}, {4, 0, 0}, {4, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Fixture f(mesh);
  SequentialExecutor executor;
  EXPECT_FALSE(sweep_planes(f.input(SideAreas::tight, 2), executor).best.exists());
  const PlaneSplit plane = sweep_planes(f.input(SideAreas::between, 2), executor).best;
  ASSERT_TRUE(plane.exists());
  double least = kInfinity;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 1; i < 1000; ++i) {
      const float end = axis == 1 ? 1.0f : 4.0f;
      least = std::min(least,
                       price(f, {.axis = axis, .position = end * static_cast<float>(i) / 1000}, SideAreas::tight).cost);
    }
  EXPECT_NEAR(plane.cost, least, 0.02 * least);
}

TEST(PlaneSweepEmpty, CutsOffEmptySpaceOnlyWhenAsked) {
  const Fixture f(test::soup(30, 4));
  SequentialExecutor executor;
  SweepInput input = f.input(SideAreas::region, 0);
  input.region.lower.x -= 100;
  input.area_scale = area_scale(input.region);
  const PlaneSplit without = sweep_planes(input, executor).best;
  EXPECT_TRUE(!without.exists() || without.left != 0);
  input.empty_sides = true;
  input.empty_factor = 0.8;
  const PlaneSplit with = sweep_planes(input, executor).best;
  EXPECT_EQ(with.axis, 0);
  EXPECT_EQ(with.position, f.bounds.lower.x);
  EXPECT_EQ(with.left, 0u);
  EXPECT_EQ(with.right, f.references.size());
}

TEST_P(PlaneSweep, BinsPriceTheirPlanesRight) {
  for (const Fixture& f : fixtures())
    for (const int count : {2, 7, 64, kMostSpatialBins}) {
      SpatialBins bins(f.bounds, count), half(f.bounds, count);
      for (std::size_t i = 0; i < f.references.size(); ++i) (i % 2 ? bins : half).add(f.references[i], *f.primitives);
      bins.add(half);
      const SpatialBinSplit best = bins.best_split(f.references.size(), 1000, area_scale(f.bounds));
      double expected = kInfinity;
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 1; i < count; ++i) {
          const float position =
              f.bounds.lower[axis] + static_cast<float>(i) / static_cast<float>(count) * f.bounds.extent()[axis];
          expected = std::min(
              expected, price(f, {.axis = axis, .position = position, .flat_left = false}, SideAreas::tight).cost);
        }
      ASSERT_EQ(best.plane.exists(), expected < kInfinity);
      if (!best.plane.exists()) continue;
      const Priced priced = price(f, best.plane, SideAreas::tight);
      EXPECT_NEAR(best.plane.cost, expected, 1e-4 * expected) << count << " bins";
      EXPECT_EQ(best.plane.left, priced.left) << count << " bins";
      EXPECT_EQ(best.plane.right, priced.right) << count << " bins";
    }
}

TEST(SpareReferences, SharesAddUpAndFollowTheWeights) {
  EXPECT_EQ(spare_references(10, 1.5), 5u);
  EXPECT_EQ(spare_references(10, 1), 0u);
  const SpareShares plain = share_rest(20, 10, 6, 8);  // four were added: 16 are left
  EXPECT_EQ(plain.left + plain.right, 16u);
  EXPECT_EQ(plain.left, 6u);
  const SpareShares weighted = share_rest(20, 10, 6, 8, 3, 1);
  EXPECT_EQ(weighted.left, 12u);
  EXPECT_EQ(weighted.right, 4u);
  const SpareShares none = share_rest(4, 10, 6, 8, 0, 0);
  EXPECT_EQ(none.left + none.right, 0u);
}

}  // namespace
}  // namespace boxwood::builders
