// Parts of the builders that choose child boxes: counting, the search over configurations, sifting.
#include <gtest/gtest.h>

#include <set>

#include "builders/parts/centroid_sweep.h"
#include "builders/parts/configuration_search.h"
#include "builders/parts/configuration_sift.h"
#include "builders/parts/counting_tree.h"
#include "builders/parts/median_price.h"
#include "builders/parts/tight_planes.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood::builders {
namespace {

using testing::Boxes;
using testing::Random;

std::vector<refs::Reference> references_of(const Boxes& boxes) {
  const refs::ReferenceSet set = testing::reference_set(boxes);
  return {set.references.begin(), set.references.end()};
}

Box bounds_of(std::span<const refs::Reference> references) {
  Box box;
  for (const refs::Reference& reference : references) box.grow(reference.box());
  return box;
}

/// Boxes whose sides are small whole numbers, so that many lie on planes of a grid, and some are flat.
Boxes boxes_on_a_lattice(std::size_t count, std::uint32_t seed) {
  Random random(seed);
  Boxes boxes = testing::make_boxes(count, [&](std::size_t) {
    Box box;
    for (int i = 0; i < 3; ++i) {
      box.lower[i] = std::floor(7 * random());
      box.upper[i] = std::fmin(8.0f, box.lower[i] + std::floor(3 * random()));
    }
    return box;
  });
  boxes[0] = {{0, 0, 0}, {1, 1, 1}}, boxes[1] = {{7, 7, 7}, {8, 8, 8}};
  return boxes;
}

PlaneBox random_plane_box(const CandidatePlanes& planes, Random& random) {
  PlaneBox box;
  for (int i = 0; i < 3; ++i) {
    const auto count = static_cast<float>(planes.lower[i].size());
    const auto a = static_cast<std::int32_t>(count * random()), b = static_cast<std::int32_t>(count * random());
    box.lower[i] = random() < 0.5f ? 0 : std::min(a, b);
    box.upper[i] = random() < 0.5f ? static_cast<std::int32_t>(count) - 1 : std::max(a, b);
  }
  return box;
}

Box box_of(const PlaneBox& box, const CandidatePlanes& planes) {
  Box out;
  for (int i = 0; i < 3; ++i) {
    out.lower[i] = planes.lower[i][static_cast<std::size_t>(box.lower[i])];
    out.upper[i] = planes.upper[i][static_cast<std::size_t>(box.upper[i])];
  }
  return out;
}

SideCounts count_one_by_one(std::span<const refs::Reference> references, const Configuration& boxes, bool may_split) {
  SideCounts counts;
  counts.covered = true;
  for (const refs::Reference& reference : references) {
    const Side side = side_of(reference.box(), boxes);
    counts.left += side == Side::left, counts.right += side == Side::right;
    counts.both += side == Side::both, counts.split += side == Side::split;
    counts.covered &= side != Side::neither && (may_split || side != Side::split);
  }
  return counts;
}

TEST(SideOf, NamesEveryCase) {
  const Configuration boxes{{{0, 0, 0}, {6, 4, 4}}, {{4, 0, 0}, {10, 4, 2}}};
  EXPECT_EQ(side_of({{0, 0, 0}, {1, 4, 4}}, boxes), Side::left);
  EXPECT_EQ(side_of({{7, 0, 0}, {9, 4, 2}}, boxes), Side::right);
  EXPECT_EQ(side_of({{4, 0, 0}, {6, 4, 2}}, boxes), Side::both);
  EXPECT_EQ(side_of({{3, 1, 1}, {7, 2, 2}}, boxes), Side::split);
  EXPECT_EQ(side_of({{3, 1, 1}, {7, 2, 3}}, boxes), Side::neither) << "a corner is in none";
  EXPECT_EQ(side_of({{3, 1, 1}, {11, 2, 2}}, boxes), Side::neither);
  const Configuration apart{{{0, 0, 0}, {4, 4, 4}}, {{5, 0, 0}, {10, 4, 4}}};
  EXPECT_EQ(side_of({{3, 1, 1}, {7, 2, 2}}, apart), Side::neither) << "the gap is in none";
}

TEST(OverlapShare, IsThePartOfTheVolumeAndWorksForFlatNodes) {
  const Box node{{0, 0, 0}, {4, 2, 2}};
  EXPECT_DOUBLE_EQ(overlap_share({{0, 0, 0}, {3, 2, 2}}, {{2, 0, 0}, {4, 2, 1}}, node), 0.25 * 0.5);
  EXPECT_EQ(overlap_share({{0, 0, 0}, {2, 2, 2}}, {{2, 0, 0}, {4, 2, 2}}, node), 0);
  EXPECT_EQ(overlap_share({{0, 0, 0}, {1, 2, 2}}, {{2, 0, 0}, {4, 2, 2}}, node), 0);
  EXPECT_DOUBLE_EQ(overlap_share({{0, 1, 0}, {3, 1, 2}}, {{2, 1, 0}, {4, 1, 2}}, {{0, 1, 0}, {4, 1, 2}}), 0.25);
}

TEST(GridPlanes, FollowTheBoxAndKeepTheNumberOfCells) {
  const CandidatePlanes planes = grid_planes({{0, 0, 0}, {8, 4, 2}}, 64);
  EXPECT_EQ(planes.lower[0].size(), 9u);
  EXPECT_EQ(planes.lower[1].size(), 5u);
  EXPECT_EQ(planes.lower[2].size(), 3u);
  EXPECT_EQ(planes.lower[0][3], 3.0f);
  const CandidatePlanes flat = grid_planes({{1, 2, 3}, {1, 2, 9}}, 10);
  EXPECT_EQ(flat.lower[0], std::vector<float>{1});
  EXPECT_EQ(flat.lower[2].size(), 11u);
  const CandidatePlanes huge = grid_planes({{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}}, 1e12);
  EXPECT_LT(huge.lower[0].size() * huge.lower[0].size() * huge.lower[0].size(), std::size_t{1} << 14);
  for (std::size_t i = 1; i < huge.lower[0].size(); ++i) EXPECT_LT(huge.lower[0][i - 1], huge.lower[0][i]);
  const float next = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(grid_planes({{1, 1, 1}, {next, 1, 1}}, 100).lower[0], (std::vector<float>{1, next}));
}

TEST(Counting, TableTreeAndOneByOneAgree) {
  for (const bool on_planes : {false, true}) {
    const Boxes boxes = on_planes ? boxes_on_a_lattice(300, 1) : testing::soup(300, 2);
    const std::vector<refs::Reference> references = references_of(boxes);
    const CandidatePlanes planes = grid_planes(bounds_of(references), 512);
    const CountingTable table(references, planes);
    const CountingTree tree(references, planes);
    Random random(3);
    std::size_t covered = 0;
    for (int i = 0; i < 3000; ++i) {
      const PlaneBox left = random_plane_box(planes, random), right = random_plane_box(planes, random);
      for (const bool may_split : {false, true}) {
        const SideCounts expected =
            count_one_by_one(references, {box_of(left, planes), box_of(right, planes)}, may_split);
        for (const SideCounts& counts : {table.count(left, right, may_split), tree.count(left, right, may_split)}) {
          ASSERT_EQ(counts.covered, expected.covered) << i;
          if (!expected.covered) continue;
          ++covered;
          EXPECT_EQ(counts.left, expected.left);
          EXPECT_EQ(counts.right, expected.right);
          EXPECT_EQ(counts.both, expected.both);
          EXPECT_EQ(counts.split, expected.split);
        }
      }
    }
    EXPECT_GT(covered, 100u) << "the test saw configurations that hold all";
  }
}

/// All pairs of boxes of planes, without the order and the short cuts of the search.
double cheapest_of_all(std::span<const refs::Reference> references, const Box& node, const CandidatePlanes& planes,
                       const ConfigurationPrice& price) {
  std::vector<Box> boxes;
  const auto size = [&](int axis) { return static_cast<std::int32_t>(planes.lower[axis].size()); };
  PlaneBox box;
  for (box.lower[0] = 0; box.lower[0] < size(0); ++box.lower[0])
    for (box.upper[0] = box.lower[0] + 1; box.upper[0] < size(0); ++box.upper[0])
      for (box.lower[1] = 0; box.lower[1] < size(1); ++box.lower[1])
        for (box.upper[1] = box.lower[1] + 1; box.upper[1] < size(1); ++box.upper[1])
          for (box.lower[2] = 0; box.lower[2] < size(2); ++box.lower[2])
            for (box.upper[2] = box.lower[2] + 1; box.upper[2] < size(2); ++box.upper[2])
              boxes.push_back(box_of(box, planes));
  double best = std::numeric_limits<double>::infinity();
  for (const Box& left : boxes) {
    for (const Box& right : boxes) {
      if (!(merge(left, right) == node)) continue;  // each side of the node is one of a child
      const SideCounts counts = count_one_by_one(references, {left, right}, price.may_split);
      if (!counts.covered || counts.split > price.spare) continue;
      const double left_area = scaled_half_area(left, price.area_scale);
      const double right_area = scaled_half_area(right, price.area_scale);
      const std::uint32_t to_left = counts.left + counts.split + (left_area <= right_area ? counts.both : 0);
      const std::uint32_t to_right = counts.right + counts.split + (left_area <= right_area ? 0 : counts.both);
      if (to_left == 0 || to_right == 0 || to_left >= references.size() || to_right >= references.size()) continue;
      best = std::min(best, price.penalty(left, right, node) * (left_area * to_left + right_area * to_right));
    }
  }
  return best;
}

TEST(ConfigurationSearch, FindsTheCheapestOfAllPairsOfBoxes) {
  SequentialExecutor executor;
  std::size_t found_some = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    const std::vector<refs::Reference> references =
        references_of(seed % 2 ? boxes_on_a_lattice(12, seed) : testing::soup(12, seed));
    const Box node = bounds_of(references);
    const CandidatePlanes planes = grid_planes(node, 27);
    const CountingTable table(references, planes);
    for (const double overlap : {0.0, 1.0, 1e16})
      for (const bool may_split : {false, true}) {
        const ConfigurationPrice price{.area_scale = 1, .overlap = overlap, .may_split = may_split, .spare = 5};
        const double limit = std::numeric_limits<double>::infinity();
        double best = limit;
        for (const PricedConfiguration& found :
             ConfigurationSearch(node, 12, planes, table, price).run(limit, executor)) {
          if (found.cost == limit) continue;
          best = std::min(best, found.cost);
          ++found_some;
          EXPECT_TRUE(count_one_by_one(references, found.boxes, may_split).covered);
        }
        const double expected = cheapest_of_all(references, node, planes, price);
        if (std::isinf(expected))
          EXPECT_EQ(best, expected);
        else
          EXPECT_NEAR(best, expected, 1e-6 * expected) << "seed " << seed << " overlap " << overlap << may_split;
      }
  }
  EXPECT_GT(found_some, 20u);
}

