// Puts scenes together from shapes. In counting mode it only counts triangles, so that one description of a scene both
// finds the detail that fits a budget and makes the mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/mesh.h"

namespace boxwood::mesh::procedural {

/// Right-handed orthonormal axes with y along `axis`.
struct Frame {
  Vec3 x, y, z;
};
Frame frame_along(Vec3 axis);

/// A point of an outline that is turned about an axis.
struct ProfilePoint {
  float radius, height;
};

/// `count` points of a smooth curve (Catmull and Rom) through the given points, ends included; count >= 2.
std::vector<ProfilePoint> smooth_profile(std::span<const ProfilePoint> points, int count);

class MeshBuilder {
 public:
  enum class Purpose { count, build };
  explicit MeshBuilder(Purpose purpose) : building_(purpose == Purpose::build) {}

  bool is_building() const { return building_; }
  std::size_t triangle_count() const { return count_; }
  void reserve(std::size_t vertices, std::size_t triangles);
  TriangleMesh take() { return std::move(mesh_); }
  std::vector<Vec3>& vertices() { return mesh_.vertices; }

  std::uint32_t vertex(Vec3 p) {
    if (building_) mesh_.vertices.push_back(p);
    return next_++;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (building_) mesh_.triangles.push_back({a, b, c});
    ++count_;
  }

  /// Two triangles, counter-clockwise seen from the front.
  void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

  /// columns x rows cells over point(column, row), integers from 0 to columns and 0 to rows. `wraps`: the last column
  /// of points is the first. Front: where columns run to the right and rows up.
  template <class Point>
  void grid(int columns, int rows, bool wraps, Point&& point) {
    if (!building_) {
      count_ += std::size_t(2) * columns * rows;
      return;
    }
    const std::uint32_t base = next_, width = static_cast<std::uint32_t>(columns + !wraps);
    for (int j = 0; j <= rows; ++j)
      for (std::uint32_t i = 0; i < width; ++i) vertex(point(static_cast<int>(i), j));
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j) {
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
        const std::uint32_t right = i + 1 == width ? 0 : i + 1;
        const std::uint32_t a = base + j * width + i, b = base + j * width + right;
        triangle(a, b, b + width);
        triangle(a, b + width, a + width);
      }
    }
  }

  /// Box between two corners with shared vertices: 12 triangles, 10 without the bottom (lower y).
  void box(const Box& box, bool bottom = true);

  /// Box of the given half widths along frame_along(b - a), from a to b: 12 triangles.
  void bar(Vec3 a, Vec3 b, float half_x, float half_z);

  /// The outline turned about the axis frame.y through `base`; ends of radius zero become points.
  /// 2 * segments triangles between two rings, `segments` between a ring and a point.
  void revolve(Vec3 base, const Frame& frame, std::span<const ProfilePoint> profile, int segments);

  /// Open tube or cone from a to b: 2 * segments triangles.
  void tube(Vec3 a, Vec3 b, float radius_a, float radius_b, int segments);

  /// Closed sphere: segments around, `segments / 2` from pole to pole (at least 2).
  void sphere(Vec3 center, float radius, int segments);

 private:
  /// Faces over eight vertices in the order of corner bits x = 1, y = 2, z = 4; face 0 is the bottom.
  void box_faces(std::uint32_t v, int first_face);

  bool building_;
  std::size_t count_ = 0;
  std::uint32_t next_ = 0;
  TriangleMesh mesh_;
};

/// The largest detail in [low, limit] for which count(detail) <= budget, or low if there is none; count never falls.
template <class Count>
int largest_detail(int low, int limit, std::size_t budget, Count&& count) {
  int high = low;  // doubled until too large, because counting itself takes the longer the larger the detail
  while (high < limit && count(high) <= budget) low = high, high = high < limit / 2 ? 2 * high : limit;
  while (low < high) {
    const int middle = low + (high - low + 1) / 2;
    if (count(middle) <= budget)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

}  // namespace boxwood::mesh::procedural
