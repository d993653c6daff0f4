// Every builder of the registry, with each of its choices, over real triangles: valid trees, the same ones for every
// number of threads, and the hits that testing every triangle gives.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "boxwood/accel.h"
#include "boxwood/metrics.h"
#include "support/builder_names.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

using Settings = std::map<std::string, std::string>;

/// A scene with rays through it and their hits, made once for all builders.
struct Case {
  TriangleMesh mesh;
  std::vector<Box> boxes;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

/// One leaf that holds every triangle: nothing can be missed by a tree that is not there.
tree::BinaryTree one_leaf(const std::vector<Box>& boxes) {
  tree::BinaryTree tree;
  tree.primitive_count = boxes.size();
  tree.nodes = AlignedBuffer<tree::Node>(1);
  tree.references = AlignedBuffer<std::uint32_t>(boxes.size());
  Box bounds;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    bounds.grow(boxes[i]);
    tree.references[i] = static_cast<std::uint32_t>(i);
  }
  tree.nodes[0] = {bounds, 0, static_cast<std::uint32_t>(boxes.size())};
  return tree;
}

std::vector<Ray> rays_through(const TriangleMesh& mesh, const Box& bounds, std::size_t count) {
  test::Random random(31);
  const auto inside = [&] {
    const Vec3 e = bounds.extent();
    return bounds.lower + Vec3{random() * e.x, random() * e.y, random() * e.z};
  };
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    rays[i].origin = inside();
    rays[i].direction = random.direction();
    // The planes of splits lie at vertices, so that is where parts of triangles could come apart.
    if (i % 2 == 1) rays[i].direction = mesh.vertices[random.index(mesh.vertices.size())] - rays[i].origin;
  }
  return rays;
}

Case make_case(const char* scene) {
  Case c;
  c.mesh = mesh::make_scene(scene, {.triangles = test::effort(2000, 8), .seed = 7, .rotate = {30, 40, 20}})->mesh;
  const MeshView view = c.mesh;
  Box bounds;
  for (std::uint32_t i = 0; i < view.triangle_count; ++i) {
    c.boxes.push_back(view.triangle(i).bounds());
    bounds.grow(c.boxes.back());
  }
  c.rays = rays_through(c.mesh, bounds, test::effort(2000, 4));
  c.hits.resize(c.rays.size());
  EXPECT_TRUE(Accel::from_tree(view, one_leaf(c.boxes))->closest_hits(c.rays, c.hits));
  return c;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {make_case("atrium"), make_case("spaceship")};
  return all;
}

class EveryBuilder : public ::testing::TestWithParam<std::size_t> {
 protected:
  const builders::BuilderInfo& info() const { return builders::registry()[GetParam()]; }

  /// The defaults, each choice of each option, and both little and much room for splitting.
  std::vector<Settings> variants() const {
    std::vector<Settings> all = {{}};
    for (const builders::OptionSpec& spec : info().options) {
      for (std::size_t i = 1; i < spec.choices.size(); ++i) all.push_back({{spec.key, spec.choices[i]}});
      if (spec.key == std::string_view("growth")) {
        all.push_back({{"growth", "1.05"}});
        all.push_back({{"growth", "8"}});
        all.push_back({{"growth", "8"}, {"leaf.max", "1"}});
      }
    }
    return all;
  }

  Result<tree::BinaryTree> build(const TriangleMesh& mesh, const Settings& settings, Executor& executor) const {
    auto set = refs::make_references(mesh, executor);
    if (!set) return set.error();
    return builders::build(std::move(*set), {info().id, settings}, {executor});
  }
};

std::string text(const Settings& settings) {
  std::string all = "settings:";
  for (const auto& [key, value] : settings) all += " " + key + "=" + value;
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, EveryBuilder, ::testing::Range<std::size_t>(0, builders::registry().size()),
                         test::builder_name);

