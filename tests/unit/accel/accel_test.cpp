#include "boxwood/accel.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>
#include <utility>

#include "support/meshes.h"

namespace boxwood {
namespace {

TEST(Accel, ThreeLines) {
  const TriangleMesh mesh = test::icosphere(3);
  auto accel = Accel::build(mesh);
  ASSERT_TRUE(accel);
  const Hit hit = accel->closest_hit({.origin = {0, 0, 5}, .direction = {0, 0, -1}});
  EXPECT_TRUE(hit);
  EXPECT_NEAR(hit.t, 4, 0.02);
}

TEST(Accel, EmptyAndExcluded) {
  auto empty = Accel::build(MeshView{});
  ASSERT_TRUE(empty) << empty.error().message;
  EXPECT_FALSE(empty->closest_hit({.origin = {}, .direction = {0, 0, 1}}));
  EXPECT_TRUE(empty->bounds().is_empty());

  TriangleMesh mesh = test::icosphere(1);
  mesh.vertices[0].x = std::nanf("");
  auto accel = Accel::build(mesh);
  ASSERT_TRUE(accel);
  EXPECT_GT(accel->excluded_count(), 0u);
  EXPECT_EQ(accel->excluded_count() + accel->reference_count(), mesh.triangles.size());
}

TEST(Accel, MovesAndOutlivesTheMesh) {
  std::optional<Accel> kept;
  {
    const TriangleMesh mesh = test::icosphere(2);
    auto accel = Accel::build(mesh);
    ASSERT_TRUE(accel);
    kept.emplace(std::move(*accel));
  }
  Accel moved = std::move(*kept);
  EXPECT_TRUE(moved.any_hit({.origin = {}, .direction = {1, 2, 3}}));
  EXPECT_GT(moved.bytes(), moved.layout().bytes());
}

TEST(Accel, ErrorsNameTheValue) {
  const TriangleMesh mesh = test::icosphere(1);
  auto message = [&](const AccelOptions& options) {
    auto accel = Accel::build(mesh, options);
    return accel ? std::string() : accel.error().message;
  };
  EXPECT_NE(message({.layout = "wide9"}).find("'wide9'"), std::string::npos);
  EXPECT_NE(message({.isa = "mmx"}).find("'mmx'"), std::string::npos);
  EXPECT_NE(message({.build = {.builder = "magic"}}).find("'magic'"), std::string::npos);
  EXPECT_NE(message({.build = {.settings = {{"bins", "many"}}}}).find("many"), std::string::npos);

  TriangleMesh broken = mesh;
  broken.triangles[7][1] = 4000;
  auto accel = Accel::build(broken);
  ASSERT_FALSE(accel);
  EXPECT_NE(accel.error().message.find("4000"), std::string::npos) << accel.error().message;
  EXPECT_NE(accel.error().message.find("7"), std::string::npos) << accel.error().message;
}

TEST(Accel, NodesHaveTheLayoutsPriceUnlessGivenAnother) {
  const TriangleMesh mesh = test::soup(2000, 3);
  const auto nodes = [&](const char* layout, float price) {
    const auto accel = Accel::build(mesh, {.layout = layout, .node_cost = price});
    EXPECT_TRUE(accel) << layout << " " << price;
    return std::pair(accel->layout().node_count, accel->layout().leaf_count);
  };
  for (const layouts::LayoutInfo& layout : layouts::registry()) {
    if (layout.id == layouts::LayoutId::linear) continue;
    EXPECT_EQ(layouts::node_cost(layout.id), layout.node_cost);
    EXPECT_EQ(nodes(layout.name, 0), nodes(layout.name, layout.node_cost)) << layout.name;
    EXPECT_LT(nodes(layout.name, 0), nodes(layout.name, layout.node_cost - 1)) << layout.name;
    EXPECT_GT(nodes(layout.name, 0), nodes(layout.name, layout.node_cost + 1)) << layout.name;
  }
  for (const float price : {-1.0f, std::nanf(""), kInfinity}) {
    const auto refused = Accel::build(mesh, {.layout = "wide8", .node_cost = price});
    ASSERT_FALSE(refused) << price;
    EXPECT_NE(refused.error().message.find("node_cost is " + std::to_string(price)), std::string::npos);
  }
}

TEST(Accel, EnvironmentVariableForcesTheInstructionSet) {
  const TriangleMesh mesh = test::icosphere(1);
  for (const std::string& isa : queries::supported_isas()) {
    ASSERT_EQ(0, setenv("BOXWOOD_ISA", isa.c_str(), 1));
    auto accel = Accel::build(mesh);
    ASSERT_TRUE(accel);
    EXPECT_EQ(accel->isa(), isa);
  }
  ASSERT_EQ(0, setenv("BOXWOOD_ISA", "sse9", 1));
  auto accel = Accel::build(mesh);
  ASSERT_FALSE(accel);
  EXPECT_NE(accel.error().message.find("BOXWOOD_ISA"), std::string::npos);
  EXPECT_NE(accel.error().message.find("'sse9'"), std::string::npos);
  ASSERT_EQ(0, unsetenv("BOXWOOD_ISA"));
}

TEST(Accel, BatchesRefuseSpansOfOtherLengths) {
  const TriangleMesh mesh = test::icosphere(1);
  auto accel = Accel::build(mesh);
  ASSERT_TRUE(accel);
  std::vector<Ray> rays(3);
  std::vector<Hit> hits(2);
  std::vector<std::uint8_t> occluded(4);
  std::vector<queries::Counts> counts(1);
  EXPECT_EQ(accel->closest_hits(rays, hits).error().message, "there are 3 rays but room for 2 hits");
  EXPECT_FALSE(accel->any_hits(rays, occluded));
  hits.resize(3);
  occluded.resize(3);
  EXPECT_FALSE(accel->closest_hits_counted(rays, hits, counts));
  EXPECT_FALSE(accel->any_hits_counted(rays, occluded, counts));
  std::vector<Vec3> normals(1);
  EXPECT_FALSE(accel->closest_hits(rays, hits, normals));
  EXPECT_TRUE(accel->closest_hits({}, {}));
}

TEST(Accel, ManyThreadsAtOnce) {
  const TriangleMesh mesh = test::icosphere(4);
  auto accel = Accel::build(mesh);
  ASSERT_TRUE(accel);
  const auto rays = test::rays_from_inside(mesh, {}, 1, test::Aim::random, 5000, 3);
  std::vector<Hit> expected(rays.size());
  ASSERT_TRUE(accel->closest_hits(rays, expected));
  std::vector<int> wrong(8, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = 0; i < rays.size(); ++i)
        wrong[t] += accel->closest_hit(rays[i]).primitive != expected[i].primitive;
    });
  for (auto& thread : threads) thread.join();
  for (int w : wrong) EXPECT_EQ(w, 0);
}

