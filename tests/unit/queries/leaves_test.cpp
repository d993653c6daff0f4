// Leaves of one block to eight, even and odd, full and not: blocks are tested one by one, in pairs or in flight, and
// the answers are those of testing triangle after triangle, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "boxwood/accel.h"
#include "support/effort.h"
#include "support/meshes.h"

namespace boxwood {
namespace {

using queries::Mode;
using queries::Traversal;

/// The most blocks of a leaf.
template <int W>
std::uint32_t largest_leaf(const layouts::Layout& layout) {
  std::uint32_t largest = 0;
  const auto* const nodes = reinterpret_cast<const layouts::WideNode<W>*>(layout.nodes.data());
  for (std::size_t n = 0; n < layout.node_count; ++n)
    for (const std::uint32_t word : nodes[n].child)
      if (word & layouts::kLeafBit) largest = std::max(largest, layouts::leaf_blocks(word));
  return largest;
}

std::uint32_t largest_leaf(const layouts::Layout& layout) {
  if (layout.id == layouts::LayoutId::wide4) return largest_leaf<4>(layout);
  return layout.id == layouts::LayoutId::wide16 ? largest_leaf<16>(layout) : largest_leaf<8>(layout);
}

/// Towards the mesh; each third ray starts on a triangle, and each fifth ends at one.
std::vector<Ray> rays_at(const MeshView& mesh, std::size_t count) {
  test::Random random(5);
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle from = mesh.triangle(random.index(mesh.triangle_count)),
                   to = mesh.triangle(random.index(mesh.triangle_count));
    rays[i].origin = i % 3 == 0 ? 0.25f * from.v0 + 0.25f * from.v1 + 0.5f * from.v2 : 2.0f * random.in_cube();
    rays[i].direction = 0.25f * to.v0 + 0.5f * to.v1 + 0.25f * to.v2 - rays[i].origin;
    if (i % 5 == 0) rays[i].tmax = 1;
    if (i % 7 == 0) rays[i].tmin = 0.1f;
  }
  return rays;
}

TEST(Leaves, OfEveryNumberOfBlocks) {
  const TriangleMesh mesh = test::soup(1237, 3);
  const auto rays = rays_at(mesh, test::effort(1500, 10));
  for (const Mode mode : {Mode::robust, Mode::fast}) {
    const auto reference = Accel::build(mesh, {.layout = "linear", .isa = "scalar"});
    ASSERT_TRUE(reference);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    ASSERT_TRUE(reference->closest_hits(rays, expected, {}, mode));
    for (int blocks = 1; blocks <= 8; ++blocks)
      for (const auto& layout : layouts::registry()) {
        if (layout.id == layouts::LayoutId::linear) continue;
        for (const std::string& isa : queries::supported_isas()) {
          // Nodes so dear that leaves become as large as they may.
          AccelOptions options{.layout = layout.name, .isa = isa};
          options.node_cost = 1000;
          options.max_leaf_blocks = blocks;
          const auto accel = Accel::build(mesh, options);
          ASSERT_TRUE(accel) << accel.error().message;
          if (layout.id != layouts::LayoutId::wide8_quads) {
            ASSERT_EQ(largest_leaf(accel->layout()), std::uint32_t(blocks)) << layout.name;
          }
          for (const Traversal traversal : {Traversal::single, Traversal::interleaved, Traversal::coherent}) {
            if (traversal != Traversal::single && layout.id == layouts::LayoutId::wide4) continue;
            const std::string where = std::string(layout.name) + " " + isa + " " + queries::name(mode) + " " +
                                      queries::name(traversal) + " " + std::to_string(blocks);
            ASSERT_TRUE(accel->closest_hits(rays, hits, {}, mode, {.traversal = traversal})) << where;
            EXPECT_EQ(0, std::memcmp(hits.data(), expected.data(), hits.size() * sizeof(Hit))) << where;
            ASSERT_TRUE(accel->any_hits(rays, occluded, mode, {.traversal = traversal})) << where;
            for (std::size_t i = 0; i < rays.size(); ++i)
              ASSERT_EQ(occluded[i] != 0, expected[i].is_hit()) << where << " ray " << i;
          }
        }
      }
  }
}

}  // namespace
}  // namespace boxwood
