// The batch engine against single rays, bit for bit, and against brute force: packets, rays in flight and sorted rays
// on every instruction set, in both modes, over rays of every kind.
#include <gtest/gtest.h>

#include <cstring>

#include "boxwood/accel.h"
#include "boxwood/render.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

using queries::Mode;
using queries::Traversal;

constexpr Traversal kBatches[] = {Traversal::batch, Traversal::coherent, Traversal::interleaved, Traversal::sorted};

Accel make(const MeshView& mesh, const std::string& layout, const std::string& isa = {},
           const std::string& builder = "binned-sah",
           std::shared_ptr<Executor> executor = std::make_shared<SequentialExecutor>()) {
  auto accel = Accel::build(
      mesh, {.build = {.builder = builder}, .layout = layout, .isa = isa, .executor = std::move(executor)});
  EXPECT_TRUE(accel) << accel.error().message;
  return std::move(*accel);
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Coherent stretches of several kinds, incoherent rays among them, limits, and rays that can hit nothing.
std::vector<Ray> mixed_rays(std::size_t count, std::uint64_t seed) {
  const std::size_t stretch = test::effort(192, 3);
  test::Random random(seed);
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    Ray& ray = rays[i];
    const Vec3 small = 0.1f * random.in_cube();
    switch (i / stretch % 5) {
      case 0:  // from one point
        ray = {{3, 2, 4}, 0, small - Vec3{3, 2, 4}, kInfinity};
        break;
      case 1:  // to one point
        ray = {small, 0, Vec3{-2, 5, 1} - small, 1};
        break;
      case 2:  // parallel, along an axis or nearly
        ray = {small + Vec3{0, 0, i % 2 ? 3.0f : -3.0f}, 0, {0, 0, i % 2 ? -1.0f : 1.0f}, kInfinity};
        break;
      case 3:  // about a diagonal, where the main axis changes
        ray = {{4, 4, -4}, 0, small + Vec3{-1, -1, 1}, kInfinity};
        break;
      default:
        ray = {2.0f * random.in_cube(), 0, std::exp2(random.between(-20, 20)) * random.direction(), kInfinity};
    }
    if (random() < 0.1f) ray.tmin = 0.5f * random() / length(ray.direction);
    if (random() < 0.1f) ray.tmax = ray.tmin + 3 * random() / length(ray.direction);
    if (random() < 0.05f) ray.direction[static_cast<int>(random.index(3))] = random() < 0.5f ? 0.0f : -0.0f;
    if (random() < 0.03f) ray.direction = {};
    if (random() < 0.03f) ray.tmin = 1, ray.tmax = 0;
    if (random() < 0.02f) ray.origin.y = std::nanf("");
    if (random() < 0.02f) ray.direction.x = kInfinity;
    if (random() < 0.02f) ray.tmin = std::nanf("");
    if (random() < 0.02f) ray.tmax = std::nanf("");
  }
  return rays;
}

/// A picture of the mesh, row by row; `lights`: rays from the surface to a point instead, where there is a surface.
std::vector<Ray> picture(const Accel& accel, int width, int height, bool lights) {
  const View view = mesh::view_from_bounds(accel.bounds().is_empty() ? Box{{-1, -1, -1}, {1, 1, 1}} : accel.bounds());
  auto rays = *render::primary_rays(view, width, height);
  if (!lights) return rays;
  for (Ray& ray : rays) {
    const Hit hit = accel.closest_hit(ray);
    const Vec3 from = ray.origin + 0.999f * hit.t * ray.direction, light = view.eye + 2.0f * Vec3{-1, 2, 0.5f};
    ray = hit ? Ray{from, 0, light - from, 1} : Ray{{}, 1, {1, 0, 0}, 0};
  }
  return rays;
}

void expect_the_answers_of_single_rays(const Accel& accel, std::span<const Ray> rays, const std::string& where) {
  const std::size_t n = rays.size();
  std::vector<Hit> expected(n), hits(n);
  std::vector<Vec3> expected_normals(n), normals(n);
  std::vector<std::uint8_t> expected_any(n), any(n);
  for (const Mode mode : {Mode::robust, Mode::fast}) {
    ASSERT_TRUE(accel.closest_hits(rays, expected, expected_normals, mode, {.traversal = Traversal::single}));
    ASSERT_TRUE(accel.any_hits(rays, expected_any, mode, {.traversal = Traversal::single}));
    for (const Traversal traversal : kBatches) {
      const std::string at = where + ", " + accel.isa() + ", " + queries::name(mode) + ", " + queries::name(traversal);
      std::fill(hits.begin(), hits.end(), Hit{-1, -2, -3, 123456789});
      std::fill(any.begin(), any.end(), std::uint8_t{7});
      ASSERT_TRUE(accel.closest_hits(rays, hits, normals, mode, {.traversal = traversal})) << at;
      ASSERT_TRUE(accel.any_hits(rays, any, mode, {.traversal = traversal})) << at;
      EXPECT_TRUE(same_bits(hits, expected)) << at;
      EXPECT_TRUE(same_bits(normals, expected_normals)) << at;
      EXPECT_EQ(any, expected_any) << at;
      ASSERT_TRUE(accel.closest_hits(rays, hits, {}, mode, {.traversal = traversal})) << at;
      EXPECT_TRUE(same_bits(hits, expected)) << at << ", without normals";
    }
  }
}

