// Every layout, instruction set and mode against brute force in double precision, and against each other bit for bit.
#include <gtest/gtest.h>

#include <cstring>

#include "boxwood/accel.h"
#include "boxwood/render.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

using queries::Mode;

struct Variant {
  std::string layout, isa;
};

std::vector<Variant> variants() {
  std::vector<Variant> all;
  for (const auto& layout : layouts::registry())
    for (const auto& isa : queries::supported_isas()) all.push_back({layout.name, isa});
  return all;
}

Accel make(const MeshView& mesh, const Variant& variant, std::string builder = "binned-sah") {
  auto accel =
      Accel::build(mesh, {.build = {.builder = std::move(builder)}, .layout = variant.layout, .isa = variant.isa});
  EXPECT_TRUE(accel) << accel.error().message;
  return std::move(*accel);
}

std::vector<Hit> trace(const Accel& accel, std::span<const Ray> rays, Mode mode) {
  std::vector<Hit> hits(rays.size());
  EXPECT_TRUE(accel.closest_hits(rays, hits, {}, mode));
  return hits;
}

std::vector<Ray> random_rays(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = 2.0f * random.in_cube();
    ray.direction = std::exp2(random.between(-20, 20)) * random.direction();
    if (random() < 0.3f) ray.direction = (random.in_cube() - ray.origin);
    if (random() < 0.2f) ray.tmin = 0.3f * random() / length(ray.direction);
    if (random() < 0.2f) ray.tmax = ray.tmin + random() / length(ray.direction);
    if (random() < 0.1f) ray.direction[static_cast<int>(random.index(3))] = 0;
    if (random() < 0.1f) ray.direction[static_cast<int>(random.index(3))] = -0.0f;
  }
  return rays;
}

// Agreement with the oracle: same triangle, or a t that differs by rounding only, or a verdict on an edge.
void expect_agreement(const MeshView& mesh, const Ray& ray, const Hit& hit, const std::string& where) {
  const auto exact = queries::brute_force_closest(mesh, ray);
  if (!hit && !(exact.t < kInfinity)) return;
  if (hit) {
    // What was reported must be there: the triangle's plane at that t, within its (slightly grown) borders.
    ASSERT_LT(hit.primitive, mesh.triangle_count) << where;
    const Triangle t = mesh.triangle(hit.primitive);
    const Vec3 a = ray.origin + hit.t * ray.direction;
    const Vec3 b = (1 - hit.u - hit.v) * t.v0 + hit.u * t.v1 + hit.v * t.v2;
    EXPECT_LT(length(a - b), 1e-4f) << where;
    EXPECT_GE(hit.t, ray.tmin) << where;
    EXPECT_LE(hit.t, ray.tmax) << where;
  }
  const bool same = hit && hit.primitive == exact.primitive;
  const bool near = hit && std::fabs(hit.t - exact.t) <= 1e-5 * std::fabs(exact.t) + 1e-6 / length(ray.direction);
  if (same || near) return;
  // The only excuse is that the exact hit lies on a border of the triangle or of [tmin, tmax].
  const double rim = std::min(std::fabs(exact.t - ray.tmin), std::fabs(exact.t - ray.tmax)) * length(ray.direction);
  EXPECT_TRUE(exact.margin < 1e-5 || rim < 1e-5)
      << where << ": got t " << hit.t << " on " << hit.primitive << ", expected t " << exact.t << " on "
      << exact.primitive << " with margin " << exact.margin;
}

TEST(Kernels, AgreeWithBruteForceOnSoup) {
  for (std::uint64_t seed : {1, 2}) {
    const TriangleMesh mesh = test::soup(2000, seed);
    const auto rays = random_rays(1500, seed + 100);
    const auto reference = trace(make(mesh, {"linear", "scalar"}), rays, Mode::robust);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      expect_agreement(mesh, rays[i], reference[i], "seed " + std::to_string(seed) + " ray " + std::to_string(i));
      hits += reference[i].is_hit();
    }
    EXPECT_GT(hits, rays.size() / 10);
    const auto fast = trace(make(mesh, {"wide8", {}}), rays, Mode::fast);
    for (std::size_t i = 0; i < rays.size(); ++i)
      expect_agreement(mesh, rays[i], fast[i], "fast, seed " + std::to_string(seed) + " ray " + std::to_string(i));
  }
}

