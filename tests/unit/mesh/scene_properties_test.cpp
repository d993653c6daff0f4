// The property for which each scene is there: what its paper's argument rests on.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

SequentialExecutor sequential;

TriangleMesh make(std::string_view id, std::size_t triangles, Vec3 rotate = {}) {
  Result<mesh::Scene> scene = mesh::make_scene(id, {.triangles = triangles, .rotate = rotate});
  EXPECT_TRUE(scene) << id;
  return scene ? std::move(scene->mesh) : TriangleMesh{};
}

double area(const Triangle& t) {
  return 0.5 * length(t.normal());
}

double longest_edge(const Triangle& t) {
  return std::max({length(t.v1 - t.v0), length(t.v2 - t.v1), length(t.v0 - t.v2)});
}

/// Longest edge over the height upon it; 1.15 for an equilateral triangle.
double aspect(const Triangle& t) {
  return longest_edge(t) * longest_edge(t) / (2 * area(t));
}

TEST(Organic, IsClosedManifoldAndInOnePiece) {
  for (const std::size_t target : {12u, 13u, 50u, 100u, 1'000u, 5'000u, 200'000u}) {
    const mesh::Report report = mesh::inspect(make("organic", target), sequential);
    EXPECT_TRUE(report.closed) << target;
    EXPECT_TRUE(report.manifold) << target;
    EXPECT_EQ(report.components, 1u) << target;
    // Euler's formula for a sphere: V - E + F = 2 with E = 3 F / 2; also says that no vertex is there twice.
    EXPECT_EQ(report.vertices, report.triangles / 2 + 2) << target;
  }
}

TEST(Organic, FacesOutward) {
  const TriangleMesh mesh = make("organic", 20'000);
  double volume = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.view().triangle(i);
    volume += dot(t.v0, cross(t.v1, t.v2)) / 6.0;
  }
  EXPECT_GT(volume, 1);
}

TEST(Organic, HasTrianglesOfLikeSize) {
  const TriangleMesh mesh = make("organic", 100'000);
  std::vector<double> edges, areas;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    edges.push_back(longest_edge(mesh.view().triangle(i)));
    areas.push_back(area(mesh.view().triangle(i)));
  }
  std::sort(edges.begin(), edges.end()), std::sort(areas.begin(), areas.end());
  EXPECT_LT(edges.back(), 5 * edges[edges.size() / 2]);
  EXPECT_GT(edges[edges.size() / 100], 0.3 * edges[edges.size() / 2]);
  EXPECT_GT(areas[areas.size() / 100], 0.15 * areas[areas.size() / 2]);
}

TEST(Atrium, HasMostOfItsAreaInFewAxisAlignedTriangles) {
  for (const std::size_t target : {20'000u, 250'000u}) {
    const TriangleMesh mesh = make("atrium", target);
    std::vector<std::pair<double, bool>> areas;
    double total = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle t = mesh.view().triangle(i);
      const Vec3 extent = t.bounds().extent();
      areas.emplace_back(area(t), extent.x == 0 || extent.y == 0 || extent.z == 0);
      total += area(t);
    }
    std::sort(areas.rbegin(), areas.rend());
    double largest = 0;
    for (std::size_t i = 0; i < areas.size() / 100; ++i) largest += areas[i].first;
    EXPECT_GT(largest, 0.6 * total) << target;
    for (std::size_t i = 0; i < 20; ++i)
      EXPECT_TRUE(areas[i].second) << "large triangle " << i << " is not axis-aligned";
    EXPECT_GT(areas.front().first, 10'000 * areas[areas.size() / 2].first) << target;
  }
}

TEST(Atrium, RotationFillsTheBoxesOfLargeTriangles) {
  const auto box_volume = [](const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Vec3 e = mesh.view().triangle(i).bounds().extent();
      sum += double(e.x) * e.y * e.z;
    }
    return sum;
  };
  EXPECT_GT(box_volume(make("atrium", 50'000, {45, 45, 0})), 20 * box_volume(make("atrium", 50'000)));
}

