// Counted visits against brute force.
#include <gtest/gtest.h>

#include "boxwood/accel.h"
#include "support/meshes.h"

namespace boxwood::queries {
namespace {

std::vector<Ray> rays_through_the_cube(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) ray.origin = random.in_cube(), ray.direction = random.direction(), ray.tmax = 0.5f;
  return rays;
}

TEST(VisitCounts, RootSuccessesAreTheRaysThatHit) {
  const TriangleMesh mesh = test::soup(400, 11);
  const auto rays = rays_through_the_cube(500, 12);
  std::size_t hits = 0;
  for (const Ray& ray : rays) hits += brute_force_closest(mesh, ray).primitive != layouts::kInvalidPrimitive;
  ASSERT_GT(hits, 50u);
  ASSERT_LT(hits, 450u);
  ThreadExecutor threads(3);
  SequentialExecutor sequential;
  for (const char* layout : {"wide4", "wide8", "wide8-quads"}) {
    const auto accel = Accel::build(mesh, {.layout = layout});
    ASSERT_TRUE(accel);
    // With one ray at a time, successes below the root say whether it hits.
    std::size_t found = 0;
    std::uint64_t cost = 0;
    for (const Ray& ray : rays) {
      const auto counts = count_visits(accel->layout(), {&ray, 1}, sequential);
      ASSERT_TRUE(counts);
      bool hit = false;
      for (int i = 0; i < counts->width; ++i) hit |= counts->children[std::size_t(i)].successes > 0;
      found += hit;
      cost += counts->any_hit_cost;
      EXPECT_LE(counts->any_hit_cost, counts->total_cost);
    }
    EXPECT_EQ(found, hits) << layout;
    const auto all = count_visits(accel->layout(), rays, threads);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->any_hit_cost, cost) << layout;
    for (const auto& child : all->children) EXPECT_LE(child.successes, child.met);
  }
}

TEST(VisitCounts, AreTheKernelsVisitsForRaysThatMiss) {
  const TriangleMesh mesh = test::soup(400, 13);
  const auto accel = Accel::build(mesh);
  ASSERT_TRUE(accel);
  std::vector<Ray> misses;
  for (const Ray& ray : rays_through_the_cube(500, 14))
    if (!accel->closest_hit(ray)) misses.push_back(ray);
  ASSERT_GT(misses.size(), 50u);
  std::vector<std::uint8_t> occluded(misses.size());
  std::vector<Counts> per_ray(misses.size());
  ASSERT_TRUE(accel->any_hits_counted(misses, occluded, per_ray));
  Counts total;
  for (const Counts& c : per_ray) total += c;
  SequentialExecutor executor;
  const auto counts = count_visits(accel->layout(), misses, executor);
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->any_hit_cost, counts->total_cost);
  // Nodes, and at least one block for each leaf.
  EXPECT_GE(counts->total_cost, kNodePrice * total.nodes + kBlockPrice * total.leaves);
  EXPECT_LE(counts->total_cost, kNodePrice * total.nodes + kBlockPrice * 4 * total.leaves);
}

TEST(VisitCounts, LinearIsRefused) {
  const auto accel = Accel::build(test::grid(3), {.layout = "linear"});
  ASSERT_TRUE(accel);
  SequentialExecutor executor;
  EXPECT_NE(count_visits(accel->layout(), {}, executor).error().message.find("linear"), std::string::npos);
}

}  // namespace
}  // namespace boxwood::queries
