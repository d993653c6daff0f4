// Pairing of triangles in leaves, and what wide8-quads answers, held against wide8 bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "boxwood/accel.h"
#include "boxwood/optimizers.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood::layouts {
namespace {

SequentialExecutor executor;

/// A tree that is one leaf over all triangles of a small mesh.
Layout one_leaf(const TriangleMesh& mesh) {
  tree::WideTree tree;
  tree.width = 8;
  tree.bounds = Box{};
  for (const Vec3& v : mesh.vertices) tree.bounds.grow(v);
  tree.references.resize(mesh.triangles.size());
  std::iota(tree.references.begin(), tree.references.end(), 0u);
  tree.children = {{tree.bounds, 0, std::uint32_t(mesh.triangles.size())}};
  tree.first_child = {0, 1};
  tree.max_stack = 1;
  auto layout = encode_wide_quads(tree, mesh, executor);
  EXPECT_TRUE(layout) << layout.error().message;
  const Status valid = validate(*layout, tree.references, false, mesh);
  EXPECT_TRUE(valid) << valid.error().message;
  return std::move(*layout);
}

std::span<const QuadBlock> blocks_of(const Layout& layout) {
  return {reinterpret_cast<const QuadBlock*>(layout.triangles.data()), layout.triangles.size() / sizeof(QuadBlock)};
}

/// Ids of each quad of one leaf; kInvalidPrimitive for the second of a lone triangle.
std::vector<std::array<std::uint32_t, 2>> quads_of(const TriangleMesh& mesh) {
  const Layout layout = one_leaf(mesh);
  std::vector<std::array<std::uint32_t, 2>> quads;
  for (const QuadBlock& block : blocks_of(layout))
    for (int lane = 0; lane < 4; ++lane)
      if (block.primitive[lane] != kInvalidPrimitive) {
        const std::uint32_t second = block.primitive[lane + 4];
        quads.push_back(
            {block.primitive[lane] & kQuadIdMask, second == kInvalidPrimitive ? second : second & kQuadIdMask});
      }
  std::vector<std::uint32_t> references(mesh.triangles.size());
  std::iota(references.begin(), references.end(), 0u);
  EXPECT_EQ(quad_blocks(references, mesh), (quads.size() + 3) / 4);
  return quads;
}

using Quads = std::vector<std::array<std::uint32_t, 2>>;

// All ways to write down two triangles that share an edge: corners turned, windings alike and opposed.
TEST(Quads, EveryOrderOfCornersIsPairedAndKept) {
  const std::array<std::uint32_t, 3> a[] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (const auto& first : a)
    for (auto second : a) {
      for (std::uint32_t& corner : second) corner = corner == 0 ? 3 : corner;
      TriangleMesh mesh;
      mesh.vertices = {{0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0.25f}, {1, 1, -1}};
      mesh.triangles = {first, second};
      EXPECT_EQ(quads_of(mesh), (Quads{{0, 1}}));
    }
}

TEST(Quads, EdgesAreSharedByPositionNotByIndex) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(quads_of(mesh), (Quads{{0, 1}}));
  mesh.vertices[3].y = -0.0f;  // equal, but not the same bits: the corner could not be given back
  EXPECT_EQ(quads_of(mesh).size(), 2u);
  mesh.vertices[3].y = 1e-30f;
  EXPECT_EQ(quads_of(mesh).size(), 2u);
}

// Triangles in a row 0-1-2-3: pairing 1 with 2 would leave two alone.
TEST(Quads, ARowIsPairedFromItsEnds) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 6; ++i) mesh.vertices.push_back({float(i / 2), float(i % 2), 0});
  mesh.triangles = {{2, 1, 3}, {2, 3, 4}, {0, 1, 2}, {4, 3, 5}};
  EXPECT_EQ(quads_of(mesh), (Quads{{0, 2}, {1, 3}}));
}

