// Packet traversals and rays that hits do not end, against single rays bit for bit and against brute force.
#include <gtest/gtest.h>

#include <cstring>

#include "boxwood/accel.h"
#include "boxwood/metrics.h"
#include "boxwood/render.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

using queries::Counts;
using queries::Mode;
using queries::Traversal;
using queries::TraversalOptions;

std::vector<TraversalOptions> all_options() {
  std::vector<TraversalOptions> all;
  for (const bool terminating : {true, false}) {
    all.push_back({Traversal::single, 256, terminating});
    all.push_back({Traversal::packet4, 256, terminating});
    for (const Traversal traversal : {Traversal::range, Traversal::partition})
      for (const std::uint32_t size : {16u, 17u, 256u, 1024u}) all.push_back({traversal, size, terminating});
  }
  return all;
}

std::string text(const TraversalOptions& o) {
  return std::string(queries::name(o.traversal)) + " " + std::to_string(o.packet_size) +
         (o.terminating ? "" : " non-terminating");
}

Accel make(const MeshView& mesh, std::string builder = "binned-sah", std::string layout = "linear",
           std::shared_ptr<Executor> executor = std::make_shared<SequentialExecutor>()) {
  auto accel = Accel::build(mesh, {.build = {.builder = std::move(builder)}, .layout = layout, .executor = executor});
  EXPECT_TRUE(accel) << accel.error().message;
  return std::move(*accel);
}

/// Rays of all kinds side by side: mixed signs, zeros, short intervals, malformed ones, coherent stretches.
std::vector<Ray> mixed_rays(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    Ray& ray = rays[i];
    ray.origin = 2.0f * random.in_cube();
    ray.direction = std::exp2(random.between(-20, 20)) * random.direction();
    if (random() < 0.3f) ray.direction = random.in_cube() - ray.origin;
    if (i % 300 < 100) ray.origin = {3, 2, 4}, ray.direction = 0.5f * random.in_cube() - ray.origin;
    if (random() < 0.2f) ray.tmin = 0.3f * random() / length(ray.direction);
    if (random() < 0.2f) ray.tmax = ray.tmin + random() / length(ray.direction);
    if (random() < 0.1f) ray.direction[static_cast<int>(random.index(3))] = random() < 0.5f ? 0.0f : -0.0f;
    if (random() < 0.05f) ray.direction = {};
    if (random() < 0.05f) ray.tmin = 1, ray.tmax = 0;
    if (random() < 0.02f) ray.origin.y = std::nanf("");
  }
  return rays;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_the_answers_of_single_rays(const Accel& accel, std::span<const Ray> rays, const std::string& where) {
  const std::size_t n = rays.size();
  std::vector<Hit> expected(n), hits(n), counted(n);
  std::vector<Vec3> expected_normals(n), normals(n);
  std::vector<std::uint8_t> expected_any(n), any(n), any_counted(n);
  std::vector<Counts> counts(n);
  for (const Mode mode : {Mode::robust, Mode::fast}) {
    ASSERT_TRUE(accel.closest_hits(rays, expected, expected_normals, mode));
    ASSERT_TRUE(accel.any_hits(rays, expected_any, mode));
    for (const TraversalOptions& options : all_options()) {
      const std::string at = where + ", " + queries::name(mode) + ", " + text(options);
      ASSERT_TRUE(accel.closest_hits(rays, hits, normals, mode, options)) << at;
      ASSERT_TRUE(accel.closest_hits_counted(rays, counted, counts, mode, options)) << at;
      ASSERT_TRUE(accel.any_hits(rays, any, mode, options)) << at;
      EXPECT_TRUE(same_bits(hits, expected)) << at;
      EXPECT_TRUE(same_bits(normals, expected_normals)) << at;
      EXPECT_TRUE(same_bits(counted, expected)) << at;
      EXPECT_EQ(any, expected_any) << at;
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(counts[i].hits, expected[i].is_hit()) << at << " ray " << i;
      ASSERT_TRUE(accel.any_hits_counted(rays, any_counted, counts, mode, options)) << at;
      EXPECT_EQ(any_counted, expected_any) << at;
    }
  }
}

