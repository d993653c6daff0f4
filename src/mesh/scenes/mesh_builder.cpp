#include "mesh/scenes/mesh_builder.h"

#include <algorithm>
#include <cmath>

namespace boxwood::mesh::procedural {

Frame frame_along(Vec3 axis) {
  Frame frame;
  frame.y = normalize(axis);
  const Vec3 other = std::fabs(frame.y.x) > 0.9f ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  frame.z = normalize(cross(other, frame.y));
  frame.x = cross(frame.y, frame.z);
  return frame;
}

std::vector<ProfilePoint> smooth_profile(std::span<const ProfilePoint> points, int count) {
  std::vector<ProfilePoint> curve;
  const int last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < count; ++i) {
    const float s = static_cast<float>(i) * static_cast<float>(last) / static_cast<float>(count - 1);
    const int k = std::min(static_cast<int>(s), last - 1);
    const float t = s - static_cast<float>(k);
    const ProfilePoint p0 = points[std::max(k - 1, 0)], p1 = points[k], p2 = points[k + 1],
                       p3 = points[std::min(k + 2, last)];
    const auto blend = [t](float a, float b, float c, float d) {
      return b + 0.5f * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
    };
    curve.push_back({std::max(0.0f, blend(p0.radius, p1.radius, p2.radius, p3.radius)),
                     blend(p0.height, p1.height, p2.height, p3.height)});
  }
  curve.front() = points.front(), curve.back() = points.back();
  return curve;
}

void MeshBuilder::reserve(std::size_t vertices, std::size_t triangles) {
  if (!building_) return;
  mesh_.vertices.reserve(vertices);
  mesh_.triangles.reserve(triangles);
}

void MeshBuilder::quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const std::uint32_t first = vertex(a);
  vertex(b), vertex(c), vertex(d);
  triangle(first, first + 1, first + 2);
  triangle(first, first + 2, first + 3);
}

void MeshBuilder::box_faces(std::uint32_t v, int first_face) {
  static constexpr std::uint8_t kFaces[6][4] = {{0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1},
                                                {4, 5, 7, 6}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int face = first_face; face < 6; ++face) {
    const auto* f = kFaces[face];
    triangle(v + f[0], v + f[1], v + f[2]);
    triangle(v + f[0], v + f[2], v + f[3]);
  }
}

void MeshBuilder::box(const Box& box, bool bottom) {
  const std::uint32_t v = next_;
  for (int i = 0; i < 8; ++i)
    vertex({i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y, i & 4 ? box.upper.z : box.lower.z});
  box_faces(v, bottom ? 0 : 1);
}

void MeshBuilder::bar(Vec3 a, Vec3 b, float half_x, float half_z) {
  const Frame frame = frame_along(b - a);
  const std::uint32_t v = next_;
  for (int i = 0; i < 8; ++i)
    vertex((i & 2 ? b : a) + (i & 1 ? half_x : -half_x) * frame.x + (i & 4 ? half_z : -half_z) * frame.z);
  box_faces(v, 0);
}

void MeshBuilder::revolve(Vec3 base, const Frame& frame, std::span<const ProfilePoint> profile, int segments) {
  std::uint32_t below = 0;
  bool below_is_point = false;
  for (std::size_t row = 0; row < profile.size(); ++row) {
    const bool is_point = profile[row].radius == 0;
    const Vec3 middle = base + profile[row].height * frame.y;
    const std::uint32_t ring = next_;
    if (is_point) {
      vertex(middle);
    } else if (!building_) {
      next_ += static_cast<std::uint32_t>(segments);
    } else {
      for (int i = 0; i < segments; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(segments);
        vertex(middle + profile[row].radius * (std::cos(angle) * frame.x - std::sin(angle) * frame.z));
      }
    }
    if (row > 0 && !building_) {
      count_ += static_cast<std::size_t>(segments) * (!is_point + !below_is_point);
    } else if (row > 0) {
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
        const std::uint32_t next = i + 1 == static_cast<std::uint32_t>(segments) ? 0 : i + 1;
        if (!below_is_point) triangle(below + i, below + next, is_point ? ring : ring + next);
        if (!is_point) triangle(below_is_point ? below : below + i, ring + next, ring + i);
      }
    }
    below = ring, below_is_point = is_point;
  }
}

void MeshBuilder::tube(Vec3 a, Vec3 b, float radius_a, float radius_b, int segments) {
  const ProfilePoint profile[] = {{radius_a, 0}, {radius_b, length(b - a)}};
  revolve(a, frame_along(b - a), profile, segments);
}

void MeshBuilder::sphere(Vec3 center, float radius, int segments) {
  const int rows = std::max(2, segments / 2);
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= rows; ++i) {
    const float angle = 3.14159265f * static_cast<float>(i) / static_cast<float>(rows);
    profile.push_back({i == 0 || i == rows ? 0 : radius * std::sin(angle), -radius * std::cos(angle)});
  }
  revolve(center, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, profile, segments);
}

}  // namespace boxwood::mesh::procedural
