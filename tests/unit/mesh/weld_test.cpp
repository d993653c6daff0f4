#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <tuple>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

using Ids = std::vector<std::uint32_t>;

Ids weld_points(const std::vector<Vec3>& points, Executor& executor) {
  return mesh::weld({points.data(), points.size()}, executor);
}

/// An ordered map is the other way to find first equal positions; its order takes -0 and +0 for the same.
Ids expected_ids(const std::vector<Vec3>& points) {
  std::map<std::tuple<float, float, float>, std::uint32_t> seen;
  Ids ids;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    ids.push_back(is_finite(p) ? seen.emplace(std::tuple(p.x, p.y, p.z), i).first->second : i);
  }
  return ids;
}

TEST(Weld, SmallCases) {
  SequentialExecutor executor;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(weld_points({}, executor), Ids{});
  EXPECT_EQ(weld_points({{1, 2, 3}}, executor), Ids{0});
  EXPECT_EQ(weld_points({{0, 0, 0}, {-0.0f, 0, -0.0f}, {0, -0.0f, 0}}, executor), (Ids{0, 0, 0}));
  EXPECT_EQ(
      weld_points({{nan, 0, 0}, {nan, 0, 0}, {kInfinity, 0, 0}, {kInfinity, 0, 0}, {1, 0, 0}, {1, 0, 0}}, executor),
      (Ids{0, 1, 2, 3, 4, 4}));
  // The smallest number apart is still apart, and so are permuted coordinates.
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(
      weld_points({{0, 0, 0}, {tiny, 0, 0}, {1, 2, 3}, {3, 2, 1}, {2, 1, 3}, {1e30f, 0, 0}, {1e30f, 0, 0}}, executor),
      (Ids{0, 1, 2, 3, 4, 5, 5}));
}

TEST(Weld, AgreesWithAMapForEachExecutor) {
  std::vector<Vec3> points;
  std::uint32_t state = 12345;
  for (int i = 0; i < 120'000; ++i) {
    float c[3];
    for (float& x : c) state = state * 1664525u + 1013904223u, x = float(int(state >> 24) % 40 - 20) * 0.25f;
    points.push_back({c[0] == 0 && (state & 1) ? -0.0f : c[0], c[1], c[2]});
  }
  points[77'777].y = std::numeric_limits<float>::quiet_NaN();
  const Ids expected = expected_ids(points);
  test::with_each_executor([&](Executor& executor) { EXPECT_EQ(weld_points(points, executor), expected); });
}

TEST(Weld, AllEqualPoints) {
  const std::vector<Vec3> points(100'000, Vec3{3, 4, 5});
  test::with_each_executor([&](Executor& executor) { EXPECT_EQ(weld_points(points, executor), Ids(100'000, 0)); });
}

TEST(Weld, ReadsAnyStrideAndAlignment) {
  const TriangleMesh apart = test::exploded(test::wave(9, 7));
  SequentialExecutor executor;
  const Ids expected = expected_ids(apart.vertices);
  for (const std::size_t stride : {12u, 13u, 16u, 31u})
    for (const std::size_t offset : {0u, 1u, 2u, 3u})
      EXPECT_EQ(mesh::weld(test::TightView(apart, stride, stride, offset), executor), expected)
          << stride << " " << offset;
}

}  // namespace
}  // namespace boxwood
