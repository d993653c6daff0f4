// Welding by exact position: one hash table over the vertices (see first_equal.h). No tolerance, so the answer depends
// on nothing but the coordinates. Expected O(vertices), deterministic for every thread count.
#include <bit>

#include "boxwood/mesh.h"
#include "mesh/first_equal.h"

namespace boxwood::mesh {

std::vector<std::uint32_t> weld(const MeshView& mesh, Executor& executor) {
  std::vector<std::uint32_t> first(mesh.vertex_count);
  const auto bits = [](float x) -> std::uint64_t { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 becomes +0
  find_first_equal(
      mesh.vertex_count, first.data(), executor, [&](std::size_t i) { return is_finite(mesh.vertex(i)); },
      [&](std::size_t i) {
        const Vec3 p = mesh.vertex(i);
        return scramble(scramble(bits(p.x) | bits(p.y) << 32) + bits(p.z) * 0x9e3779b97f4a7c15ull);
      },
      [&](std::size_t a, std::size_t b) { return mesh.vertex(a) == mesh.vertex(b); });
  return first;
}

}  // namespace boxwood::mesh