TEST(Kernels, AllVariantsGiveTheSameBits) {
  const TriangleMesh mesh = test::soup(test::effort(5000, 4), 7);
  const auto rays = random_rays(test::effort(20000, 40), 8);
  for (Mode mode : {Mode::robust, Mode::fast}) {
    const auto expected = trace(make(mesh, {"linear", "scalar"}), rays, mode);
    for (const Variant& variant : variants())
      for (const char* builder : {"binned-sah", "sweep-sah", "middle"}) {
        const auto got = trace(make(mesh, variant, builder), rays, mode);
        EXPECT_EQ(0, std::memcmp(got.data(), expected.data(), got.size() * sizeof(Hit)))
            << variant.layout << " " << variant.isa << " " << builder << " " << queries::name(mode);
      }
  }
}

// Rays that start a hair above large triangles and graze them: whether a triangle behind the origin is taken for one in
// front must not depend on which boxes a tree happens to open.
TEST(Kernels, RaysFromSurfacesDoNotDependOnTheBuilder) {
  const auto scene = mesh::make_scene("atrium", {.triangles = test::effort(20000, 8)});
  ASSERT_TRUE(scene);
  const int size = static_cast<int>(test::effort(300, 8));
  const auto primary = render::primary_rays(scene->view, size, size);
  ASSERT_TRUE(primary);
  const auto rays = render::diffuse_rays(make(scene->mesh, {"wide8", {}}), *primary, 1);
  const auto expected = trace(make(scene->mesh, {"linear", "scalar"}, "middle"), rays, Mode::robust);
  for (const auto& builder : builders::registry()) {
    const auto got = trace(make(scene->mesh, {"wide8", {}}, builder.id), rays, Mode::robust);
    EXPECT_EQ(0, std::memcmp(got.data(), expected.data(), got.size() * sizeof(Hit))) << builder.id;
  }
}

TEST(Kernels, AnyHitAgreesWithClosestHit) {
  const TriangleMesh mesh = test::soup(3000, 9);
  const auto rays = random_rays(test::effort(10000, 20), 10);
  for (const Variant& variant : variants()) {
    const Accel accel = make(mesh, variant);
    for (Mode mode : {Mode::robust, Mode::fast}) {
      const auto hits = trace(accel, rays, mode);
      std::vector<std::uint8_t> occluded(rays.size());
      ASSERT_TRUE(accel.any_hits(rays, occluded, mode));
      for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(occluded[i] != 0, hits[i].is_hit()) << variant.layout << " " << variant.isa << " ray " << i;
    }
  }
}

TEST(Kernels, SingleCallsEqualBatchesAndCountsDoNotChangeHits) {
  const TriangleMesh mesh = test::soup(1000, 11);
  const auto rays = random_rays(test::effort(2000, 4), 12);
  for (const Variant& variant : variants()) {
    const Accel accel = make(mesh, variant);
    const auto batch = trace(accel, rays, Mode::robust);
    std::vector<Hit> counted(rays.size());
    std::vector<queries::Counts> counts(rays.size());
    std::vector<Vec3> normals(rays.size());
    std::vector<Hit> with_normals(rays.size());
    ASSERT_TRUE(accel.closest_hits_counted(rays, counted, counts));
    ASSERT_TRUE(accel.closest_hits(rays, with_normals, normals));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const SurfaceHit single = accel.closest_surface_hit(rays[i]);
      ASSERT_EQ(0, std::memcmp(&single, &batch[i], sizeof(Hit)));
      ASSERT_EQ(0, std::memcmp(&counted[i], &batch[i], sizeof(Hit)));
      ASSERT_EQ(single.normal, normals[i]);
      if (batch[i])
        ASSERT_EQ(single.normal, mesh.view().triangle(batch[i].primitive).normal());
      else
        ASSERT_EQ(single.normal, Vec3{});
      ASSERT_EQ(counts[i].rays, 1u);
      ASSERT_EQ(counts[i].hits, batch[i].is_hit() ? 1u : 0u);
      ASSERT_EQ(accel.any_hit(rays[i]), batch[i].is_hit());
      if (batch[i]) {
        ASSERT_GT(counts[i].nodes, 0u);
        ASSERT_GT(counts[i].primitives, 0u);
      }
    }
  }
}