TEST(SidePlanes, SeparateNestedBoxesThatCentroidsCanNot) {
  // Figure 1 of the paper: all centroids coincide.
  Boxes boxes(6, Box{{-1, -1, -1}, {1, 1, 1}});
  boxes.resize(8, Box{{-10, -10, -10}, {10, 10, 10}});
  const std::vector<refs::Reference> references = references_of(boxes);
  const CandidatePlanes planes = side_planes(references);
  const CountingTree tree(references, planes);
  const ConfigurationPrice price;
  SequentialExecutor executor;
  double best = std::numeric_limits<double>::infinity();
  for (const PricedConfiguration& found :
       ConfigurationSearch(bounds_of(references), 8, planes, tree, price).run(best, executor))
    best = std::min(best, found.cost);
  EXPECT_EQ(best, 6 * 12.0 + 2 * 1200.0);
}

TEST(Sifter, PutsSharedOnesIntoTheSmallerAndCutsTheRest) {
  const auto primitives = refs::box_primitives();
  const Configuration boxes{{{0, 0, 0}, {6, 1, 1}}, {{4, 0, 0}, {9, 1, 1}}};
  const Sifter sifter(*primitives, boxes, 1);
  const std::vector<refs::Reference> references =
      references_of({{{0, 0, 0}, {1, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}, {{3, 0, 0}, {8, 1, 1}}});
  std::vector<refs::Reference> left, right;
  sifter.sift(references, left, right);
  ASSERT_EQ(left.size(), 2u);
  ASSERT_EQ(right.size(), 2u);
  EXPECT_EQ(right[0].primitive, 1u) << "the right box is the smaller one";
  EXPECT_EQ(left[1].box(), (Box{{3, 0, 0}, {4, 1, 1}}));
  EXPECT_EQ(right[1].box(), (Box{{4, 0, 0}, {8, 1, 1}}));
  SiftedSide left_side, right_side;
  sifter.measure(references, left_side, right_side);
  EXPECT_EQ(left_side.count, 2u);
  EXPECT_EQ(left_side.bounds, (Box{{0, 0, 0}, {4, 1, 1}}));
  EXPECT_EQ(right_side.bounds, (Box{{4, 0, 0}, {8, 1, 1}}));
}

TEST(TightPlanes, BoundsHoldAndNoPlaneIsMissing) {
  SequentialExecutor executor;
  const auto primitives = refs::box_primitives();
  for (const bool on_planes : {false, true}) {
    const std::vector<refs::Reference> references =
        references_of(on_planes ? boxes_on_a_lattice(40, 5) : testing::soup(40, 6));
    const Box node = bounds_of(references);
    const ConfigurationPrice price{.area_scale = 1, .may_split = true, .spare = 1000};
    const double infinity = std::numeric_limits<double>::infinity();
    const TightPlanes found = tight_planes(references, node, price, infinity, executor);
    std::set<std::pair<int, float>> positions;
    for (const TightPlane& plane : found.planes) {
      positions.insert({plane.axis, plane.position});
      Configuration boxes{node, node};
      boxes.left.upper[plane.axis] = boxes.right.lower[plane.axis] = plane.position;
      SiftedSide left, right;
      Sifter(*primitives, boxes, 1).measure(references, left, right);
      const double cost = left.bounds.half_area() * static_cast<double>(left.count) +
                          right.bounds.half_area() * static_cast<double>(right.count);
      EXPECT_LE(plane.least, cost * (1 + 1e-6));
      if (on_planes) continue;  // flat boxes in the plane make the sides' boxes larger than the estimate says
      EXPECT_NEAR(plane.estimate, cost, 1e-5 * cost) << "parts of boxes fill their boxes";
    }
    EXPECT_EQ(positions.size(), found.planes.size());
    for (const refs::Reference& reference : references)
      for (int axis = 0; axis < 3; ++axis)
        for (const float side : {reference.lower[axis], reference.upper[axis]}) {
          if (!(node.lower[axis] < side && side < node.upper[axis])) continue;
          std::size_t left = 0, right = 0;
          for (const refs::Reference& other : references)
            left += other.lower[axis]<side, right += other.upper[axis]> side;
          EXPECT_EQ(positions.count({axis, side}), left < 40 && right < 40 ? 1u : 0u);
        }
    const ConfigurationPrice no_spare{.area_scale = 1, .may_split = true, .spare = 0};
    const TightPlanes refused = tight_planes(references, node, no_spare, infinity, executor);
    EXPECT_LT(refused.planes.size(), found.planes.size());
    EXPECT_LT(refused.refused, infinity);
  }
}

TEST(CentroidSweep, FindsTheCheapestSplitWithItsPenalty) {
  SequentialExecutor executor;
  const std::vector<refs::Reference> references = references_of(testing::soup(60, 8));
  const Box node = bounds_of(references);
  for (const double overlap : {0.0, 3.0, 1e16}) {
    const ConfigurationPrice price{.area_scale = 1, .overlap = overlap};
    double expected = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      for (const refs::Reference& pivot : references) {
        Box left, right;
        double left_count = 0, right_count = 0;
        for (const refs::Reference& reference : references) {
          const bool is_left = reference.centroid2(axis) < pivot.centroid2(axis);
          (is_left ? left : right).grow(reference.box());
          ++(is_left ? left_count : right_count);
        }
        if (left_count == 0) continue;
        const double cost = left.half_area() * left_count + right.half_area() * right_count;
        expected = std::min(expected, cost * price.penalty(left, right, node));
      }
    EXPECT_NEAR(sweep_centroids(references, node, price, executor).cost, expected, 1e-5 * expected);
  }
}

TEST(MedianTreePrice, OfTwoBoxesApartIsTheirTree) {
  std::vector<refs::Reference> references = references_of({{{0, 0, 0}, {1, 1, 1}}, {{9, 0, 0}, {10, 1, 1}}});
  EXPECT_DOUBLE_EQ(median_tree_price(references, {.traversal = 2, .intersection = 3}, 1), 2 * 21 + 3 * (3.0 + 3.0));
  std::vector<refs::Reference> equal = references_of(Boxes(5, Box{{0, 0, 0}, {1, 1, 1}}));
  EXPECT_DOUBLE_EQ(median_tree_price(equal, {.traversal = 2, .intersection = 3}, 1), 3 * 5 * 3.0);
}

}  // namespace
}  // namespace boxwood::builders
