// Small meshes and accels for the tests of ray sets and pictures.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "boxwood/accel.h"

namespace boxwood::render {

inline Accel build(const TriangleMesh& mesh, std::shared_ptr<Executor> executor = nullptr) {
  AccelOptions options;
  options.executor = std::move(executor);
  auto accel = Accel::build(mesh, options);
  if (!accel) throw std::runtime_error(accel.error().message);
  return std::move(*accel);
}

inline void add_quad(TriangleMesh& mesh, Vec3 corner, Vec3 a, Vec3 b) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {corner, corner + a, corner + a + b, corner + b});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A square of the given half side in the plane z = height, seen from above as counter-clockwise.
inline TriangleMesh square(float half_side, float height = 0) {
  TriangleMesh mesh;
  add_quad(mesh, {-half_side, -half_side, height}, {2 * half_side, 0, 0}, {0, 2 * half_side, 0});
  return mesh;
}

/// A closed convex sphere of 20 * 4^levels triangles whose edges are shared by vertex index.
inline TriangleMesh icosphere(int levels, Vec3 center = {}, float radius = 1) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<std::array<double, 3>> points;
  for (const double one : {-1.0, 1.0})
    for (const double g : {-golden, golden}) {
      points.push_back({0, one, g});
      points.push_back({one, g, 0});
      points.push_back({g, 0, one});
    }
  const auto distance2 = [&](std::size_t i, std::size_t j) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += std::pow(points[i][axis] - points[j][axis], 2);
    return sum;
  };
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t i = 0; i < 12; ++i)
    for (std::uint32_t j = i + 1; j < 12; ++j)
      for (std::uint32_t k = j + 1; k < 12; ++k)
        if (distance2(i, j) < 4.1 && distance2(j, k) < 4.1 && distance2(i, k) < 4.1) faces.push_back({i, j, k});
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(points.size()));
      if (is_new)
        points.push_back({points[i][0] + points[j][0], points[i][1] + points[j][1], points[i][2] + points[j][2]});
      auto& p = points[place->second];
      const double scale = std::sqrt((1 + golden * golden) / (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
      for (double& x : p) x *= scale;
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  TriangleMesh mesh;
  mesh.triangles = std::move(faces);
  const double scale = radius / std::sqrt(1 + golden * golden);
  for (const auto& p : points)
    mesh.vertices.push_back({static_cast<float>(center.x + scale * p[0]), static_cast<float>(center.y + scale * p[1]),
                             static_cast<float>(center.z + scale * p[2])});
  return mesh;
}

inline const View kFromAbove{.eye = {0, 0, 5}, .look_at = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};

}  // namespace boxwood::render