// A chain 20,000 levels deep: the traversal's stack must grow with it, in every layout.
TEST(Accel, VeryDeepTree) {
  constexpr std::uint32_t kCount = 20000;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const float x = static_cast<float>(i);
    mesh.vertices.insert(mesh.vertices.end(), {{x, -1, -1}, {x, 1, -1}, {x, 0, 2}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  tree::BinaryTree tree;
  tree.nodes = AlignedBuffer<tree::Node>(2 * kCount - 1);
  tree.references = AlignedBuffer<std::uint32_t>(kCount);
  tree.primitive_count = kCount;
  // Node 2k (k > 0: the right child) holds triangles k to the end; node 2k + 1 is the leaf of triangle k.
  for (std::uint32_t k = 0; k < kCount; ++k) {
    tree.references[k] = k;
    const Box rest{{static_cast<float>(k), -1, -1}, {static_cast<float>(kCount - 1), 1, 2}};
    const Box own{{static_cast<float>(k), -1, -1}, {static_cast<float>(k), 1, 2}};
    if (k + 1 < kCount) {
      tree.nodes[2 * k] = {rest, 2 * k + 1, 0};
      tree.nodes[2 * k + 1] = {own, k, 1};
    } else {
      tree.nodes[2 * k] = {own, k, 1};
    }
  }
  for (const auto& layout : layouts::registry()) {
    auto accel = Accel::from_tree(mesh, tree, {.layout = layout.name});
    ASSERT_TRUE(accel) << accel.error().message;
    EXPECT_TRUE(layouts::validate(accel->layout(), tree.references.span(), false, mesh));
    EXPECT_EQ(accel->closest_hit({.origin = {-5, 0, 0}, .direction = {1, 0, 0}}).primitive, 0u);
    EXPECT_EQ(accel->closest_hit({.origin = {kCount + 5.0f, 0, 0}, .direction = {-1, 0, 0}}).primitive, kCount - 1);
    EXPECT_EQ(accel->closest_hit({.origin = {700.5f, 0, 0}, .direction = {1, 0, 0}}).primitive, 701u);
    EXPECT_FALSE(accel->any_hit({.origin = {-5, 3, 0}, .direction = {1, 0, 0}}));
  }
}

}  // namespace
}  // namespace boxwood