void expect_in_all_layouts(const MeshView& mesh, std::span<const Ray> rays, const std::string& where) {
  for (const char* layout : {"wide8", "wide8-quads", "wide16"})
    for (const std::string& isa : queries::supported_isas())
      expect_the_answers_of_single_rays(make(mesh, layout, isa), rays, where + ", " + layout);
}

TEST(Batch, FindsWhatSingleRaysFindWhateverTheirOrder) {
  const TriangleMesh mesh = test::soup(400, 3);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{63}, std::size_t{64},
                                  std::size_t{65}, test::effort(2500, 10)})
    expect_in_all_layouts(mesh, mixed_rays(count, 17 + count), "seed 17, " + std::to_string(count) + " rays");
}

TEST(Batch, PicturesRowByRow) {
  const TriangleMesh mesh = test::icosphere(3);
  for (const char* layout : {"wide8", "wide8-quads", "wide16"})
    for (const bool lights : {false, true}) {
      const Accel accel = make(mesh, layout);
      // Rows that are and are not whole tiles, an unfinished last row, and too few rays to look for rows.
      for (const auto& [width, height] : {std::pair{160, test::kInstrumented ? 52 : 70}, {131, 67}, {50, 40}}) {
        if (test::kInstrumented && (width == 131 || (lights && layout != std::string_view("wide8")))) continue;
        auto rays = picture(accel, width, height, lights);
        rays.resize(rays.size() - 13);
        expect_the_answers_of_single_rays(accel, rays, std::to_string(width) + (lights ? " lights" : " camera"));
      }
    }
}

// Every ray of a tile meets leaves of its own, so packets end and their rays go on alone with the subtrees that wait:
// more of them than are handed over at once, where rays see the whole of a cloud.
TEST(Batch, PacketsThatFallApart) {
  const TriangleMesh mesh = test::soup(test::effort(20000, 20), 6);
  for (const char* layout : {"wide8", "wide8-quads", "wide16"})
    for (const std::string& isa : queries::supported_isas()) {
      const Accel accel = make(mesh, layout, isa);
      for (const bool lights : {false, true}) {
        const auto rays = picture(accel, 48, test::kInstrumented ? 8 : 48, lights);
        expect_the_answers_of_single_rays(accel, rays, std::string(layout) + (lights ? " lights" : " camera"));
      }
    }
}

TEST(Batch, AgreesWithBruteForce) {
  const TriangleMesh mesh = test::icosphere(2);
  const auto rays = test::rays_from_inside(mesh, {}, 1, test::Aim::random, 300, 5);
  const Accel accel = make(mesh, "wide8");
  auto camera = picture(accel, 24, 20, false);
  camera.insert(camera.end(), rays.begin(), rays.end());
  for (const Traversal traversal : kBatches) {
    std::vector<Hit> hits(camera.size());
    ASSERT_TRUE(accel.closest_hits(camera, hits, {}, Mode::robust, {.traversal = traversal}));
    for (std::size_t i = 0; i < camera.size(); ++i) {
      const auto exact = queries::brute_force_closest(mesh, camera[i]);
      if (exact.margin < 1e-5 && exact.primitive != layouts::kInvalidPrimitive) continue;
      ASSERT_EQ(hits[i].primitive, exact.primitive) << queries::name(traversal) << " ray " << i;
      if (hits[i]) {
        ASSERT_NEAR(hits[i].t, exact.t, 1e-5) << queries::name(traversal) << " ray " << i;
      }
    }
  }
}

