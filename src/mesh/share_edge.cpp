// Whether two triangles share an edge, without a table of all edges.
#include "boxwood/mesh.h"

namespace boxwood::mesh {
namespace {

/// Bit i: corner i of `a` equals a corner of `b`.
template <class Corner>
unsigned corners_in_common(const std::array<Corner, 3>& a, const std::array<Corner, 3>& b) {
  unsigned common = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) common |= unsigned(a[i] == b[j]) << i;
  return common;
}

/// Are there two corners in common that are not equal to each other?
template <class Corner>
bool has_two(unsigned common, const std::array<Corner, 3>& a) {
  return ((common & 3) == 3 && !(a[0] == a[1])) || ((common & 6) == 6 && !(a[1] == a[2])) ||
         ((common & 5) == 5 && !(a[2] == a[0]));
}

}  // namespace

bool share_edge(const MeshView& mesh, std::size_t a, std::size_t b, Weld weld) {
  if (a == b) return false;
  const auto corners_a = mesh.corners(a), corners_b = mesh.corners(b);
  const unsigned by_index = corners_in_common(corners_a, corners_b);
  if (weld == Weld::index) return has_two(by_index, corners_a);
  const auto positions = [&](const std::array<std::uint32_t, 3>& corners) {
    return std::array{mesh.vertex(corners[0]), mesh.vertex(corners[1]), mesh.vertex(corners[2])};
  };
  const auto positions_a = positions(corners_a);
  return has_two(by_index, positions_a) || has_two(corners_in_common(positions_a, positions(corners_b)), positions_a);
}

}  // namespace boxwood::mesh