// Rays from inside a closed surface at its vertices, at points on its edges and at random, in three placements.
TEST(Kernels, RobustModeLosesNoRayInsideAClosedSurface) {
  const struct {
    float radius;
    Vec3 center;
  } placements[] = {{1, {}}, {1, {100, -100, 57}}, {1e-4f, {}}, {1e-4f, {0.01f, 0, 0}}, {1e-15f, {}}, {1e12f, {}}};
  for (const auto& [radius, center] : placements) {
    const TriangleMesh mesh = test::icosphere(4, radius, center);
    for (const Variant& variant : variants()) {
      const Accel accel = make(mesh, variant);
      for (auto aim : {test::Aim::vertices, test::Aim::edges, test::Aim::random}) {
        const auto rays = test::rays_from_inside(mesh, center, radius, aim, test::effort(10000, 40), 5);
        std::size_t lost = 0;
        for (const Hit& hit : trace(accel, rays, Mode::robust)) lost += !hit;
        EXPECT_EQ(lost, 0u) << variant.layout << " " << variant.isa << " aim " << static_cast<int>(aim) << " radius "
                            << radius << " x " << center.x;
      }
    }
  }
}

// Axis-parallel rays through vertices, along edges' ends and in the sides of boxes: a grid seen from straight above.
TEST(Kernels, AxisParallelRaysThroughEveryGridCorner) {
  const TriangleMesh mesh = test::grid(32);
  std::vector<Ray> rays;
  for (const Vec3& corner : mesh.vertices) {
    rays.push_back({{corner.x, 5, corner.z}, 0, {0, -1, 0}, kInfinity});
    rays.push_back({{corner.x, -5, corner.z}, 0, {-0.0f, 3, -0.0f}, kInfinity});
    if (corner.x < 32) rays.push_back({{corner.x + 0.25f, 5, corner.z}, 0, {0, -1e-20f, 0}, kInfinity});
  }
  for (const Variant& variant : variants()) {
    const auto hits = trace(make(mesh, variant), rays, Mode::robust);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      ASSERT_TRUE(hits[i]) << variant.layout << " " << variant.isa << " ray " << i;
      ASSERT_FLOAT_EQ(hits[i].t * std::fabs(rays[i].direction.y), 5) << i;
    }
  }
}

// A direction component of exactly zero, at every scale: the box test's reciprocal must neither overflow nor become
// NaN.
TEST(Kernels, RaysParallelToAPlaneAtEveryScale) {
  for (float radius : {1e-30f, 1e-12f, 1e-4f, 1.0f, 1e6f, 1e15f}) {
    const TriangleMesh mesh = test::icosphere(3, radius);
    test::Random random(6);
    std::vector<Ray> rays(test::effort(3000, 6));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      rays[i] = {0.5f * radius * random.direction(), 0, random.direction(), kInfinity};
      rays[i].direction[static_cast<int>(i % 3)] = i % 2 ? 0.0f : -0.0f;
      if (i % 5 == 0) rays[i].direction[static_cast<int>((i + 1) % 3)] = 0;
    }
    for (const Variant& variant : variants()) {
      const auto hits = trace(make(mesh, variant), rays, Mode::robust);
      for (std::size_t i = 0; i < hits.size(); ++i)
        ASSERT_TRUE(hits[i]) << variant.layout << " " << variant.isa << " radius " << radius << " ray " << i;
    }
  }
}

