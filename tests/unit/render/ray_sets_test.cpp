#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "boxwood/render.h"
#include "render/sampling.h"
#include "support/effort.h"
#include "test_meshes.h"

namespace boxwood::render {
namespace {

const Box kBounds{{-1, 2, -3}, {4, 2.5f, 10}};

bool same_bits(std::span<const Ray> a, std::span<const Ray> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

TEST(RandomRays, OriginsFillTheBoxEvenly) {
  constexpr std::size_t kCount = 200000, kSide = 8;
  const auto rays = random_rays(kBounds, kCount, 3);
  ASSERT_EQ(rays.size(), kCount);
  std::vector<double> counts(kSide * kSide * kSide);
  for (const Ray& ray : rays) {
    std::size_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(ray.origin[axis], kBounds.lower[axis]);
      ASSERT_LE(ray.origin[axis], kBounds.upper[axis]);
      const float share = (ray.origin[axis] - kBounds.lower[axis]) / (kBounds.upper[axis] - kBounds.lower[axis]);
      cell = cell * kSide + std::min(static_cast<std::size_t>(share * kSide), kSide - 1);
    }
    ++counts[cell];
    ASSERT_NEAR(length(ray.direction), 1, 1e-6f);
    ASSERT_EQ(ray.tmin, 0);
    ASSERT_EQ(ray.tmax, kInfinity);
  }
  double chi_square = 0;
  const double expected = static_cast<double>(kCount) / counts.size();
  for (const double count : counts) chi_square += (count - expected) * (count - expected) / expected;
  EXPECT_NEAR(chi_square, counts.size() - 1, 6 * std::sqrt(2.0 * counts.size()));
}

// A convex body inside a box is met by the share of lines that its area is of the box's area.
TEST(LineRays, MeetBoxesInProportionToTheirAreas) {
  constexpr std::size_t kCount = 100000;
  const auto rays = line_rays(kBounds, kCount, 5);
  ASSERT_EQ(rays.size(), kCount);
  const auto meets = [](const Box& box, const Ray& ray) {
    double near = 0, far = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (static_cast<double>(box.lower[axis]) - ray.origin[axis]) / ray.direction[axis];
      const double b = (static_cast<double>(box.upper[axis]) - ray.origin[axis]) / ray.direction[axis];
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    return near <= far;
  };
  const Box grown{kBounds.lower - Vec3{1e-4f, 1e-4f, 1e-4f}, kBounds.upper + Vec3{1e-4f, 1e-4f, 1e-4f}};
  const Box inner[] = {{{-1, 2, -3}, {0, 2.5f, 0}}, {{1, 2.1f, 2}, {3, 2.2f, 9}}, {{0, 2, 0}, {2, 2, 3}}};
  std::size_t hits[3]{};
  for (const Ray& ray : rays) {
    ASSERT_TRUE(meets(grown, ray));
    Box outside = kBounds;
    outside.grow(ray.origin);
    ASSERT_FALSE(outside == kBounds) << "starts inside";
    for (int i = 0; i < 3; ++i) hits[i] += meets(inner[i], ray);
  }
  for (int i = 0; i < 3; ++i) {
    const double share = static_cast<double>(inner[i].half_area()) / kBounds.half_area();
    EXPECT_NEAR(static_cast<double>(hits[i]) / kCount, share, 5 * std::sqrt(share / kCount)) << i;
  }
  EXPECT_TRUE(same_bits(rays, line_rays(kBounds, kCount, 5)));
  EXPECT_FALSE(same_bits(rays, line_rays(kBounds, kCount, 6)));
}

TEST(LineRays, BoxesWithoutVolumeOrAreaAndNone) {
  EXPECT_TRUE(line_rays({}, 10, 1).empty());
  for (const Box& box : {Box{{0, 0, 0}, {1, 2, 0}}, Box{{0, 0, 0}, {0, 0, 3}}, Box{{1, 1, 1}, {1, 1, 1}},
                         Box{{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}}})
    for (const Ray& ray : line_rays(box, 100, 2)) {
      EXPECT_TRUE(is_finite(ray.origin) && is_finite(ray.direction));
      EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
    }
}

TEST(RandomRays, DirectionsHaveTheMomentsOfTheSphereAndIgnoreTheOrigin) {
  constexpr std::size_t kCount = 200000;
  const auto rays = random_rays(kBounds, kCount, 4);
  double first[3]{}, second[3][3]{}, with_origin[3]{};
  for (const Ray& ray : rays)
    for (int i = 0; i < 3; ++i) {
      first[i] += ray.direction[i] / kCount;
      const double centred = ray.origin[i] - 0.5 * (kBounds.lower[i] + kBounds.upper[i]);
      with_origin[i] += centred * ray.direction[i] / (kBounds.upper[i] - kBounds.lower[i]) / kCount;
      for (int j = 0; j < 3; ++j) second[i][j] += static_cast<double>(ray.direction[i]) * ray.direction[j] / kCount;
    }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(first[i], 0, 0.006);
    EXPECT_NEAR(with_origin[i], 0, 0.003);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(second[i][j], i == j ? 1.0 / 3 : 0, 0.004);
  }
}

TEST(RandomRays, ALongerSetBeginsWithTheShorterOneAndSeedsDiffer) {
  const auto longer = random_rays(kBounds, 1000, 5), shorter = random_rays(kBounds, 100, 5);
  EXPECT_TRUE(same_bits(std::span(longer).first(100), shorter));
  EXPECT_NE(hash(random_rays(kBounds, 100, 6)), hash(shorter));
  EXPECT_TRUE(random_rays(kBounds, 0, 5).empty());
}

TEST(RandomRays, FlatPointlikeAndHugeBoxes) {
  for (const Ray& ray : random_rays({{1, 2, 3}, {1, 2, 3}}, 100, 1)) EXPECT_EQ(ray.origin, (Vec3{1, 2, 3}));
  const float big = std::numeric_limits<float>::max();
  bool positive = false, negative = false;
  for (const Ray& ray : random_rays({{-big, 0, -big}, {big, 0, big}}, 100, 1)) {
    EXPECT_TRUE(is_finite(ray.origin));
    EXPECT_EQ(ray.origin.y, 0);
    (ray.origin.x > 0 ? positive : negative) = true;
  }
  EXPECT_TRUE(positive && negative);
}

TEST(RandomRays, BoxesWithoutPointsGiveNoRays) {
  EXPECT_TRUE(random_rays(Box{}, 10, 1).empty());
  EXPECT_TRUE(random_rays({{0, 0, 0}, {kInfinity, 1, 1}}, 10, 1).empty());
  EXPECT_TRUE(random_rays({{0, std::nanf(""), 0}, {1, 1, 1}}, 10, 1).empty());
}

TEST(DiffuseRays, OneForEachHitInOrderOnTheSideTheRayCameFrom) {
  const Accel accel = build(square(1));
  for (const float side : {1.0f, -1.0f}) {
    View view = kFromAbove;
    view.eye.z *= side;
    const auto primary = *primary_rays(view, 40, 30);
    const auto rays = diffuse_rays(accel, primary, 9);
    std::size_t next = 0;
    for (const Ray& ray : primary) {
      const Hit hit = accel.closest_hit(ray);
      if (!hit) continue;
      ASSERT_LT(next, rays.size());
      const Ray& diffuse = rays[next++];
      const Vec3 point = ray.origin + hit.t * ray.direction;
      EXPECT_LT(length(diffuse.origin - point), 1e-4f);
      EXPECT_GT(diffuse.origin.z * side, 0);
      EXPECT_LT(diffuse.origin.z * side, 1e-4f);
      EXPECT_GT(diffuse.direction.z * side, 0);
      EXPECT_EQ(diffuse.tmin, 0);
      EXPECT_EQ(diffuse.tmax, kInfinity);
      EXPECT_FALSE(accel.any_hit(diffuse));
    }
    EXPECT_EQ(next, rays.size());
    EXPECT_GT(rays.size(), 100u);
    EXPECT_LT(rays.size(), primary.size());
  }
}

TEST(DiffuseRays, CosineDistributed) {
  const Accel accel = build(square(100));
  const auto rays = diffuse_rays(accel, *primary_rays(kFromAbove, 300, 300), 10);
  ASSERT_EQ(rays.size(), 90000u);
  double cosine = 0, square_cosine = 0, x = 0, y = 0;
  for (const Ray& ray : rays) {
    cosine += ray.direction.z / rays.size(), square_cosine += ray.direction.z * ray.direction.z / rays.size();
    x += ray.direction.x / rays.size(), y += ray.direction.y / rays.size();
  }
  EXPECT_NEAR(cosine, 2.0 / 3, 0.005);
  EXPECT_NEAR(square_cosine, 0.5, 0.006);
  EXPECT_NEAR(x, 0, 0.01);
  EXPECT_NEAR(y, 0, 0.01);
}

/// Spheres of several sizes, near the origin and so far away that single precision is coarse there.
class ClosedSphere : public testing::TestWithParam<std::pair<float, float>> {
 protected:
  static constexpr int kSide = test::effort(200, 4);  ///< of the pictures whose rays are tried
};

TEST_P(ClosedSphere, RaysThatStartInsideNeverLeak) {
  const auto [radius, distance] = GetParam();
  const Vec3 center = Vec3{1, -0.7f, 0.4f} * (distance * radius);
  const Accel accel = build(icosphere(4, center, radius));
  const View view{
      .eye = center + Vec3{0.2f, 0.1f, -0.3f} * radius, .look_at = center + Vec3{1, 1, 0} * radius, .fov = 120};
  const auto primary = *primary_rays(view, kSide, kSide);
  const auto rays = diffuse_rays(accel, primary, 11);
  ASSERT_EQ(rays.size(), primary.size());
  std::vector<Hit> hits(rays.size());
  ASSERT_TRUE(accel.closest_hits(rays, hits));
  std::size_t leaks = 0;
  for (const Hit& hit : hits) leaks += !hit;
  EXPECT_EQ(leaks, 0u);
}

TEST_P(ClosedSphere, RaysThatStartOutsideNeverMeetIt) {
  const auto [radius, distance] = GetParam();
  const Vec3 center = Vec3{1, -0.7f, 0.4f} * (distance * radius);
  const Accel accel = build(icosphere(4, center, radius));
  const View view{.eye = center + Vec3{0, 1, 3} * radius, .look_at = center, .fov = 40};
  const auto rays = diffuse_rays(accel, *primary_rays(view, kSide, kSide), 12);
  ASSERT_GT(rays.size(), std::size_t{kSide * kSide / 4});
  std::vector<std::uint8_t> occluded(rays.size());
  ASSERT_TRUE(accel.any_hits(rays, occluded));
  std::size_t met = 0;
  for (const std::uint8_t blocked : occluded) met += blocked;
  EXPECT_EQ(met, 0u);
}

INSTANTIATE_TEST_SUITE_P(RadiusAndDistance, ClosedSphere,
                         testing::Values(std::pair{1.0f, 0.0f}, std::pair{1e-4f, 0.0f}, std::pair{1e6f, 0.0f},
                                         std::pair{1e-12f, 1.0f}, std::pair{1.0f, 100.0f}, std::pair{1e-3f, 1000.0f}),
                         [](const auto& info) { return "case_" + std::to_string(info.index); });

TEST(DiffuseRays, RaysFromSliversNeitherMeetThemNorFallThrough) {
  // A fan of triangles a thousand times longer than wide, turned out of the axes: their hits are inexact.
  TriangleMesh fan;
  const Vec3 along = normalize(Vec3{3, 1, 0.5f}), across = normalize(cross(along, {0.2f, -1, 0.4f}));
  const int slivers = 500;
  const float length = 10, width = 0.012f;
  for (int i = 0; i <= slivers; ++i)
    for (const float end : {0.0f, length})
      fan.vertices.push_back(along * end + across * (width * static_cast<float>(i)));
  for (std::uint32_t i = 0; i < 2 * slivers; i += 2) {
    fan.triangles.push_back({i, i + 1, i + 3});
    fan.triangles.push_back({i, i + 3, i + 2});
  }
  const Accel accel = build(fan);
  const Vec3 normal = normalize(cross(along, across)), center = along * 5 + across * 3;
  const int size = static_cast<int>(test::effort(300, 8));
  std::size_t made = 0, met_own = 0, met_neighbour = 0;
  for (const float side : {1.0f, -1.0f}) {
    const View view{.eye = center + normal * (4 * side) + along * 6, .look_at = center, .up = across, .fov = 60};
    const auto primary = *primary_rays(view, size, size);
    const auto rays = diffuse_rays(accel, primary, 17);
    std::size_t next = 0;
    for (const Ray& ray : primary) {
      const Hit start = accel.closest_hit(ray);
      if (!start) continue;
      ASSERT_LT(next, rays.size());
      EXPECT_GT(dot(rays[next].direction, normal) * side, -1e-3f);
      const Hit end = accel.closest_hit(rays[next++]);
      met_own += end.primitive == start.primitive;
      met_neighbour += end && end.primitive != start.primitive;
    }
    made += next;
  }
  EXPECT_GT(made, test::effort(40000, 64));
  EXPECT_EQ(met_own, 0u);
  // The other slivers of the plane are as inexact, and it is not wrong to be near them.
  EXPECT_LT(met_neighbour, made / 1000);
}

TEST(DiffuseRays, DirectionsOfAnyLengthGiveTheSamePoints) {
  const Accel accel = build(square(2));
  auto primary = *primary_rays(kFromAbove, 20, 20);
  const auto rays = diffuse_rays(accel, primary, 13);
  for (Ray& ray : primary) ray.direction = ray.direction * 4;
  const auto same = diffuse_rays(accel, primary, 13);
  ASSERT_EQ(rays.size(), same.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_LT(length(rays[i].origin - same[i].origin), 1e-5f);
    EXPECT_LT(length(rays[i].direction - same[i].direction), 1e-6f);
  }
}

TEST(DiffuseRays, NothingHitGivesNothing) {
  EXPECT_TRUE(diffuse_rays(build(TriangleMesh{}), *primary_rays(kFromAbove, 8, 8), 1).empty());
  EXPECT_TRUE(diffuse_rays(build(square(1)), {}, 1).empty());
  View away = kFromAbove;
  away.look_at.z = 10;
  EXPECT_TRUE(diffuse_rays(build(square(1)), *primary_rays(away, 8, 8), 1).empty());
}

TEST(DiffuseRays, RandomNumbersGoByTheIndexOfThePrimaryRayAcrossBatches) {
  if (test::kInstrumented) GTEST_SKIP() << "a million rays take too long there";
  // More rays than one batch holds, each of them the same: only their indices tell them apart.
  const std::vector<Ray> primary((std::size_t{1} << 20) + 3, Ray{.origin = {0.1f, 0.2f, 1}, .direction = {0, 0, -1}});
  const auto rays = diffuse_rays(build(square(1)), primary, 14);
  ASSERT_EQ(rays.size(), primary.size());
  const auto first = diffuse_rays(build(square(1)), std::span(primary).first(10), 14);
  EXPECT_TRUE(same_bits(std::span(rays).first(10), first));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NE(rays[(std::size_t{1} << 20) + i].direction, rays[i].direction);
}

TEST(OcclusionRays, SegmentsOfTheRadiusAskedFor) {
  const Accel accel = build(square(1));
  const auto primary = *primary_rays(kFromAbove, 16, 16);
  const float fifth = std::sqrt(8.0f) / 5;
  for (const auto& [radius, expected] :
       {std::pair{0.25f, 0.25f}, std::pair{0.0f, fifth}, std::pair{-1.0f, fifth}, std::pair{std::nanf(""), fifth}})
    for (const Ray& ray : occlusion_rays(accel, primary, 1, radius)) {
      EXPECT_FLOAT_EQ(ray.tmax, expected);
      EXPECT_EQ(ray.tmin, 0);
      EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
    }
  EXPECT_EQ(occlusion_rays(accel, primary, 1).size(), diffuse_rays(accel, primary, 1).size());
  EXPECT_TRUE(occlusion_rays(build(TriangleMesh{}), primary, 1).empty());
}

TEST(RaySets, SameBitsOnEveryExecutor) {
  const TriangleMesh mesh = icosphere(3);
  const View view{.eye = {0, 1, 3}, .look_at = {0, 0, 0}, .fov = 45};
  const auto primary = *primary_rays(view, 150, 100);
  const Accel reference = build(mesh, std::make_shared<SequentialExecutor>());
  const auto diffuse = diffuse_rays(reference, primary, 15), occlusion = occlusion_rays(reference, primary, 15);
  ASSERT_GT(diffuse.size(), 4096u);
  EXPECT_FALSE(diffuse[0].direction == occlusion[0].direction);
  for (const int threads : {1, 2, 8}) {
    const Accel accel = build(mesh, std::make_shared<ThreadExecutor>(threads));
    EXPECT_TRUE(same_bits(diffuse_rays(accel, primary, 15), diffuse)) << threads << " threads";
    EXPECT_TRUE(same_bits(occlusion_rays(accel, primary, 15), occlusion)) << threads << " threads";
  }
  EXPECT_NE(hash(diffuse_rays(reference, primary, 16)), hash(diffuse));
}

TEST(RaySetHash, SeesEveryFieldTheOrderAndTheLength) {
  auto rays = random_rays(kBounds, 50, 1);
  const std::uint64_t before = hash(rays);
  EXPECT_EQ(hash(random_rays(kBounds, 50, 1)), before);
  EXPECT_NE(hash(std::span(rays).first(49)), before);
  std::swap(rays[3], rays[4]);
  EXPECT_NE(hash(rays), before);
  std::swap(rays[3], rays[4]);
  rays[49].tmax = 7;
  EXPECT_NE(hash(rays), before);
  EXPECT_NE(hash({}), before);
}

}  // namespace
}  // namespace boxwood::render
