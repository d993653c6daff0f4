// Accel::optimize: the same hits, less work, the same bits everywhere.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "boxwood/accel.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

std::vector<Ray> rays_in_a_corner(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) ray.origin = 0.4f * random.in_cube(), ray.direction = random.direction();
  return rays;
}
std::vector<Ray> short_rays(std::size_t count, std::uint64_t seed) {
  auto rays = rays_in_a_corner(count, seed);
  for (Ray& ray : rays) ray.tmax = 0.3f;
  return rays;
}

void expect_same_answers(const Accel& a, const Accel& b, std::span<const Ray> rays, const std::string& label) {
  std::vector<Hit> hits_a(rays.size()), hits_b(rays.size());
  std::vector<std::uint8_t> any_a(rays.size()), any_b(rays.size());
  ASSERT_TRUE(a.closest_hits(rays, hits_a) && b.closest_hits(rays, hits_b));
  ASSERT_TRUE(a.any_hits(rays, any_a) && b.any_hits(rays, any_b));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(std::memcmp(&hits_a[i], &hits_b[i], sizeof(Hit)), 0) << label << ", ray " << i;
    ASSERT_EQ(any_a[i], any_b[i]) << label << ", ray " << i;
  }
}

TEST(Optimize, HitsStayTheSameInEveryLayoutAndBehindEveryKindOfBuilder) {
  TriangleMesh equal = test::soup(1, 4);
  for (int i = 0; i < 99; ++i) equal.triangles.push_back(equal.triangles[0]);
  const auto sample = rays_in_a_corner(600, 31), shadows = short_rays(400, 32), other = rays_in_a_corner(600, 33);
  for (const TriangleMesh& mesh : {test::icosphere(3), test::soup(1500, 34), test::soup(1, 2), equal})
    for (const auto& row : layouts::registry())
      for (const char* builder : {"binned-sah", "sbvh"}) {
        const std::string label = mesh.name + " " + row.name + " " + builder;
        const auto accel = Accel::build(mesh, {.build = {.builder = builder}, .layout = row.name});
        ASSERT_TRUE(accel);
        const auto optimized = accel->optimize({sample, shadows});
        ASSERT_TRUE(optimized) << label << ": " << optimized.error().message;
        EXPECT_EQ(optimized->accel.layout().id, row.id);
        EXPECT_LE(optimized->report.work_after, optimized->report.work_before) << label;
        expect_same_answers(*accel, optimized->accel, other, label);
        expect_same_answers(*accel, optimized->accel, shadows, label);
      }
}

TEST(Optimize, AgreesWithBruteForce) {
  const TriangleMesh mesh = test::soup(500, 35);
  const auto accel = Accel::build(mesh, {.build = {.builder = "sbvh"}});
  ASSERT_TRUE(accel);
  const auto optimized = accel->optimize({.closest_hit = rays_in_a_corner(1000, 36)});
  ASSERT_TRUE(optimized);
  int clear = 0;
  for (const Ray& ray : rays_in_a_corner(500, 37)) {
    const queries::ExactHit exact = queries::brute_force_closest(mesh, ray);
    const Hit hit = optimized->accel.closest_hit(ray);
    if (exact.primitive != layouts::kInvalidPrimitive && exact.margin < 1e-5) continue;
    ++clear;
    ASSERT_EQ(hit.primitive, exact.primitive);
  }
  EXPECT_GT(clear, 400);
}

TEST(Optimize, TheTreeIsValidWithEveryReference) {
  const TriangleMesh mesh = test::soup(1500, 38);
  for (const char* layout : {"wide4", "wide8", "wide8-quads", "linear"}) {
    const auto accel = Accel::build(mesh, {.layout = layout});
    ASSERT_TRUE(accel);
    const auto optimized = accel->optimize({rays_in_a_corner(600, 39), short_rays(600, 40)});
    ASSERT_TRUE(optimized);
    std::vector<std::uint32_t> references(mesh.triangles.size());
    for (std::uint32_t i = 0; i < references.size(); ++i) references[i] = i;
    const Status valid = layouts::validate(optimized->accel.layout(), references, false, mesh);
    EXPECT_TRUE(valid) << layout << ": " << valid.error().message;
  }
}

TEST(Optimize, LessWorkOnRaysHeldOut) {
  const auto accel = Accel::build(test::soup(3000, 41));
  ASSERT_TRUE(accel);
  const auto closest = accel->optimize({.closest_hit = rays_in_a_corner(4000, 42)});
  const auto any = accel->optimize({.any_hit = short_rays(4000, 43)});
  ASSERT_TRUE(closest && any);
  for (const auto* optimized : {&*closest, &*any}) {
    EXPECT_TRUE(optimized->report.improved);
    EXPECT_EQ(optimized->report.trained_rays, 3000u);
    EXPECT_EQ(optimized->report.tested_rays, 1000u);
    EXPECT_GT(optimized->report.work_after, 1.0);
    EXPECT_LT(optimized->report.work_after, 0.95 * optimized->report.work_before);
  }
}