// Aimed at vertices from one point: a beam or a sign that is off loses a ray there.
TEST(Batch, NothingLeaksAtAnyScale) {
  for (const float scale : {1e-30f, 1e-4f, 1.0f, 1e15f})
    for (const float offset : {0.0f, 30.0f}) {
      const Vec3 center = scale * offset * Vec3{1, -1, 0.5f};
      const TriangleMesh mesh = test::icosphere(2, scale, center);
      std::vector<Ray> rays;
      for (const Vec3& corner : mesh.vertices) rays.push_back({center, 0, corner - center, kInfinity});
      for (const char* layout : {"wide8", "wide8-quads", "wide16"}) {
        const Accel accel = make(mesh, layout);
        for (const Traversal traversal : kBatches) {
          std::vector<Hit> hits(rays.size());
          ASSERT_TRUE(accel.closest_hits(rays, hits, {}, Mode::robust, {.traversal = traversal}));
          for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(hits[i]) << layout << " " << queries::name(traversal) << " scale " << scale << " ray " << i;
        }
        for (Ray& ray : rays) ray.origin = center + 4 * scale * Vec3{1, 0.5f, -0.75f};
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i].direction = mesh.vertices[i] - rays[i].origin;
        expect_the_answers_of_single_rays(accel, rays, std::string(layout) + " scale " + std::to_string(scale));
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {center, 0, mesh.vertices[i] - center, kInfinity};
      }
    }
}

TEST(Batch, FlatScenesDeepTreesSingleTrianglesAndNoneAtAll) {
  const auto rays = mixed_rays(test::effort(1100, 5), 4);
  expect_in_all_layouts(test::grid(6), rays, "flat");
  TriangleMesh mesh;
  expect_in_all_layouts(mesh, rays, "empty");
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  expect_in_all_layouts(mesh, rays, "one");
  // The same triangle many times: ties, and nothing to split.
  mesh.triangles.assign(200, {0, 1, 2});
  expect_in_all_layouts(mesh, rays, "ties");
  // Each triangle half the size of the one before: a tree as deep as it has leaves.
  mesh.vertices.clear(), mesh.triangles.clear();
  for (std::uint32_t i = 0; i < 120; ++i) {
    const float size = std::exp2(-0.9f * static_cast<float>(i));
    for (const Vec3& corner : {Vec3{1, 1, 1}, Vec3{1.5f, 1, 1.1f}, Vec3{1, 1.5f, 0.9f}})
      mesh.vertices.push_back(size * corner);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (const char* layout : {"wide8", "wide8-quads", "wide16"})
    expect_the_answers_of_single_rays(make(mesh, layout, {}, "middle"), rays, "deep");
}

TEST(Batch, DoesNotDependOnThreads) {
  const TriangleMesh mesh = test::soup(200, 8);
  const auto rays = mixed_rays(test::effort(40000, 4), 9);
  const Accel one = make(mesh, "wide8"),
              many = make(mesh, "wide8", {}, "binned-sah", std::make_shared<ThreadExecutor>(8));
  for (const Traversal traversal : kBatches) {
    std::vector<Hit> a(rays.size()), b(rays.size());
    ASSERT_TRUE(one.closest_hits(rays, a, {}, Mode::robust, {.traversal = traversal}));
    ASSERT_TRUE(many.closest_hits(rays, b, {}, Mode::robust, {.traversal = traversal}));
    EXPECT_TRUE(same_bits(a, b)) << queries::name(traversal);
  }
}

TEST(Batch, LayoutsWithoutBatches) {
  const TriangleMesh mesh = test::icosphere(1);
  const auto rays = mixed_rays(300, 2);
  for (const char* layout : {"linear", "wide4"}) {
    const Accel accel = make(mesh, layout);
    std::vector<Hit> single(rays.size()), hits(rays.size());
    ASSERT_TRUE(accel.closest_hits(rays, single, {}, Mode::robust, {.traversal = Traversal::single}));
    ASSERT_TRUE(accel.closest_hits(rays, hits));
    EXPECT_TRUE(same_bits(hits, single)) << layout;
    for (const Traversal traversal : {Traversal::coherent, Traversal::interleaved, Traversal::sorted}) {
      const Status status = accel.closest_hits(rays, hits, {}, Mode::robust, {.traversal = traversal});
      ASSERT_FALSE(status) << layout;
      EXPECT_EQ(status.error().code, ErrorCode::unsupported);
      EXPECT_NE(status.error().message.find(layout), std::string::npos) << status.error().message;
      EXPECT_NE(status.error().message.find(queries::name(traversal)), std::string::npos) << status.error().message;
    }
  }
  const Accel wide = make(mesh, "wide8");
  std::vector<std::uint8_t> any(rays.size());
  const Status status = wide.any_hits(rays, any, Mode::robust, {.terminating = false});
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("non-terminating"), std::string::npos) << status.error().message;
}

}  // namespace
}  // namespace boxwood