TEST(Quads, LoneDegenerateAndRepeatedTriangles) {
  TriangleMesh mesh = test::soup(7, 1);
  EXPECT_EQ(quads_of(mesh).size(), 7u) << "nothing shared";
  mesh.triangles.resize(1);
  EXPECT_EQ(quads_of(mesh), (Quads{{0, kInvalidPrimitive}}));
  mesh.triangles.assign(5, {0, 1, 2});
  EXPECT_EQ(quads_of(mesh).size(), 3u) << "copies share every edge";
  mesh.triangles = {{0, 0, 0}, {0, 0, 1}, {1, 1, 1}, {2, 2, 2}};
  EXPECT_EQ(quads_of(mesh), (Quads{{0, 1}, {2, kInvalidPrimitive}, {3, kInvalidPrimitive}}));
}

TEST(Quads, EdgesOfManyTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}};
  for (std::uint32_t i = 0; i < 9; ++i) {
    mesh.vertices.push_back({std::cos(0.6f * float(i)), std::sin(0.6f * float(i)), 0});
    mesh.triangles.push_back({0, 1, 2 + i});
  }
  EXPECT_EQ(quads_of(mesh).size(), 5u) << "a fan about one edge: all but the last are paired";
}

TEST(Quads, FullLeafOfAGridFillsItsBlocks) {
  const TriangleMesh mesh = test::grid(4);
  ASSERT_EQ(mesh.triangles.size(), 32u);
  EXPECT_EQ(quads_of(mesh).size(), 16u);
}

TEST(Quads, LeavesArePricedByTheirQuads) {
  const auto ratio = [](const TriangleMesh& mesh) {
    const auto quads = Accel::build(mesh, {.layout = "wide8-quads", .node_cost = 1.5f}),
               wide8 = Accel::build(mesh, {.layout = "wide8", .node_cost = 1.5f});
    EXPECT_TRUE(quads && wide8);
    return double(quads->layout().bytes()) / double(wide8->layout().bytes());
  };
  EXPECT_LT(ratio(test::grid(40)), 0.8) << "everything has a partner";
  EXPECT_LT(ratio(test::soup(3200, 2)), 1.4) << "nothing has one: a block of four is 224 bytes instead of 160";
}

/// Rays from inside and outside at vertices, at points of edges, inside triangles and anywhere.
std::vector<Ray> rays_at(const TriangleMesh& mesh, const Box& box, std::uint64_t seed) {
  test::Random random(seed);
  const float size = length(box.upper - box.lower);
  std::vector<Ray> rays(test::effort(4000, 16));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& t = mesh.triangles[random.index(mesh.triangles.size())];
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const float u = random(), v = random();
    const Vec3 targets[] = {a, a + u * (b - a), a + u * (b - a) + v * (1 - u) * (c - a), box.center()};
    rays[i].origin = box.center() + size * random() * random.direction();
    rays[i].direction = i % 4 == 3 ? random.direction() : targets[i % 4] - rays[i].origin;
    if (i % 7 == 0) rays[i].direction[int(i % 3)] = 0;
    if (i % 11 == 0) rays[i].tmin = 0.2f;
    if (i % 13 == 0) rays[i].tmax = 0.9f;
  }
  return rays;
}

std::vector<TriangleMesh> meshes() {
  std::vector<TriangleMesh> all{test::icosphere(3), test::icosphere(2, 1e-15f), test::icosphere(2, 1e12f),
                                test::grid(9), test::soup(300, 4)};
  TriangleMesh twice = test::grid(6);  // every triangle again, wound the other way
  const auto once = twice.triangles;
  for (const auto& t : once) twice.triangles.push_back({t[1], t[0], t[2]});
  twice.triangles.push_back({0, 0, 3});
  TriangleMesh shuffled = test::icosphere(3);  // corners in any order, windings mixed
  test::Random random(9);
  for (auto& t : shuffled.triangles) {
    std::rotate(t.begin(), t.begin() + std::ptrdiff_t(random.index(3)), t.end());
    if (random() < 0.3f) std::swap(t[0], t[1]);
  }
  TriangleMesh fans = test::icosphere(1);  // edges with many triangles
  for (std::uint32_t i = 2; i < 30; ++i) fans.triangles.push_back({0, 1, i});
  all.insert(all.end(), {twice, shuffled, fans});
  return all;
}

