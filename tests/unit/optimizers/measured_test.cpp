// Trees from wide trees, measured visits, treelets rebuilt for them.
#include <gtest/gtest.h>

#include <algorithm>

#include "boxwood/builders.h"
#include "boxwood/optimizers.h"
#include "support/meshes.h"

namespace boxwood::optimizers {
namespace {

SequentialExecutor executor;

struct Case {
  TriangleMesh mesh;
  std::vector<Box> boxes;
  tree::BinaryTree tree;
};

Case make_case(TriangleMesh mesh) {
  Case made{std::move(mesh), {}, {}};
  for (std::size_t i = 0; i < made.mesh.triangles.size(); ++i)
    made.boxes.push_back(made.mesh.view().triangle(i).bounds());
  auto references = refs::make_references(made.mesh, executor);
  EXPECT_TRUE(references);
  auto tree = builders::build(std::move(*references), {}, {executor});
  EXPECT_TRUE(tree);
  made.tree = std::move(*tree);
  return made;
}

std::vector<Case> cases() {
  TriangleMesh equal = test::soup(1, 4);
  for (int i = 0; i < 500; ++i) equal.triangles.push_back(equal.triangles[0]);
  std::vector<Case> made;
  for (const TriangleMesh& mesh :
       {test::icosphere(3), test::soup(900, 21), test::grid(20), test::soup(1, 2), test::soup(2, 3), equal})
    made.push_back(make_case(mesh));
  return made;
}

/// Short segments in one corner of the cube, so that areas are a bad guess.
std::vector<Ray> segments(std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = 0.3f * random.in_cube();
    ray.direction = random.direction();
    ray.tmax = 0.2f;
  }
  return rays;
}

bool meets(const Ray& ray, const Box& box) {
  double near = ray.tmin, far = ray.tmax;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    const double a = (double(box.lower[axis]) - ray.origin[axis]) / d;
    const double b = (double(box.upper[axis]) - ray.origin[axis]) / d;
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

/// Inner nodes crossed by all segments together.
std::size_t crossings(const tree::BinaryTree& tree, std::span<const Ray> rays) {
  std::size_t count = 0;
  for (const Ray& ray : rays)
    for (const tree::Node& node : tree.nodes) count += !node.is_leaf() && meets(ray, node.bounds);
  return count;
}

TEST(ExpandToBinary, IsAValidTreeOfSingleReferences) {
  for (const Case& c : cases())
    for (const int width : {2, 4, 8}) {
      const auto wide = collapse_to_wide(c.tree, {.width = width, .max_leaf_blocks = 8}, executor);
      ASSERT_TRUE(wide);
      std::vector<Box> boxes;
      for (const std::uint32_t id : wide->references) boxes.push_back(c.boxes[id]);
      const auto tree = expand_to_binary(*wide, boxes, c.mesh.triangles.size(), false, executor);
      ASSERT_TRUE(tree);
      const Status valid = tree::validate(*tree, {.primitive_boxes = c.boxes, .max_leaf = 1});
      EXPECT_TRUE(valid) << c.mesh.name << " " << width << ": " << valid.error().message;
    }
}

TEST(ExpandToBinary, LeavesMayStay) {
  for (const Case& c : cases()) {
    const auto wide = collapse_to_wide(c.tree, {}, executor);
    ASSERT_TRUE(wide);
    const std::vector<Box> boxes(wide->references.size());
    const auto tree = expand_to_binary(*wide, boxes, c.mesh.triangles.size(), false, executor, false);
    ASSERT_TRUE(tree);
    const Status valid = tree::validate(*tree, {.primitive_boxes = c.boxes, .max_leaf = 8});
    EXPECT_TRUE(valid) << c.mesh.name << ": " << valid.error().message;
    const auto leaves =
        std::count_if(wide->children.begin(), wide->children.end(), [](auto& l) { return l.count > 0; });
    EXPECT_EQ(tree::statistics(*tree).leaves, std::size_t(leaves)) << c.mesh.name;
  }
}

TEST(ExpandToBinary, BoxesMustFit) {
  const Case c = make_case(test::grid(3));
  const auto wide = collapse_to_wide(c.tree, {}, executor);
  ASSERT_TRUE(wide);
  const auto tree = expand_to_binary(*wide, std::span(c.boxes).first(3), 18, false, executor);
  ASSERT_FALSE(tree);
  EXPECT_NE(tree.error().message.find("boxes of 3"), std::string::npos);
}

TEST(NodeVisits, AreTheSharesOfTheSegments) {
  const Case c = make_case(test::soup(900, 22));
  const auto rays = segments(400, 23);
  const auto weights = node_visits(c.tree, rays, 1e-3f, executor);
  ASSERT_TRUE(weights);
  std::vector<std::size_t> counts(c.tree.nodes.size());
  for (std::size_t n = 0; n < counts.size(); ++n)
    counts[n] = std::size_t(
        std::count_if(rays.begin(), rays.end(), [&](const Ray& r) { return meets(r, c.tree.nodes[n].bounds); }));
  for (std::size_t n = 0; n < counts.size(); ++n) {
    if (counts[n] < 20) continue;
    EXPECT_NEAR((*weights)[n] / (*weights)[0], double(counts[n]) / double(counts[0]), 0.02) << n;
    if (!c.tree.nodes[n].is_leaf()) {
      for (const std::uint32_t child : {c.tree.nodes[n].first, c.tree.nodes[n].first + 1})
        EXPECT_LE((*weights)[child], (*weights)[n]);
    }
  }
}

TEST(NodeVisits, WithoutSegmentsAreTheAreas) {
  const Case c = make_case(test::soup(300, 24));
  const auto weights = node_visits(c.tree, {}, 8, executor);
  ASSERT_TRUE(weights);
  for (std::size_t n = 0; n < weights->size(); ++n)
    EXPECT_NEAR((*weights)[n], c.tree.nodes[n].bounds.half_area() / c.tree.bounds().half_area(), 1e-4) << n;
}

TEST(Restructure, SameReferencesFewerVisitsSameBits) {
  ThreadExecutor threads(3);
  for (const Case& c : cases()) {
    const auto rays = segments(400, 25);
    const RestructureOptions options{.prior = 1e-3f};
    const auto tree = restructure(c.tree, rays, options, executor);
    ASSERT_TRUE(tree) << c.mesh.name;
    const Status valid = tree::validate(*tree, {.primitive_boxes = c.boxes});
    EXPECT_TRUE(valid) << c.mesh.name << ": " << valid.error().message;
    // Those at a box's very edge are in double precision here.
    EXPECT_LE(double(crossings(*tree, rays)), 1.001 * double(crossings(c.tree, rays)) + 1) << c.mesh.name;
    const auto parallel = restructure(c.tree, rays, options, threads);
    ASSERT_TRUE(parallel);
    EXPECT_EQ(tree::hash(*tree), tree::hash(*parallel)) << c.mesh.name;
  }
}

TEST(Restructure, FindsABetterTree) {
  const Case c = make_case(test::soup(900, 26));
  const auto rays = segments(400, 27);
  const auto once = restructure(c.tree, rays, {.passes = 1, .prior = 1}, executor);
  const auto often = restructure(c.tree, rays, {.passes = 5, .prior = 1}, executor);
  ASSERT_TRUE(once);
  ASSERT_TRUE(often);
  EXPECT_LT(double(crossings(*once, rays)), 0.97 * double(crossings(c.tree, rays)));
  EXPECT_LE(crossings(*often, rays), crossings(*once, rays));
  const auto none = restructure(c.tree, rays, {.passes = 0}, executor);
  ASSERT_TRUE(none);
  EXPECT_EQ(tree::hash(*none), tree::hash(c.tree));
}

TEST(Restructure, RaysThatCanHitNothingCountForNothing) {
  const Case c = make_case(test::soup(200, 28));
  const float nan = std::nanf("");
  const std::vector<Ray> rays{{.origin = {nan, 0, 0}, .direction = {1, 0, 0}},
                              {.origin = {}, .direction = {}},
                              {.origin = {}, .tmin = 2, .direction = {1, 0, 0}, .tmax = 1}};
  const auto tree = restructure(c.tree, rays, {}, executor);
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree::hash(*tree), tree::hash(c.tree));
}

TEST(NodeWeights, TakeTheAreasPlaceInTheCollapse) {
  const Case c = make_case(test::soup(900, 29));
  std::vector<float> areas, few(3);
  for (const tree::Node& node : c.tree.nodes) areas.push_back(node.bounds.half_area());
  const auto by_area = collapse_to_wide(c.tree, {}, executor);
  const auto by_weight = collapse_to_wide(c.tree, {.node_weights = areas}, executor);
  const auto rays = segments(400, 30);
  const auto visits = node_visits(c.tree, rays, 1, executor);
  const auto by_visits = collapse_to_wide(c.tree, {.node_weights = *visits}, executor);
  ASSERT_TRUE(by_area && by_weight && by_visits);
  EXPECT_EQ(by_area->children.size(), by_weight->children.size());
  EXPECT_NE(by_area->first_child, by_visits->first_child);
  const auto refused = collapse_to_wide(c.tree, {.node_weights = few}, executor);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("weights of 3"), std::string::npos);
}

}  // namespace
}  // namespace boxwood::optimizers
