// What a spatial median without a fall-back makes of triangles as wide as the scene, and that the fall-back prevents it.
#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "boxwood/mesh.h"

namespace boxwood {
namespace {

std::size_t largest_leaf(const char* id, const mesh::SceneOptions& options, const char* fallback) {
  SequentialExecutor executor;
  const auto scene = mesh::make_scene(id, options);
  EXPECT_TRUE(scene);
  auto references = refs::make_references(scene->mesh, executor);
  const auto tree = builders::build(std::move(*references), {"middle", {{"fallback", fallback}}}, {executor});
  EXPECT_TRUE(tree);
  return tree::statistics(*tree).max_leaf;
}

TEST(MiddleFallback, AFloorAsWideAsTheSceneMakesHalfOfItALeaf) {
  EXPECT_GT(largest_leaf("atrium", {.triangles = 5000}, "none"), 2000u);
  EXPECT_EQ(largest_leaf("atrium", {.triangles = 5000}, "median"), 1u);
}

TEST(MiddleFallback, ScansDoWithoutIt) {
  EXPECT_LE(largest_leaf("organic", {.triangles = 5000}, "none"), 8u);
}

TEST(MiddleFallback, FarTrianglesAndVerticesArePartedFromTheRest) {
  for (const char* fallback : {"median", "none"}) {
    EXPECT_LE(largest_leaf("organic", {.triangles = 5000, .outlier = 1000}, fallback), 8u);
    EXPECT_LE(largest_leaf("organic", {.triangles = 5000, .spike = 1000}, fallback), 8u);
  }
}

}  // namespace
}  // namespace boxwood
