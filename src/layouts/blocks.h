// Reading leaf blocks: the triangles of a block one by one, with the mesh's exact corners.
#pragma once

#include "boxwood/layouts.h"

namespace boxwood::layouts {

/// Calls f(primitive, triangle) for each triangle of a block, in the order of its lanes.
template <class F>
void for_triangles(const TriangleBlock& block, F&& f) {
  for (int lane = 0; lane < 4 && block.primitive[lane] != kInvalidPrimitive; ++lane) {
    Vec3 corner[3];
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis) corner[k][axis] = block.corner[k][axis][lane];
    f(block.primitive[lane], Triangle{corner[0], corner[1], corner[2]});
  }
}

template <class F>
void for_triangles(const QuadBlock& block, F&& f) {
  for (int lane = 0; lane < 8; ++lane) {
    const std::uint32_t primitive = block.primitive[lane];
    if (primitive == kInvalidPrimitive) continue;
    const int quad = lane % 4;
    Vec3 place[3];
    for (int axis = 0; axis < 3; ++axis) {
      place[0][axis] = block.apex[axis][lane];
      place[1][axis] = block.edge[0][axis][quad];
      place[2][axis] = block.edge[1][axis][quad];
    }
    f(primitive & kQuadIdMask, Triangle{place[quad_corner_place(primitive, 0)], place[quad_corner_place(primitive, 1)],
                                        place[quad_corner_place(primitive, 2)]});
  }
}

/// The triangles of the leaf that a child word names.
template <class Block, class F>
void for_leaf_triangles(const Layout& layout, std::uint32_t word, F&& f) {
  const auto* blocks = reinterpret_cast<const Block*>(layout.triangles.data());
  for (std::uint32_t b = 0; b < leaf_blocks(word); ++b) for_triangles(blocks[leaf_first(word) + b], f);
}

}  // namespace boxwood::layouts