TEST(Quads, AnswersAreThoseOfWide8) {
  for (const TriangleMesh& mesh : meshes()) {
    for (const char* builder : {"sweep-sah", "equal-counts"}) {
      const auto make = [&](const char* layout, const std::string& isa) {
        auto accel = Accel::build(mesh, {.build = {.builder = builder}, .layout = layout, .isa = isa});
        EXPECT_TRUE(accel) << accel.error().message;
        return std::move(*accel);
      };
      const Accel wide8 = make("wide8", {});
      const auto rays = rays_at(mesh, wide8.bounds(), 17);
      std::vector<Hit> expected(rays.size()), got(rays.size());
      std::vector<Vec3> expected_normals(rays.size()), normals(rays.size());
      std::vector<std::uint8_t> expected_any(rays.size()), any(rays.size());
      for (auto mode : {queries::Mode::robust, queries::Mode::fast}) {
        // The fast test's products underflow there, and its answers depend on which boxes were opened in any layout.
        if (mode == queries::Mode::fast && length(wide8.bounds().upper) < 1e-10f) continue;
        for (const auto& isa : queries::supported_isas()) {
          const Accel quads = make("wide8-quads", isa);
          ASSERT_TRUE(wide8.closest_hits(rays, expected, expected_normals, mode));
          ASSERT_TRUE(wide8.any_hits(rays, expected_any, mode));
          ASSERT_TRUE(quads.closest_hits(rays, got, normals, mode));
          ASSERT_TRUE(quads.any_hits(rays, any, mode));
          const std::string where = mesh.name + " " + builder + " " + isa + " " + queries::name(mode);
          EXPECT_EQ(0, std::memcmp(got.data(), expected.data(), got.size() * sizeof(Hit))) << where;
          EXPECT_TRUE(normals == expected_normals) << where;
          EXPECT_TRUE(any == expected_any) << where;
        }
      }
    }
  }
}

// A primitive is one triangle tested: a ray that meets the one leaf tests all its triangles, and no unused place.
TEST(Quads, CountsAreTriangles) {
  TriangleMesh mesh = test::grid(2);
  mesh.triangles.pop_back();
  for (const char* layout : {"wide8", "wide8-quads"})
    for (const auto& isa : queries::supported_isas()) {
      auto accel = Accel::build(mesh, {.layout = layout, .isa = isa});
      ASSERT_TRUE(accel);
      const Ray ray{{0.3f, 1, 0.3f}, 0, {0, -1, 0}, kInfinity};
      Hit hit;
      queries::Counts counts;
      ASSERT_TRUE(accel->closest_hits_counted({&ray, 1}, {&hit, 1}, {&counts, 1}));
      EXPECT_TRUE(hit);
      EXPECT_EQ(counts.leaves, 1u) << layout;
      EXPECT_EQ(counts.primitives, 7u) << layout << " " << isa;
    }
}

TEST(Quads, ATreeOfAnotherMeshIsRefused) {
  const TriangleMesh mesh = test::grid(8);
  auto references = refs::make_references(mesh, executor);
  ASSERT_TRUE(references);
  auto tree = builders::build(std::move(*references), {}, {executor});
  ASSERT_TRUE(tree);
  TriangleMesh shorter = mesh;
  shorter.triangles.resize(50);
  const auto accel = Accel::from_tree(shorter, *tree, {.layout = "wide8-quads"});
  ASSERT_FALSE(accel);
  EXPECT_EQ(accel.error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace boxwood::layouts
