// Small meshes and rays that several tests (and the leak count in bench/) share.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "boxwood/mesh.h"

namespace boxwood::test {

/// Closed sphere of 20 * 4^levels triangles around `center`; vertices shared.
inline TriangleMesh icosphere(int levels, float radius = 1, Vec3 center = {}) {
  const float phi = 0.5f * (1 + std::sqrt(5.0f));
  std::vector<Vec3> unit = {{-1, phi, 0},  {1, phi, 0},  {-1, -phi, 0}, {1, -phi, 0}, {0, -1, phi},  {0, 1, phi},
                            {0, -1, -phi}, {0, 1, -phi}, {phi, 0, -1},  {phi, 0, 1},  {-phi, 0, -1}, {-phi, 0, 1}};
  for (Vec3& p : unit) p = normalize(p);
  TriangleMesh mesh;
  mesh.name = "icosphere";
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    auto middle = [&](std::uint32_t a, std::uint32_t b) {
      auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(unit.size()));
      if (is_new) unit.push_back(normalize(unit[a] + unit[b]));
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (auto [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3 p : unit) mesh.vertices.push_back(center + radius * p);
  return mesh;
}

/// Uniform number in [0, 1).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  float operator()() { return static_cast<float>(engine_() >> 40) * 0x1p-24f; }
  float between(float a, float b) { return a + (b - a) * (*this)(); }
  Vec3 in_cube() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 p = in_cube();
      if (const float l = dot(p, p); l > 1e-3f && l <= 1) return normalize(p);
    }
  }
  std::size_t index(std::size_t count) { return engine_() % count; }

 private:
  std::mt19937_64 engine_;
};

/// Unconnected triangles of very different sizes in and around the unit cube.
inline TriangleMesh soup(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  mesh.name = "soup";
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 center = random.in_cube();
    const float size = std::exp2(random.between(-8, 0));
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(center + size * random.in_cube());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// A flat n x n grid of squares in the plane y = 0, two triangles each, corners at whole numbers.
inline TriangleMesh grid(std::uint32_t n) {
  TriangleMesh mesh;
  mesh.name = "grid";
  for (std::uint32_t z = 0; z <= n; ++z)
    for (std::uint32_t x = 0; x <= n; ++x) mesh.vertices.push_back({static_cast<float>(x), 0, static_cast<float>(z)});
  for (std::uint32_t z = 0; z < n; ++z)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = z * (n + 1) + x, b = a + n + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  return mesh;
}

enum class Aim { vertices, edges, random };

/// Rays from inside a closed convex mesh around `center`, aimed at its vertices, at points on its edges or anywhere.
/// Each one must hit. Directions are exact differences of floats, not normalised, which aims best.
inline std::vector<Ray> rays_from_inside(const TriangleMesh& mesh, Vec3 center, float radius, Aim aim,
                                         std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = center + 0.5f * radius * random.direction();
    const auto& t = mesh.triangles[random.index(mesh.triangles.size())];
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]];
    switch (aim) {
      case Aim::vertices:
        ray.direction = a - ray.origin;
        break;
      case Aim::edges:
        ray.direction = (a + random() * (b - a)) - ray.origin;
        break;
      case Aim::random:
        ray.direction = random.direction();
        break;
    }
  }
  return rays;
}

}  // namespace boxwood::test
