#include "mesh/edge_table.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Uses = std::multiset<std::pair<std::uint32_t, bool>>;

std::map<Edge, Uses> expected_edges(const TriangleMesh& mesh, const std::vector<std::uint32_t>& ids,
                                    const std::vector<std::uint8_t>& left_out) {
  std::map<Edge, Uses> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!left_out.empty() && left_out[t]) continue;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (!ids.empty()) a = ids[a], b = ids[b];
      if (a != b) edges[{std::min(a, b), std::max(a, b)}].insert({t, a > b});
    }
  }
  return edges;
}

void expect_table(const mesh::EdgeTable& table, std::size_t vertices, const std::map<Edge, Uses>& expected) {
  ASSERT_EQ(table.vertex_count(), vertices);
  auto next = expected.begin();  // the map is in the order the table must have
  mesh::for_each_edge(table, 0, vertices,
                      [&](std::uint32_t low, std::uint32_t high, std::span<const mesh::EdgeUse> uses) {
                        ASSERT_NE(next, expected.end());
                        EXPECT_EQ(Edge(low, high), next->first);
                        ASSERT_EQ(uses.size(), next->second.size());
                        auto use = next->second.begin();
                        for (const mesh::EdgeUse& found : uses) {
                          EXPECT_EQ(std::pair(found.triangle(), found.reversed()), *use);
                          ++use;
                        }
                        ++next;
                      });
  EXPECT_EQ(next, expected.end());
}

TEST(EdgeTable, AgreesWithAMap) {
  const TriangleMesh cube = test::cube();
  TriangleMesh odd = test::cube();
  odd.triangles.push_back({3, 3, 3});  // no edge
  odd.triangles.push_back({3, 4, 3});  // one edge, twice
  odd.triangles.push_back({0, 5, 1});
  test::with_each_executor([&](Executor& executor) {
    expect_table(mesh::make_edge_table({}, {}, {}, executor), 0, {});
    expect_table(mesh::make_edge_table(cube, {}, {}, executor), 8, expected_edges(cube, {}, {}));
    expect_table(mesh::make_edge_table(odd, {}, {}, executor), 8, expected_edges(odd, {}, {}));
  });
}

TEST(EdgeTable, UsesWeldedIdsAndLeavesTrianglesOut) {
  const TriangleMesh apart = test::exploded(test::wave(120, 90));
  SequentialExecutor sequential;
  const auto ids = mesh::weld(apart, sequential);
  std::vector<std::uint8_t> left_out(apart.triangles.size());
  for (std::size_t i = 0; i < left_out.size(); i += 7) left_out[i] = 1 + i % 2;
  const auto expected = expected_edges(apart, ids, left_out);
  test::with_each_executor([&](Executor& executor) {
    expect_table(mesh::make_edge_table(apart, ids, left_out, executor), apart.vertices.size(), expected);
  });
}

}  // namespace
}  // namespace boxwood
