// The list of scenes, and what they have in common: checks, rotation, name.
#include "boxwood/mesh.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh {
namespace {

constexpr std::size_t kFewest = 12, kMost = 20'000'000;
constexpr float kFarthest = 1e9f;  // an outlier of 1e9 diagonals is still well within what a mesh may have

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

void rotate(Scene& scene, Vec3 degrees) {
  Box box;
  for (const Vec3& v : scene.mesh.vertices) box.grow(v);
  mesh::rotate(scene.mesh, degrees, box.center());
  scene.view = mesh::rotate(scene.view, degrees, box.center());
}

/// Adds the triangles that SceneOptions::outlier and spike ask for. A real defect of files: one stray vertex stretches
/// the box of the whole scene, or one triangle across it.
void add_defects(TriangleMesh& mesh, const SceneOptions& options) {
  Box box;
  for (const Vec3& v : mesh.vertices) box.grow(v);
  const Vec3 center = box.center(), extent = box.extent();
  const float diagonal = length(extent);
  const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  const Vec3 direction = normalize(Vec3{1, 2, 3});
  if (options.outlier > 0) {
    const Vec3 place = center + direction * (options.outlier * diagonal);
    const float side = maximum(0.001f * diagonal, options.outlier * diagonal * 0x1p-20f);  // of more than rounding
    add(place, place + Vec3{side, 0, 0}, place + Vec3{0, side, 0});
  }
  if (options.spike > 0)
    add(center, center + Vec3{0.001f * diagonal, 0, 0}, center + direction * (options.spike * diagonal));
}

Status check_distance(const char* what, std::string_view id, float distance) {
  if (distance >= 0 && distance <= kFarthest) return {};
  return {ErrorCode::out_of_range, std::string(what) + " of scene \"" + std::string(id) +
                                       "\" must be from 0 to 1e9 diagonals, not " + std::to_string(distance)};
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
    if (const Status status = check_distance("outlier", id, resolved.outlier); !status) return status.error();
    if (const Status status = check_distance("spike", id, resolved.spike); !status) return status.error();
    Scene scene = info->make(resolved);
    rotate(scene, resolved.rotate);
    add_defects(scene.mesh, resolved);
    scene.mesh.name = info->id;
    return scene;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "not enough memory for scene \"" + std::string(id) + "\""};
  }
}

}  // namespace boxwood::mesh
