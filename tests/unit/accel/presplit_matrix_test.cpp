// Every builder behind every pre-split: valid trees, the same for every number of threads, and the hits of an oracle
// that tests all triangles.
#include <gtest/gtest.h>

#include "boxwood/accel.h"
#include "support/builder_names.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

/// Small scenes with what pre-splits are for: turned architecture, needles, everything at once.
std::vector<TriangleMesh> small_scenes() {
  std::vector<TriangleMesh> meshes;
  meshes.push_back(mesh::make_scene("atrium", {.triangles = test::effort(400, 2), .rotate = {30, 40, 20}})->mesh);
  meshes.push_back(mesh::make_scene("spaceship", {.triangles = test::effort(400, 2)})->mesh);
  meshes.push_back(test::soup(150, 5));
  return meshes;
}

constexpr const char* kPresplits[] = {"evh:t=9", "evh:auto,budget=1.5", "evh:clip,t=10", "esc:k=100"};

class PresplitMatrix : public ::testing::TestWithParam<std::size_t> {
 protected:
  std::string builder() const { return builders::registry()[GetParam()].id; }

  tree::BinaryTree build(const TriangleMesh& mesh, const char* presplit, Executor& executor) const {
    auto set = refs::make_references(mesh, executor);
    set = refs::apply_presplit(std::move(*set), mesh, *refs::parse_presplit(presplit), executor);
    EXPECT_TRUE(set);
    auto tree = builders::build(std::move(*set), {builder(), {}}, {executor});
    EXPECT_TRUE(tree) << tree.error().message;
    return std::move(*tree);
  }
};

INSTANTIATE_TEST_SUITE_P(All, PresplitMatrix, ::testing::Range<std::size_t>(0, builders::registry().size()),
                         test::builder_name);

TEST_P(PresplitMatrix, TreesAreValidAndTheSameForEveryNumberOfThreads) {
  SequentialExecutor sequential;
  for (const TriangleMesh& mesh : small_scenes()) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) boxes.push_back(mesh.view().triangle(i).bounds());
    for (const char* presplit : kPresplits) {
      SCOPED_TRACE(mesh.name + ", " + presplit);
      const tree::BinaryTree tree = build(mesh, presplit, sequential);
      EXPECT_TRUE(tree.splits_references);
      const Status valid = tree::validate(tree, {.primitive_boxes = boxes});
      EXPECT_TRUE(valid) << valid.error().message;
      for (const int threads : test::thread_counts()) {
        ThreadExecutor executor(threads);
        EXPECT_EQ(tree::hash(build(mesh, presplit, executor)), tree::hash(tree)) << threads;
      }
    }
  }
}

TEST_P(PresplitMatrix, HitsAreThoseOfTheOracle) {
  const auto executor = std::make_shared<SequentialExecutor>();
  for (const TriangleMesh& mesh : small_scenes()) {
    const Box box = mesh::bounds(mesh, *executor);
    test::Random random(11);
    std::vector<Ray> rays(150);
    for (Ray& ray : rays) {
      const Vec3 e = box.extent();
      ray.origin = box.lower + Vec3{random() * e.x, random() * e.y, random() * e.z};
      ray.direction = random.direction();
    }
    for (const char* presplit : kPresplits) {
      SCOPED_TRACE(mesh.name + ", " + presplit);
      const auto accel = Accel::build(mesh, {.build = {builder(), {}}, .presplit = presplit, .executor = executor});
      ASSERT_TRUE(accel) << accel.error().message;
      std::size_t hits = 0;
      for (const Ray& ray : rays) {
        const queries::ExactHit exact = queries::brute_force_closest(mesh, ray);
        const Hit hit = accel->closest_hit(ray);
        if (exact.margin > 1e-5) {
          ASSERT_TRUE(hit.is_hit());
          EXPECT_NEAR(hit.t, exact.t, 1e-4 * (1 + exact.t));
          ++hits;
        } else if (!hit.is_hit()) {
          EXPECT_TRUE(std::isinf(exact.t) || exact.margin <= 1e-5);
        }
      }
      EXPECT_GT(hits, 20u);
    }
  }
}

TEST(AccelPresplit, ErrorsNameTheValue) {
  const auto accel = Accel::build(test::icosphere(0), {.presplit = "evh:t=99"});
  ASSERT_FALSE(accel);
  EXPECT_NE(accel.error().message.find("'99'"), std::string::npos);
}

}  // namespace
}  // namespace boxwood
