// The first ray: two triangles of your own, a tree over them, the closest hit of one ray.
//
// Boxwood reads your arrays where they are. Triangle numbers in hits count as in your index array, from 0.
#include <cstdio>

#include "boxwood/boxwood.h"

int main() {
  const float vertices[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};  // a unit square: four corners, x y z each
  const unsigned indices[] = {0, 1, 2, 0, 2, 3};                  // two triangles, counter-clockwise from +z
  const boxwood::MeshView mesh{.positions = vertices, .vertex_count = 4, .indices = indices, .triangle_count = 2};

  const auto accel = boxwood::Accel::build(mesh);
  if (!accel) return std::fprintf(stderr, "%s\n", accel.error().message.c_str()), 1;

  const boxwood::Hit hit = accel->closest_hit({.origin = {0.25f, 0.75f, 5}, .direction = {0, 0, -1}});
  if (!hit) return std::puts("The ray hit nothing."), 1;
  std::printf("The ray hit triangle %u at distance %g, barycentrics u = %g, v = %g.\n", hit.primitive, hit.t, hit.u,
              hit.v);
  return 0;
}
