// A space ship turned by 45 degrees in space: hull plates, truss and radiators are long thin diagonal triangles that
// run the length of a section, around finely tessellated tanks, engines and fittings. The boxes of the long triangles
// are almost empty and cover the detail: EVH's worst case for bounding volume hierarchies, and its case for
// pre-splitting.
#include <algorithm>
#include <cmath>

#include "mesh/scenes/mesh_builder.h"
#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kFlatness = 0.8f;  // height of the hull over its width

/// The ship before it is turned: nose along +x, top along +y, from x = -10 to 12.
class Ship {
 public:
  Ship(MeshBuilder& builder, int detail, int extra_boxes, std::uint64_t seed)
      : builder_(builder), scale_(static_cast<double>(detail) / 64), extra_boxes_(extra_boxes), random_(seed) {}

  void describe() {
    plates(8.4f, 12.0f, 1.22f, 0.12f, 0.2f);   // nose
    plates(5.6f, 8.4f, 1.55f, 1.22f, 0.25f);   // forward hold
    plates(1.0f, 5.6f, 1.75f, 1.55f, 0.3f);    // crew section
    plates(-9.0f, -5.6f, 1.25f, 1.5f, 0.35f);  // engine block
    truss();
    radiators();
    tanks();
    engines();
    fittings();
  }

 private:
  int pieces(double at_unit_scale, int least) const {
    return std::max(least, static_cast<int>(std::lround(at_unit_scale * scale_)));
  }
  /// Where the share of the hull is to stay the same, counts along one direction grow like the square of the scale.
  int strips(double at_unit_scale, int least) const {
    return std::max(least, static_cast<int>(std::lround(at_unit_scale * scale_ * scale_)));
  }
  static Vec3 around(float x, float radius, float angle) {
    return {x, kFlatness * radius * std::cos(angle), radius * std::sin(angle)};
  }

  /// One ring of plates from x0 to x1, each as long as the section, slanted by `twist` radians.
  void plates(float x0, float x1, float radius0, float radius1, float twist) {
    const int count = strips(800, 5);
    builder_.grid(count, 1, true, [&](int i, int j) {
      const float angle = -2 * kPi * static_cast<float>(i) / static_cast<float>(count) + (j ? twist : 0);
      return around(j ? x1 : x0, j ? radius1 : radius0, angle);
    });
  }

  /// Slats that wind about the tanks, some one way and some the other; each is a bundle of strips over its full length.
  void truss() {
    const int slats = std::clamp(pieces(20, 4), 4, 20), across = strips(26, 1);
    for (int s = 0; s < slats; ++s) {
      const float start = 2 * kPi * static_cast<float>(s) / static_cast<float>(slats);
      const float twist = s % 2 ? 1.0f : -1.0f, width = 0.075f;
      builder_.grid(across, 1, false, [&](int i, int j) {
        const float offset = width * (static_cast<float>(i) / static_cast<float>(across) - 0.5f);
        return around(j ? 1.0f : -5.6f, 1.52f, start + (j ? twist : 0) - offset);
      });
    }
  }

  /// Four panels, each ruled by strips from the hull to the tip.
  void radiators() {
    const int count = strips(420, 2);
    for (const float side : {1.0f, -1.0f}) {
      for (const float tilt : {0.32f, -0.32f}) {
        builder_.grid(count, 1, false, [&](int i, int j) {
          const float t = static_cast<float>(i) / static_cast<float>(count);
          if (!j) return Vec3{-8.8f + 3.4f * t, 0.5f * tilt, side * 1.2f};
          return Vec3{-10.0f + 1.7f * t, tilt * 4.2f, side * 6.2f};
        });
        builder_.bar({-8.8f, 0.5f * tilt, side * 1.2f}, {-10, tilt * 4.2f, side * 6.2f}, 0.05f, 0.05f);
        builder_.bar({-5.4f, 0.5f * tilt, side * 1.2f}, {-8.3f, tilt * 4.2f, side * 6.2f}, 0.05f, 0.05f);
      }
    }
  }

  void tanks() {
    builder_.tube({-5.6f, 0, 0}, {1, 0, 0}, 0.3f, 0.3f, pieces(48, 5));
    const int rings = std::clamp(pieces(4, 1), 1, 4);
    for (int ring = 0; ring < rings; ++ring) {
      for (int k = 0; k < 4; ++k) {
        const float angle = 0.5f * kPi * (static_cast<float>(k) + 0.5f * static_cast<float>(ring % 2));
        const float x = -5.6f + 6.6f * (static_cast<float>(ring) + 0.5f) / static_cast<float>(rings);
        builder_.sphere(around(x, 0.82f, angle), 0.46f, pieces(44, 6));
      }
    }
  }