TEST(EveryBuilderCases, TheOracleAgreesWithDoublePrecision) {
  for (const Case& c : cases()) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < c.rays.size(); i += 10) {  // even ones: those at vertices are on the edge of a hit
      const queries::ExactHit exact = queries::brute_force_closest(c.mesh, c.rays[i]);
      const Hit& hit = c.hits[i];
      found += hit.is_hit();
      if (hit && exact.t < kInfinity && std::fabs(hit.t - exact.t) <= 1e-4 * exact.t + 1e-6) continue;
      if (!hit && !(exact.t < kInfinity)) continue;
      EXPECT_LT(exact.margin, 1e-5) << "ray " << i << ": " << hit.t << " but " << exact.t;
    }
    EXPECT_GT(found, c.rays.size() / 100) << "the rays should hit something";
  }
}

TEST_P(EveryBuilder, HitsAreThoseOfTestingEveryTriangle) {
  SequentialExecutor executor;
  for (const Case& c : cases()) {
    if (c.boxes.size() > info().largest_sensible) GTEST_SKIP() << "this builder takes smaller sets only";
    for (const Settings& settings : variants()) {
      SCOPED_TRACE(text(settings));
      const auto tree = build(c.mesh, settings, executor);
      ASSERT_TRUE(tree) << tree.error().message;
      const Status valid = tree::validate(*tree, {.primitive_boxes = c.boxes});
      ASSERT_TRUE(valid) << valid.error().message;
      EXPECT_TRUE(info().splits_references || tree->references.size() == c.boxes.size());
      const auto accel = Accel::from_tree(c.mesh, *tree);
      ASSERT_TRUE(accel) << accel.error().message;
      std::vector<Hit> hits(c.rays.size());
      ASSERT_TRUE(accel->closest_hits(c.rays, hits));
      for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(hits[i].primitive, c.hits[i].primitive) << "ray " << i;
        ASSERT_EQ(hits[i].t, c.hits[i].t) << "ray " << i;
      }
    }
  }
}

TEST_P(EveryBuilder, GrowthIsKept) {
  SequentialExecutor executor;
  for (const Settings& settings : variants()) {
    const auto growth = settings.find("growth");
    if (growth == settings.end()) continue;
    const Case& c = cases()[0];
    const auto tree = build(c.mesh, settings, executor);
    ASSERT_TRUE(tree) << tree.error().message;
    EXPECT_LE(static_cast<double>(tree->references.size()),
              std::stod(growth->second) * static_cast<double>(c.boxes.size()))
        << text(settings);
  }
}

// Long triangles askew to the axes are what splitting is for, given room.
TEST_P(EveryBuilder, SplittingPays) {
  if (test::kInstrumented) GTEST_SKIP() << "the scene is too small there";
  SequentialExecutor executor;
  const Case& c = cases()[0];
  const auto whole = builders::build(*refs::make_references(c.mesh, executor), {"sweep-sah", {}}, {executor});
  ASSERT_TRUE(whole);
  for (const Settings& settings : variants()) {
    if (settings != Settings{{"growth", "8"}}) continue;
    const auto split = build(c.mesh, settings, executor);
    ASSERT_TRUE(split);
    EXPECT_LT(metrics::surface_area_cost(*split), 0.9 * metrics::surface_area_cost(*whole)) << text(settings);
  }
}

TEST_P(EveryBuilder, ThreadsChangeNothing) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const TriangleMesh mesh = mesh::make_scene("atrium", {.triangles = 6000, .rotate = {30, 40, 20}})->mesh;
  if (mesh.triangles.size() > info().largest_sensible) GTEST_SKIP() << "this builder takes smaller sets only";
  SequentialExecutor sequential;
  const auto expected = build(mesh, {}, sequential);
  ASSERT_TRUE(expected) << expected.error().message;
  for (const int threads : test::thread_counts()) {
    ThreadExecutor executor(threads);
    const auto tree = build(mesh, {}, executor);
    ASSERT_TRUE(tree) << tree.error().message;
    EXPECT_EQ(tree::hash(*expected), tree::hash(*tree)) << threads << " threads";
  }
}

}  // namespace
}  // namespace boxwood
