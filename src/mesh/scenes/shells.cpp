// Nested symmetric shells, the case of POPOV's Figures 1 and 2. A cup is a regular tetrahedron inscribed in a cube,
// stretched along the axes, one face left open; each of its triangles has the whole box as its bounding box. Cups of
// growing size are nested about one centre, so all boxes of a nest, and with them all centroids, are centred on exactly
// the same point: no partition of centroids can separate them, while two nested child boxes, or a plane through the
// triangles, can. Nests stand in a lattice. Centres and radii are multiples of 2^-14 below 2^9, which keeps lower +
// upper exact.
#include <algorithm>
#include <cmath>

#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {
namespace {

constexpr std::size_t kCupsPerNest = 32;
constexpr float kSpacing = 2.5f;

/// Corners of one of the two tetrahedra in the cube from -1 to 1.
Vec3 tetrahedron_corner(int which, bool mirrored) {
  static constexpr Vec3 kCorner[4] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  return mirrored ? -kCorner[which] : kCorner[which];
}

void add_nest(TriangleMesh& mesh, Vec3 center, std::size_t cups, Random& random) {
  // Openings look towards the camera's half space: an open face's outward normal is minus its opposite corner.
  const bool mirrored = random.below(2);
  int open = static_cast<int>(random.below(4));
  while (dot(-1.0f * tetrahedron_corner(open, mirrored), {0.45f, 0.35f, 1.0f}) < 0.3f) open = (open + 1) & 3;

  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::size_t cup = 0; cup < cups; ++cup) {
    Vec3 half;  // half the width of the box; proportions vary so that neighbouring cups can be told apart
    for (int axis = 0; axis < 3; ++axis) {
      const float wish = (static_cast<float>(cup) + random.uniform(0.2f, 1.0f)) / static_cast<float>(cups);
      half[axis] = std::max(1.0f, std::round(wish * random.uniform(0.85f, 1.0f) * 16384)) / 16384;
    }
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 4; ++corner)
      mesh.vertices.push_back(center + half * tetrahedron_corner(corner, mirrored));
    for (int face = 0; face < 4; ++face) {
      if (face == open) continue;
      const auto v = [&](int step) { return first + static_cast<std::uint32_t>((face + step) & 3); };
      // Going round from any corner changes hands with each step, and a mirrored tetrahedron is left-handed.
      if (((face & 1) != 0) != mirrored)
        faces.push_back({v(1), v(2), v(3)});
      else
        faces.push_back({v(1), v(3), v(2)});
    }
  }
  // In shuffled order, so that halving by index does not find the nesting by luck.
  for (std::size_t i = faces.size(); i > 1; --i)
    std::swap(faces[i - 1], faces[random.below(static_cast<std::uint32_t>(i))]);
  mesh.triangles.insert(mesh.triangles.end(), faces.begin(), faces.end());
}

}  // namespace

Scene make_shells(const SceneOptions& options) {
  const std::size_t per_nest = 3 * kCupsPerNest, total = options.triangles / 3 * 3;
  const std::size_t nests = (total + per_nest - 1) / per_nest;
  const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(nests)) - 1e-9));
  Random random(options.seed);
  Scene scene;
  scene.mesh.vertices.reserve(total / 3 * 4);
  scene.mesh.triangles.reserve(total);
  // Lowest layer first; a whole nest's triangles stay together in the mesh.
  for (std::size_t nest = 0; nest < nests; ++nest) {
    const std::size_t cell[3] = {nest % side, nest / (side * side), nest / side % side};
    Vec3 center;
    for (int axis = 0; axis < 3; ++axis)
      center[axis] = kSpacing * (static_cast<float>(cell[axis]) - 0.5f * static_cast<float>(side - 1));
    add_nest(scene.mesh, center, std::min(per_nest, total - nest * per_nest) / 3, random);
  }
  const float half = 0.5f * kSpacing * static_cast<float>(side);
  scene.view = {.eye = {0.35f * half + 2.2f, 0.3f * half + 1.8f, half + 7.5f},
                .look_at = {0, 0, half - 1.25f},
                .up = {0, 1, 0},
                .fov = 40};
  return scene;
}

}  // namespace boxwood::mesh::procedural