TEST(Optimize, SameBitsForEveryExecutorAndInstructionSet) {
  const TriangleMesh mesh = test::soup(1500, 44);
  const auto sample = rays_in_a_corner(1500, 45), shadows = short_rays(1500, 46);
  std::optional<std::uint64_t> expected;
  for (const std::string& isa : queries::supported_isas())
    for (const int threads : {1, 3}) {
      const auto accel = Accel::build(mesh, {.build = {.builder = "sbvh"},
                                             .layout = "wide16",
                                             .isa = isa,
                                             .executor = std::make_shared<ThreadExecutor>(threads)});
      ASSERT_TRUE(accel);
      const auto optimized = accel->optimize({sample, shadows});
      ASSERT_TRUE(optimized);
      EXPECT_EQ(optimized->accel.isa(), isa);
      const layouts::Layout& layout = optimized->accel.layout();
      const std::uint64_t hash = hash_bytes(layout.nodes.data(), layout.nodes.bytes(),
                                            hash_bytes(layout.triangles.data(), layout.triangles.bytes()));
      EXPECT_EQ(hash, expected.value_or(hash)) << isa << " " << threads;
      expected = hash;
    }
}

TEST(Optimize, NeedsNeitherTheMeshNorTheOldAccel) {
  const auto sample = rays_in_a_corner(500, 47);
  std::optional<Accel> kept;
  {
    std::optional<Accel> old;
    {
      const TriangleMesh mesh = test::icosphere(3);
      old = std::move(*Accel::build(mesh));
    }
    auto optimized = old->optimize({.closest_hit = sample});
    ASSERT_TRUE(optimized);
    kept = std::move(optimized->accel);
  }
  for (const Ray& ray : sample) EXPECT_TRUE(kept->any_hit(ray));
}

TEST(Optimize, AnotherLayout) {
  const auto accel = Accel::build(test::icosphere(3));
  ASSERT_TRUE(accel);
  const auto sample = rays_in_a_corner(500, 48);
  for (const char* layout : {"wide4", "wide8-quads", "linear"}) {
    const auto optimized = accel->optimize({.closest_hit = sample}, {.layout = layout});
    ASSERT_TRUE(optimized) << layout;
    EXPECT_STREQ(layouts::name(optimized->accel.layout().id), layout);
    expect_same_answers(*accel, optimized->accel, sample, layout);
  }
}

TEST(Optimize, ATreeThatIsNoBetterIsNotTaken) {
  // Rays that never come near the mesh leave nothing to gain.
  const auto accel = Accel::build(test::icosphere(2));
  ASSERT_TRUE(accel);
  std::vector<Ray> away(100, Ray{.origin = {9, 0, 0}, .direction = {1, 0, 0}});
  const auto optimized = accel->optimize({.closest_hit = away});
  ASSERT_TRUE(optimized);
  EXPECT_FALSE(optimized->report.improved);
  const layouts::Layout &a = accel->layout(), &b = optimized->accel.layout();
  ASSERT_EQ(a.nodes.bytes(), b.nodes.bytes());
  EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.bytes()), 0);
}

TEST(Optimize, EmptyMesh) {
  for (const auto& row : layouts::registry()) {
    const auto empty = Accel::build(MeshView{}, {.layout = row.name});
    ASSERT_TRUE(empty);
    const auto optimized = empty->optimize({.closest_hit = rays_in_a_corner(20, 49)});
    ASSERT_TRUE(optimized) << row.name << ": " << optimized.error().message;
    EXPECT_FALSE(optimized->accel.any_hit({.origin = {}, .direction = {0, 0, 1}}));
  }
}

TEST(Optimize, ErrorsNameTheValue) {
  const auto accel = Accel::build(test::icosphere(1));
  ASSERT_TRUE(accel);
  const auto sample = rays_in_a_corner(20, 50);
  const auto message = [&](const OptimizeOptions& options) {
    const auto optimized = accel->optimize({.closest_hit = sample}, options);
    return optimized ? std::string() : optimized.error().message;
  };
  EXPECT_NE(message({.passes = -1}).find("-1"), std::string::npos);
  EXPECT_NE(message({.passes = 101}).find("101"), std::string::npos);
  EXPECT_NE(message({.prior = 0}).find("above 0"), std::string::npos);
  EXPECT_NE(message({.prior = std::nanf("")}).find("nan"), std::string::npos);
  EXPECT_NE(message({.most_rays = 3}).find("at most 3 rays"), std::string::npos);
  EXPECT_NE(message({.layout = "wide9"}).find("'wide9'"), std::string::npos);
  EXPECT_NE(accel->optimize({}).error().message.find("no sample rays"), std::string::npos);
}

}  // namespace
}  // namespace boxwood
