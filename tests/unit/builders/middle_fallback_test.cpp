// What a spatial median without a fall-back makes of one stray vertex, and that the fall-back prevents it.
#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "boxwood/mesh.h"

namespace boxwood {
namespace {

std::size_t largest_leaf(const mesh::SceneOptions& options, const char* fallback) {
  SequentialExecutor executor;
  const auto scene = mesh::make_scene("atrium", options);
  EXPECT_TRUE(scene);
  auto references = refs::make_references(scene->mesh, executor);
  const auto tree = builders::build(std::move(*references), {"middle", {{"fallback", fallback}}}, {executor});
  EXPECT_TRUE(tree);
  return tree::statistics(*tree).max_leaf;
}

TEST(MiddleFallback, OneStrayVertexMakesTheMeshALeaf) {
  // The long triangle's centroid is a third of the way out, so the middle of the box parts nothing.
  EXPECT_GE(largest_leaf({.triangles = 5000, .spike = 1000}, "none"), 4000u);
  EXPECT_EQ(largest_leaf({.triangles = 5000, .spike = 1000}, "median"), 1u);
}

TEST(MiddleFallback, AFarTriangleIsPartedFromTheRest) {
  EXPECT_LT(largest_leaf({.triangles = 5000, .outlier = 1000}, "none"), 1000u);
  EXPECT_EQ(largest_leaf({.triangles = 5000, .outlier = 1000}, "median"), 1u);
}

}  // namespace
}  // namespace boxwood