TEST(Foliage, IsMadeOfSeparateLeavesOfTwoToFourTriangles) {
  for (const std::size_t target : {100u, 5'000u, 100'000u}) {
    const TriangleMesh mesh = make("foliage", target);
    const mesh::Report report = mesh::inspect(mesh, sequential);
    EXPECT_GE(report.components, target * 9 / 10 / 4) << target;
    // By shared indices: each leaf's triangles share vertices with each other only.
    const auto ids = mesh::weld(mesh, sequential);
    std::vector<std::uint32_t> parent(ids.begin(), ids.end());
    const auto root = [&](std::uint32_t v) {
      while (parent[v] != v) v = parent[v] = parent[parent[v]];
      return v;
    };
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t v : {t[1], t[2]}) parent[root(ids[v])] = root(ids[t[0]]);
    std::map<std::uint32_t, std::size_t> sizes;
    for (const auto& t : mesh.triangles) ++sizes[root(ids[t[0]])];
    std::size_t in_leaves = 0;
    for (const auto& [id, size] : sizes) in_leaves += size >= 2 && size <= 4 ? size : 0;
    EXPECT_GE(double(in_leaves), 0.94 * double(mesh.triangles.size())) << target;
  }
}

TEST(Spaceship, HasManyLongThinDiagonalTrianglesAmongSmallOnes) {
  const TriangleMesh mesh = make("spaceship", 200'000);
  const float diagonal = length(mesh::bounds(mesh, sequential).extent());
  std::size_t thin = 0, small = 0;
  double box_area = 0, total_area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.view().triangle(i);
    const Vec3 e = t.bounds().extent();
    const bool diagonal_box = std::min({e.x, e.y, e.z}) > 0.05 * std::max({e.x, e.y, e.z});
    if (aspect(t) > 50 && longest_edge(t) > 0.08 * diagonal && diagonal_box) {
      ++thin;
      box_area += t.bounds().half_area();
      total_area += area(t);
    }
    small += longest_edge(t) < 0.02 * diagonal;
  }
  EXPECT_GT(double(thin), 0.05 * double(mesh.triangles.size()));
  EXPECT_GT(double(small), 0.5 * double(mesh.triangles.size()));
  EXPECT_GT(box_area, 100 * total_area) << "boxes of the long triangles must be mostly empty";
}

TEST(City, HasBuildingsOfVeryDifferentSizesOnLargeGround) {
  const TriangleMesh mesh = make("city", 100'000);
  const Box box = mesh::bounds(mesh, sequential);
  double largest = 0, total = 0;
  std::vector<double> heights;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.view().triangle(i);
    largest = std::max(largest, area(t)), total += area(t);
    if (t.normal().y == 0) heights.push_back(t.bounds().extent().y);
  }
  EXPECT_GT(largest, 0.45 * double(box.extent().x) * box.extent().z) << "the ground";
  std::sort(heights.begin(), heights.end());
  EXPECT_GT(heights.back(), 25 * heights[heights.size() / 2]);
  EXPECT_GT(box.extent().y, 80);
  EXPECT_GT(mesh::inspect(mesh, sequential).components, 2000u);
}

TEST(Shells, BoxesOfANestAreCentredOnExactlyOnePoint) {
  for (const std::size_t target : {12u, 100u, 5'000u, 200'000u}) {
    const TriangleMesh mesh = make("shells", target);
    std::map<std::tuple<float, float, float>, std::vector<Box>> nests;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Box box = mesh.view().triangle(i).bounds();
      const Vec3 twice = box.lower + box.upper;
      nests[{twice.x, twice.y, twice.z}].push_back(box);
    }
    EXPECT_LE(nests.size(), target / 96 + 1) << target;
    std::vector<Box> hulls;
    for (auto& [center, boxes] : nests) {
      Box hull;
      for (const Box& box : boxes) hull.grow(box);
      hulls.push_back(hull);
      const auto smallest = std::min_element(boxes.begin(), boxes.end(),
                                             [](const Box& a, const Box& b) { return a.half_area() < b.half_area(); });
      if (boxes.size() >= 96) {
        EXPECT_LT(smallest->half_area(), 0.02f * hull.half_area());
      }
      EXPECT_TRUE(hull.contains(*smallest));
    }
    if (target > 5000) continue;
    for (std::size_t i = 0; i < hulls.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Box overlap{maximum(hulls[i].lower, hulls[j].lower), minimum(hulls[i].upper, hulls[j].upper)};
        EXPECT_TRUE(overlap.is_empty()) << "nests " << i << " and " << j << " meet";
      }
    }
  }
}

TEST(Soup, SharesNothingAndVariesWidelyInSize) {
  const TriangleMesh mesh = make("soup", 50'000);
  EXPECT_EQ(mesh::inspect(mesh, sequential).components, 50'000u);
  std::vector<double> sizes;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) sizes.push_back(longest_edge(mesh.view().triangle(i)));
  std::sort(sizes.begin(), sizes.end());
  EXPECT_GT(sizes[sizes.size() * 95 / 100], 100 * sizes[sizes.size() * 5 / 100]);
}

}  // namespace
}  // namespace boxwood
