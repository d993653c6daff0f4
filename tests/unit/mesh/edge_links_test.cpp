// Links between triangles against all pairs of triangles.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

using mesh::EdgeLink;
using mesh::Weld;

/// The area to 22 bits after the first.
double rounded_area(Vec3 p, Vec3 q) {
  const double x = std::fabs(double(p.x) - q.x), y = std::fabs(double(p.y) - q.y), z = std::fabs(double(p.z) - q.z);
  int exponent = 0;
  const double mantissa = std::frexp(x * y + y * z + z * x, &exponent);
  return std::ldexp(std::floor(std::ldexp(mantissa, 23)), exponent);
}

/// By definition: the uses of each edge, by triangle.
std::vector<EdgeLink> all_links(const TriangleMesh& mesh, bool by_position) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> uses;
  const auto id = [&](std::uint32_t v) {
    if (!by_position) return v;
    for (std::uint32_t first = 0; first < v; ++first)
      if (mesh.vertices[first] == mesh.vertices[v]) return first;
    return v;
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh::is_usable(mesh.view().triangle(t))) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t a = id(mesh.triangles[t][side]), b = id(mesh.triangles[t][(side + 1) % 3]);
      if (a != b) uses[{std::min(a, b), std::max(a, b)}].push_back(std::uint32_t(t));
    }
  }
  std::vector<std::tuple<double, EdgeLink>> ranked;
  for (const auto& [edge, triangles] : uses) {
    const double area = rounded_area(mesh.vertices[edge.first], mesh.vertices[edge.second]);
    for (std::size_t i = 1; i < triangles.size(); ++i)
      if (triangles[i - 1] != triangles[i]) ranked.emplace_back(area, EdgeLink{triangles[i - 1], triangles[i]});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return std::get<0>(a) > std::get<0>(b); });
  std::vector<EdgeLink> links;
  for (const auto& [area, link] : ranked) links.push_back(link);
  return links;
}

void expect_all_links(const TriangleMesh& mesh) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  ThreadExecutor threads(8);
  SequentialExecutor sequential;
  for (const bool by_position : {true, false})
    for (Executor* executor : {static_cast<Executor*>(&sequential), static_cast<Executor*>(&threads)}) {
      const auto links = mesh::edge_links(mesh, by_position ? Weld::position : Weld::index, *executor);
      EXPECT_EQ(std::vector<EdgeLink>(links.begin(), links.end()), all_links(mesh, by_position));
    }
}

TEST(EdgeLinks, CubeByPositionAndByIndex) {
  expect_all_links(test::cube());
  EXPECT_EQ(all_links(test::cube(), true).size(), 18u);  // each edge of a closed mesh once
  expect_all_links(test::exploded(test::cube()));
  EXPECT_EQ(all_links(test::exploded(test::cube()), false).size(), 0u);
}

TEST(EdgeLinks, DiagonalsOfACubeComeFirst) {
  SequentialExecutor executor;
  const auto links = mesh::edge_links(test::cube(), Weld::position, executor);
  ASSERT_GE(links.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(links[i].a / 2, links[i].b / 2) << "the halves of a side";
}

TEST(EdgeLinks, Wave) {
  TriangleMesh mesh = test::wave(12, 9);
  expect_all_links(mesh);
}

TEST(EdgeLinks, ManyTrianglesOnOneEdge) {
  TriangleMesh book = test::make_mesh({{0, 0, 0}, {0, 1, 0}}, {});
  for (std::uint32_t page = 0; page < 30; ++page) {
    book.vertices.push_back({float(page + 1), 0.5f, float(page * page % 7)});
    book.triangles.push_back({page % 2, 1 - page % 2, page + 2});
  }
  expect_all_links(book);
  EXPECT_EQ(all_links(book, true).size(), 29u);
}

TEST(EdgeLinks, DegenerateAndUnusableTrianglesAreNoNeighbours) {
  const float nan = std::nanf("");
  expect_all_links(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {1, 1, 0}, {1, 0, 0}},
                                   {{0, 1, 2}, {1, 0, 3}, {0, 0, 0}, {1, 1, 1}, {1, 4, 2}, {0, 1, 0}, {1, 5, 4}}));
}

TEST(EdgeLinks, NothingAndOneTriangle) {
  expect_all_links({});
  expect_all_links(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
}

}  // namespace
}  // namespace boxwood