  void engines() {
    const ProfilePoint bell[] = {{0.25f, 0},    {0.2f, 0.3f},   {0.32f, 0.6f}, {0.58f, 1.1f},
                                 {0.72f, 1.7f}, {0.68f, 1.68f}, {0.5f, 1.1f},  {0.2f, 0.6f}};
    const Frame aft = frame_along({-1, 0, 0});
    const auto profile = smooth_profile(bell, pieces(40, 8));
    for (int k = 0; k < 4; ++k) {
      const float angle = kPi * (0.25f + 0.5f * static_cast<float>(k));
      builder_.revolve(around(-9, 0.85f, angle), aft, profile, pieces(52, 6));
    }
    const ProfilePoint collar[] = {{1.5f, 0}, {1.66f, 0.08f}, {1.7f, 0.2f}, {1.66f, 0.32f}, {1.5f, 0.4f}};
    const std::size_t first = builder_.vertices().size();
    for (const float x : {-5.4f, 1.2f, 5.8f})
      builder_.revolve({x, 0, 0}, aft, smooth_profile(collar, pieces(20, 4)), pieces(96, 6));
    for (std::size_t i = first; i < builder_.vertices().size(); ++i) builder_.vertices()[i].y *= kFlatness;
  }

  /// Boxes, domes, dishes and masts on the hull.
  void fittings() {
    const int boxes = strips(950, 6) + extra_boxes_;
    const auto fineness = static_cast<float>(1 / std::max(0.7, scale_));  // together they cover the same area
    for (int i = 0; i < boxes; ++i) {
      const bool forward = random_.below(3) != 0;
      const float x = forward ? random_.uniform(1.3f, 5.3f) : random_.uniform(-8.8f, -5.9f);
      const float radius = forward ? 1.75f - 0.2f * (x - 1.0f) / 4.6f : 1.25f + 0.25f * (x + 9) / 3.4f;
      const float angle = random_.uniform(0, 2 * kPi);
      const Vec3 foot = around(x, radius - 0.06f, angle), out = around(0, 1, angle);
      const float height = random_.uniform(0.08f, 0.22f), size = fineness * random_.uniform(0.015f, 0.075f);
      builder_.bar(foot, foot + height * out, size, size * random_.uniform(0.7f, 2.5f));
    }
    builder_.sphere({6.9f, 1.0f, 0}, 0.5f, pieces(80, 6));  // bridge
    const ProfilePoint dish[] = {{0, 0}, {0.4f, 0.08f}, {0.75f, 0.32f}, {0.78f, 0.3f}, {0.1f, -0.04f}};
    builder_.revolve({3.4f, 2.3f, 0}, frame_along({0.6f, 1, 0.2f}), smooth_profile(dish, pieces(24, 5)), pieces(72, 6));
    builder_.bar({3.4f, 1.2f, 0}, {3.4f, 2.3f, 0}, 0.05f, 0.05f);
    for (const float z : {-0.5f, 0.1f, 0.45f})
      builder_.bar({-6.4f, 0.9f, z}, {-7.8f - z, 3.4f + z, 1.5f * z}, 0.02f, 0.02f);
  }

  MeshBuilder& builder_;
  double scale_;
  int extra_boxes_;
  Random random_;
};

/// For budgets too small for a ship: a bare spindle with a twist.
void describe_spindle(MeshBuilder& builder, std::size_t budget, std::uint64_t seed) {
  const int sides = std::max(3, static_cast<int>(budget / 4));
  const float twist = Random(seed).uniform(0.3f, 0.9f);
  const float x[3] = {-10, 0, 12}, radius[3] = {1.2f, 1.8f, 0.05f};
  builder.grid(sides, 2, true, [&](int i, int j) {
    const float angle = -2 * kPi * static_cast<float>(i) / static_cast<float>(sides) + twist * static_cast<float>(j);
    return Vec3{x[j], radius[j] * std::cos(angle), radius[j] * std::sin(angle)};
  });
}

/// 45 degrees about each of two axes, so that the length runs through all three.
Vec3 turned(Vec3 p) {
  constexpr float kHalf = 0.70710678f;
  const Vec3 raised{kHalf * (p.x - p.y), kHalf * (p.x + p.y), p.z};
  return {kHalf * (raised.x + raised.z), raised.y, kHalf * (raised.z - raised.x)};
}

}  // namespace

Scene make_spaceship(const SceneOptions& options) {
  const auto count = [&](int detail) {
    MeshBuilder counter(MeshBuilder::Purpose::count);
    Ship(counter, detail, 0, options.seed).describe();
    return counter.triangle_count();
  };
  MeshBuilder builder(MeshBuilder::Purpose::build);
  if (count(4) > options.triangles) {
    describe_spindle(builder, options.triangles, options.seed);
  } else {
    const int detail = largest_detail(4, 1 << 14, options.triangles, count);
    // What rounding leaves over goes into boxes on the hull.
    const int extra = static_cast<int>((options.triangles - count(detail)) / 12);
    builder.reserve(options.triangles / 10 * 7, options.triangles);
    Ship(builder, detail, extra, options.seed).describe();
  }
  for (Vec3& v : builder.vertices()) v = turned(v);
  Scene scene;
  scene.mesh = builder.take();
  // From abeam and above in the ship's own directions; upright in the turned world.
  scene.view = {.eye = turned({6, 8, 26}), .look_at = turned({-0.4f, -0.9f, 0.4f}), .up = {0, 1, 0}, .fov = 40};
  return scene;
}

}  // namespace boxwood::mesh::procedural
