// The list of scenes, and what they have in common: checks, rotation, name.
#include <cmath>

#include "boxwood/mesh.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh {
namespace {

constexpr std::size_t kFewest = 12, kMost = 20'000'000;

constexpr SceneInfo kScenes[] = {
    {"organic",
     "closed, watertight surface of even small triangles like a scan; pre-splitting must leave it alone (EVH)",
     "Stanford bunny and dragon (POPOV, EVH, EBBVH)", 200'000, procedural::make_organic},
    {"atrium", "hall of few huge axis-aligned walls and finely tessellated columns; rotate it to break boxes (EVH)",
     "Sponza atrium (POPOV, EVH, EBBVH)", 250'000, procedural::make_atrium},
    {"foliage", "trees of disconnected leaves, 2 to 4 triangles each; no shared edges to pair across leaves (EBBVH)",
     "Fairy Forest (POPOV), San Miguel (EBBVH)", 200'000, procedural::make_foliage},
    {"spaceship", "hull of long thin diagonal triangles around fine detail; boxes mostly empty (EVH)",
     "space ship turned by 45 degrees (EVH)", 200'000, procedural::make_spaceship},
    {"city", "buildings of very different sizes on a street grid with large ground; sparse and occluding (POPOV)",
     "Venice and Soda Hall (POPOV)", 250'000, procedural::make_city},
    {"shells", "nested symmetric shells whose box centroids coincide; only geometric splits part them (POPOV)",
     "Figures 1 and 2, SHIRLEY6 (POPOV)", 100'000, procedural::make_shells},
    {"soup", "random triangles of widely varied size without connectivity; overlap everywhere (stress test)",
     "worst case for every paper", 100'000, procedural::make_soup},
};

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
void sine_cosine(float degrees, double& sine, double& cosine) {
  const double reduced = std::remainder(static_cast<double>(degrees), 360.0);
  const double quarter = std::nearbyint(reduced / 90);
  const double rest = (reduced - 90 * quarter) * (3.14159265358979323846 / 180);
  const double s = std::sin(rest), c = std::cos(rest);
  switch (static_cast<int>(quarter) & 3) {
    case 0:
      sine = s, cosine = c;
      break;
    case 1:
      sine = c, cosine = -s;
      break;
    case 2:
      sine = -s, cosine = -c;
      break;
    default:
      sine = -c, cosine = s;
  }
}

/// Rotation about x, then y, then z, each by degrees.
class Rotation {
 public:
  explicit Rotation(Vec3 degrees) {
    for (int axis = 0; axis < 3; ++axis) sine_cosine(degrees[axis], sine_[axis], cosine_[axis]);
  }
  Vec3 turn(Vec3 v, Vec3 center) const {
    double p[3];
    for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(v[axis]) - center[axis];
    for (int axis = 0; axis < 3; ++axis) {
      double& a = p[(axis + 1) % 3];
      double& b = p[(axis + 2) % 3];
      const double turned = a * cosine_[axis] - b * sine_[axis];
      b = a * sine_[axis] + b * cosine_[axis];
      a = turned;
    }
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(p[axis] + center[axis]);
    return v;
  }

 private:
  double sine_[3], cosine_[3];
};

/// Nothing need move, and nothing then changes by rounding either.
bool is_whole_turns(Vec3 degrees) {
  return std::remainder(degrees.x, 360.0f) == 0 && std::remainder(degrees.y, 360.0f) == 0 &&
         std::remainder(degrees.z, 360.0f) == 0;
}

void rotate(Scene& scene, Vec3 degrees) {
  Box box;
  for (const Vec3& v : scene.mesh.vertices) box.grow(v);
  const Rotation rotation(degrees);
  const Vec3 center = box.center();
  for (Vec3& v : scene.mesh.vertices) v = rotation.turn(v, center);
  scene.view.eye = rotation.turn(scene.view.eye, center);
  scene.view.look_at = rotation.turn(scene.view.look_at, center);
  scene.view.up = rotation.turn(scene.view.up, {});
}

}  // namespace

std::span<const SceneInfo> scenes() {
  return kScenes;
}

Result<Scene> make_scene(std::string_view id, const SceneOptions& options) {
  try {
    const SceneInfo* info = nullptr;
    std::string known;
    for (const SceneInfo& row : kScenes) {
      if (id == row.id) info = &row;
      known += (known.empty() ? "" : ", ") + std::string(row.id);
    }
    if (!info) return {ErrorCode::unknown_name, "unknown scene \"" + std::string(id) + "\"; there are " + known};
    SceneOptions resolved = options;
    if (resolved.triangles == 0) resolved.triangles = info->default_triangles;
    if (resolved.triangles < kFewest || resolved.triangles > kMost) {
      return {ErrorCode::out_of_range, "scene \"" + std::string(id) + "\" can't have " +
                                           std::to_string(resolved.triangles) +
                                           " triangles; the range is 12 to 20000000"};
    }
    if (!is_finite(resolved.rotate)) {
      return {ErrorCode::invalid_argument,
              "rotation of scene \"" + std::string(id) + "\" is not finite: " + std::to_string(resolved.rotate.x) +
                  ":" + std::to_string(resolved.rotate.y) + ":" + std::to_string(resolved.rotate.z)};
    }
    Scene scene = info->make(resolved);
    if (!is_whole_turns(resolved.rotate)) rotate(scene, resolved.rotate);
    scene.mesh.name = info->id;
    return scene;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "not enough memory for scene \"" + std::string(id) + "\""};
  }
}

}  // namespace boxwood::mesh