TEST(Traversal, FindsWhatSingleRaysFindWhateverThePacket) {
  const TriangleMesh mesh = test::soup(300, 3);
  for (const char* builder : {"binned-sah", "middle"}) {
    const Accel accel = make(mesh, builder);
    for (const std::size_t count : {0, 1, 3, 5, 257, 1030})
      expect_the_answers_of_single_rays(accel, mixed_rays(count, 17 + count),
                                        std::string(builder) + " " + std::to_string(count));
  }
}

TEST(Traversal, AgreesWithBruteForce) {
  const TriangleMesh mesh = test::icosphere(2);
  const Accel accel = make(mesh);
  const auto rays = test::rays_from_inside(mesh, {}, 1, test::Aim::random, 600, 5);
  for (const TraversalOptions& options : all_options()) {
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(accel.closest_hits(rays, hits, {}, Mode::robust, options));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto exact = queries::brute_force_closest(mesh, rays[i]);
      ASSERT_TRUE(hits[i]) << text(options) << " ray " << i;
      ASSERT_NEAR(hits[i].t, exact.t, 1e-5) << text(options) << " ray " << i;
      if (exact.margin > 1e-5) {
        ASSERT_EQ(hits[i].primitive, exact.primitive) << text(options) << " ray " << i;
      }
    }
  }
}

// The packet's intervals must hold at every scale and far from the origin, where a float has few digits.
TEST(Traversal, PacketIntervalsAreConservativeAtEveryScale) {
  for (const float scale : {1e-30f, 1e-4f, 1.0f, 1e15f})
    for (const float offset : {0.0f, 30.0f}) {
      const Vec3 center = scale * offset * Vec3{1, -1, 0.5f};
      const TriangleMesh mesh = test::icosphere(1, scale, center);
      const Accel accel = make(mesh);
      test::Random random(9);
      std::vector<Ray> rays(320);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3 corner = mesh.vertices[random.index(mesh.vertices.size())];
        const Vec3 eye = center + scale * Vec3{4, 3, 5};
        rays[i] = {i < 160 ? eye : center + 3 * scale * random.direction(), 0, {}, kInfinity};
        rays[i].direction = corner - rays[i].origin;
      }
      expect_the_answers_of_single_rays(accel, rays, std::to_string(scale) + " " + std::to_string(offset));
    }
}

TEST(Traversal, FlatScenesSingleTrianglesAndNoneAtAll) {
  const auto rays = mixed_rays(130, 4);
  expect_the_answers_of_single_rays(make(test::grid(6)), rays, "flat");
  TriangleMesh mesh;
  expect_the_answers_of_single_rays(make(mesh), rays, "empty");
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  expect_the_answers_of_single_rays(make(mesh), rays, "one");
}

// Rays that nothing ends are asked at exactly the leaves whose boxes they meet, in every traversal.
TEST(Traversal, NonTerminatingRaysTestTheSameTriangles) {
  const TriangleMesh mesh = test::soup(400, 6);
  const Accel accel = make(mesh);
  const auto rays = mixed_rays(600, 7);
  std::vector<Hit> hits(rays.size());
  std::vector<Counts> single(rays.size()), terminating(rays.size()), counts(rays.size());
  ASSERT_TRUE(accel.closest_hits_counted(rays, hits, terminating));
  ASSERT_TRUE(accel.closest_hits_counted(rays, hits, single, Mode::robust, {Traversal::single, 256, false}));
  std::uint64_t more = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_GE(single[i].nodes, terminating[i].nodes) << i;
    ASSERT_GE(single[i].primitives, terminating[i].primitives) << i;
    more += single[i].primitives - terminating[i].primitives;
  }
  EXPECT_GT(more, rays.size());
  for (const TraversalOptions& options : all_options()) {
    if (options.terminating) continue;
    ASSERT_TRUE(accel.closest_hits_counted(rays, hits, counts, Mode::robust, options));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(counts[i].primitives, single[i].primitives) << text(options) << " ray " << i;
      ASSERT_EQ(counts[i].leaves, single[i].leaves) << text(options) << " ray " << i;
      if (options.traversal == Traversal::packet4) {
        // A malformed ray beside a sound one is tested against the root, and misses it.
        ASSERT_TRUE(counts[i].nodes == single[i].nodes || (single[i].nodes == 0 && counts[i].nodes == 1)) << i;
      }
      if (options.traversal == Traversal::partition && single[i].nodes) {
        ASSERT_LE(counts[i].nodes, single[i].nodes) << text(options) << " ray " << i;
      }
    }
  }
}

