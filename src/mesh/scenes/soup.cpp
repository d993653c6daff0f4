// Triangle soup: no connectivity and no order to exploit. Places are uniform in a cube, orientations uniform, sizes
// log-uniform over three powers of ten, so that a few triangles overlap very many boxes of others.
#include <cmath>

#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {

Scene make_soup(const SceneOptions& options) {
  Random random(options.seed);
  const std::size_t count = options.triangles;
  // Shrinking with the number keeps the picture a cloud and not a wall.
  const float largest = 1.2f / std::pow(static_cast<float>(count), 1.0f / 6.0f);
  Scene scene;
  scene.mesh.vertices.reserve(3 * count);
  scene.mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const float size = largest * std::pow(10.0f, random.uniform(-3, 0));
    const auto first = static_cast<std::uint32_t>(3 * i);
    for (int corner = 0; corner < 3; ++corner) scene.mesh.vertices.push_back(Vec3{x, y, z} + size * random.direction());
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.view = {.eye = {1.9f, 1.4f, 3.6f}, .look_at = {0, -0.05f, 0}, .up = {0, 1, 0}, .fov = 40};
  return scene;
}

}  // namespace boxwood::mesh::procedural
