// Neighbours over edges against all pairs of sides.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <random>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

using mesh::EdgeNeighbours;
using mesh::kNoNeighbour;
using mesh::Weld;

/// By definition: the uses of each edge in order of triangles and sides, two by two.
std::vector<EdgeNeighbours> all_neighbours(const TriangleMesh& mesh, bool by_position) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, std::size_t>>> uses;
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
      if (a != b) uses[{std::min(a, b), std::max(a, b)}].push_back({std::uint32_t(t), side});
    }
  }
  std::vector<EdgeNeighbours> neighbours(mesh.triangles.size(), {kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for (const auto& [edge, sides] : uses)
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const auto [a, side_of_a] = sides[i - 1];
      const auto [b, side_of_b] = sides[i];
      if (a == b) continue;
      neighbours[a][side_of_a] = b;
      neighbours[b][side_of_b] = a;
      ++i;
    }
  return neighbours;
}

/// Two corners of one, at different vertices, are corners of the other: asked of all pairs of triangles.
void expect_shared_edges(const TriangleMesh& mesh, bool by_position) {
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    return by_position ? mesh.vertices[a] == mesh.vertices[b] : a == b;
  };
  for (std::size_t a = 0; a < mesh.triangles.size(); ++a)
    for (std::size_t b = 0; b < mesh.triangles.size(); ++b) {
      bool share = false;
      for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t j = 0; j < 9; ++j)
          share |= a != b && same(mesh.triangles[a][i / 3], mesh.triangles[b][j / 3]) &&
                   same(mesh.triangles[a][i % 3], mesh.triangles[b][j % 3]) &&
                   !same(mesh.triangles[a][i / 3], mesh.triangles[a][i % 3]);
      ASSERT_EQ(mesh::share_edge(mesh, a, b, by_position ? Weld::position : Weld::index), share) << a << ", " << b;
    }
}

void expect_all_neighbours(const TriangleMesh& mesh) {
  if (mesh.triangles.size() < 300)
    for (const bool by_position : {true, false}) expect_shared_edges(mesh, by_position);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  ThreadExecutor threads(8);
  SequentialExecutor sequential;
  for (const bool by_position : {true, false})
    for (Executor* executor : {static_cast<Executor*>(&sequential), static_cast<Executor*>(&threads)}) {
      const auto found = mesh::edge_neighbours(mesh, by_position ? Weld::position : Weld::index, *executor);
      EXPECT_EQ(std::vector<EdgeNeighbours>(found.begin(), found.end()), all_neighbours(mesh, by_position));
    }
}

TEST(EdgeNeighbours, CubeByPositionAndByIndex) {
  expect_all_neighbours(test::cube());
  expect_all_neighbours(test::exploded(test::cube()));
  SequentialExecutor executor;
  for (const EdgeNeighbours& three : mesh::edge_neighbours(test::exploded(test::cube()), Weld::position, executor))
    EXPECT_EQ(std::count(three.begin(), three.end(), kNoNeighbour), 0) << "a closed mesh";
  for (const EdgeNeighbours& three : mesh::edge_neighbours(test::exploded(test::cube()), Weld::index, executor))
    EXPECT_EQ(std::count(three.begin(), three.end(), kNoNeighbour), 3);
}

TEST(EdgeNeighbours, WaveAndAVertexOfManySides) {
  expect_all_neighbours(test::wave(12, 9));
  TriangleMesh fan = test::make_mesh({{0, 0, 0}}, {});
  for (std::uint32_t i = 0; i < 60; ++i)
    fan.vertices.push_back({std::cos(0.1f * float(i)), std::sin(0.1f * float(i)), 0});
  for (std::uint32_t i = 0; i < 59; ++i)
    fan.triangles.push_back({i % 2 ? i + 1 : 0, i % 2 ? i + 2 : i + 1, i % 2 ? 0 : i + 2});
  expect_all_neighbours(fan);
}

TEST(EdgeNeighbours, ManyTrianglesOnOneEdge) {
  TriangleMesh book = test::make_mesh({{0, 0, 0}, {0, 1, 0}}, {});
  for (std::uint32_t page = 0; page < 31; ++page) {
    book.vertices.push_back({float(page + 1), 0.5f, float(page * page % 7)});
    book.triangles.push_back({page % 2, 1 - page % 2, page + 2});
  }
  expect_all_neighbours(book);
}

TEST(EdgeNeighbours, DegenerateAndUnusableTrianglesHaveNone) {
  const float nan = std::nanf("");
  expect_all_neighbours(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {1, 1, 0}, {1, 0, 0}},
                                        {{0, 1, 2}, {1, 0, 3}, {0, 0, 0}, {1, 1, 1}, {1, 4, 2}, {0, 1, 0}, {1, 5, 4}}));
}

TEST(EdgeNeighbours, SeveralPartsFindWhatOneFinds) {
  TriangleMesh mesh = test::wave(150, 160);                                     // three chunks of triangles
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(4));  // partners in other parts
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  const auto neighbours = [&](int threads) {
    ThreadExecutor executor(threads);
    const auto found = mesh::edge_neighbours(mesh, Weld::index, executor);
    return std::vector<EdgeNeighbours>(found.begin(), found.end());
  };
  const std::vector<EdgeNeighbours> all = all_neighbours(mesh, false);
  for (const int threads : {1, 2, 3, 8}) EXPECT_EQ(neighbours(threads), all) << threads << " threads";
}

TEST(EdgeNeighbours, NothingAndOneTriangle) {
  expect_all_neighbours({});
  expect_all_neighbours(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
}

}  // namespace
}  // namespace boxwood