TEST(Kernels, LowestIdWinsAmongCoincidentTriangles) {
  TriangleMesh mesh = test::grid(8);
  const auto once = mesh.triangles;
  for (int copy = 0; copy < 5; ++copy) mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  test::Random random(3);
  std::vector<Ray> rays(2000);
  for (Ray& ray : rays) ray = {{8 * random(), 3, 8 * random()}, 0, {random() - 0.5f, -1, random() - 0.5f}, kInfinity};
  for (const Variant& variant : variants())
    for (Mode mode : {Mode::robust, Mode::fast})
      for (const Hit& hit : trace(make(mesh, variant), rays, mode))
        if (hit) {
          ASSERT_LT(hit.primitive, once.size()) << variant.layout << " " << variant.isa;
        }
}

TEST(Kernels, IntervalIsClosed) {
  TriangleMesh mesh;
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  for (const Variant& variant : variants()) {
    const Accel accel = make(mesh, variant);
    for (Mode mode : {Mode::robust, Mode::fast}) {
      const Vec3 from{0, 0, 4}, toward{0, 0, -1};
      EXPECT_TRUE(accel.any_hit({from, 4, toward, 4}, mode));
      EXPECT_TRUE(accel.any_hit({from, 0, toward, 4}, mode));
      EXPECT_TRUE(accel.any_hit({from, 4, toward, kInfinity}, mode));
      EXPECT_FALSE(accel.any_hit({from, 0, toward, 3.9999f}, mode));
      EXPECT_FALSE(accel.any_hit({from, 4.0001f, toward, kInfinity}, mode));
      EXPECT_FALSE(accel.any_hit({from, 5, toward, 4}, mode));
      EXPECT_TRUE(accel.any_hit({{0, 0, 0}, 0, toward, kInfinity}, mode)) << "starts on the surface";
      EXPECT_TRUE(accel.any_hit({from, -7, toward, kInfinity}, mode)) << "a negative tmin counts as zero";
      EXPECT_FALSE(accel.any_hit({{0, 0, -1}, -7, toward, kInfinity}, mode)) << "nothing behind the origin";
    }
  }
}

TEST(Kernels, MalformedRaysHitNothing) {
  const TriangleMesh mesh = test::icosphere(2);
  const float nan = std::nanf("");
  const Ray rays[] = {
      {{0, 0, 0}, 0, {0, 0, 0}, kInfinity},
      {{nan, 0, 0}, 0, {0, 0, 1}, kInfinity},
      {{0, 0, 0}, 0, {0, nan, 1}, kInfinity},
      {{0, 0, 0}, 0, {kInfinity, 0, 0}, kInfinity},
      {{0, -kInfinity, 0}, 0, {0, 1, 0}, kInfinity},
      {{0, 0, 0}, nan, {0, 0, 1}, kInfinity},
      {{0, 0, 0}, 0, {0, 0, 1}, nan},
      {{0, 0, 0}, 0, {0, 0, 1}, -1},
      {{0, 0, 0}, kInfinity, {0, 0, 1}, kInfinity},
  };
  for (const Variant& variant : variants())
    for (Mode mode : {Mode::robust, Mode::fast}) {
      const auto hits = trace(make(mesh, variant), rays, mode);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        EXPECT_FALSE(hits[i]) << variant.layout << " " << variant.isa << " ray " << i;
        EXPECT_EQ(hits[i].t, kInfinity);
      }
    }
}

TEST(Kernels, LengthOfTheDirectionOnlyScalesT) {
  const TriangleMesh mesh = test::icosphere(3);
  for (const Variant& variant : variants()) {
    const Accel accel = make(mesh, variant);
    for (float scale : {0x1p-148f, 0x1p-126f, 0x1p-60f, 1.0f, 0x1p60f, 0x1p126f}) {
      const Hit hit = accel.closest_hit({{0.1f, 0.2f, 0.05f}, 0, {0, 0, scale}, kInfinity});
      const Hit one = accel.closest_hit({{0.1f, 0.2f, 0.05f}, 0, {0, 0, 1}, kInfinity});
      ASSERT_TRUE(hit) << variant.layout << " " << variant.isa << " scale " << scale;
      EXPECT_EQ(hit.primitive, one.primitive);
      EXPECT_EQ(hit.u, one.u);
      // 2^148 does not fit a float: t is then infinite, the triangle is still the right one.
      EXPECT_EQ(hit.t, one.t / scale);
    }
  }
}

}  // namespace
}  // namespace boxwood