TEST(Traversal, CountsDoNotDependOnThreads) {
  const TriangleMesh mesh = test::soup(200, 8);
  const auto rays = mixed_rays(2500, 9);
  const Accel one = make(mesh), many = make(mesh, "binned-sah", "linear", std::make_shared<ThreadExecutor>(8));
  for (const TraversalOptions& options : all_options()) {
    std::vector<Hit> a(rays.size()), b(rays.size());
    std::vector<Counts> x(rays.size()), y(rays.size());
    ASSERT_TRUE(one.closest_hits_counted(rays, a, x, Mode::robust, options));
    ASSERT_TRUE(many.closest_hits_counted(rays, b, y, Mode::robust, options));
    EXPECT_TRUE(same_bits(a, b)) << text(options);
    EXPECT_TRUE(same_bits(x, y)) << text(options);
  }
}

// The surface area cost is the expected cost of a line through the box that never ends.
TEST(Traversal, LinesThatNeverEndCostWhatTheCostModelSays) {
  const TriangleMesh mesh = test::soup(400, 10);
  auto executor = std::make_shared<SequentialExecutor>();
  for (const char* builder : {"sweep-sah", "middle"}) {
    auto references = refs::make_references(mesh, *executor);
    ASSERT_TRUE(references);
    const auto tree = builders::build(std::move(*references), {.builder = builder}, {*executor});
    ASSERT_TRUE(tree);
    const auto accel = Accel::from_tree(mesh, *tree, {.layout = "linear", .executor = executor});
    ASSERT_TRUE(accel);
    const auto rays = render::line_rays(accel->bounds(), 20000, 11);
    std::vector<Hit> hits(rays.size());
    std::vector<Counts> counts(rays.size());
    ASSERT_TRUE(accel->closest_hits_counted(rays, hits, counts, Mode::robust, {Traversal::single, 256, false}));
    const tree::CostModel cost{2, 3};
    double sum = 0, squares = 0;
    for (const Counts& c : counts) {
      const double value = cost.traversal * 0.5 * static_cast<double>(c.nodes - 1) +
                           cost.intersection * static_cast<double>(c.primitives);
      sum += value, squares += value * value;
    }
    const double n = static_cast<double>(rays.size()), mean = sum / n;
    const double error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, metrics::surface_area_cost(*tree, cost), 5 * error) << builder;
    EXPECT_LT(error, 0.02 * mean);
  }
}

TEST(Traversal, RefusesWhatALayoutHasNot) {
  const TriangleMesh mesh = test::icosphere(1);
  const auto rays = mixed_rays(5, 1);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> any(rays.size());
  const Accel wide = make(mesh, "binned-sah", "wide8"), linear = make(mesh);
  for (const TraversalOptions& options :
       {TraversalOptions{Traversal::range, 256, true}, TraversalOptions{Traversal::single, 256, false}}) {
    const Status status = wide.closest_hits(rays, hits, {}, Mode::robust, options);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::unsupported);
    EXPECT_NE(status.error().message.find("wide8"), std::string::npos);
    EXPECT_FALSE(wide.any_hits(rays, any, Mode::robust, options));
  }
  for (const std::uint32_t size : {0u, 15u, 1025u}) {
    const Status status = linear.closest_hits(rays, hits, {}, Mode::robust, {Traversal::partition, size, true});
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find(std::to_string(size)), std::string::npos);
    EXPECT_TRUE(linear.closest_hits(rays, hits, {}, Mode::robust, {Traversal::packet4, size, true}));
    EXPECT_TRUE(linear.closest_hits(rays, hits, {}, Mode::robust, {Traversal::single, size, false}));
  }
  for (const auto traversal : {Traversal::single, Traversal::packet4, Traversal::range, Traversal::partition,
                               Traversal::batch, Traversal::coherent, Traversal::interleaved, Traversal::sorted})
    EXPECT_EQ(*queries::find_traversal(queries::name(traversal)), traversal);
  EXPECT_FALSE(queries::find_traversal("dance"));
}

}  // namespace
}  // namespace boxwood
