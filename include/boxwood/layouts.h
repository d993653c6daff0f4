// Encoded trees: what the kernels walk. Each layout has its node struct, its encoder and its checker in one file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"
#include "boxwood/tree.h"

namespace boxwood::layouts {

enum class LayoutId { linear, wide4, wide8, wide8_quads, wide16 };

/// One row of the registry of layouts.
struct LayoutInfo {
  LayoutId id;
  const char* name;     ///< "wide8"
  const char* summary;  ///< one line that ends with what it is best for
  /// What visiting a node costs against testing one block of a leaf, as measured (docs/collapse.md).
  float node_cost;
};
std::span<const LayoutInfo> registry();
Result<LayoutId> find(std::string_view name);
const char* name(LayoutId id);
/// Children a node may have: 2 for `linear`.
int width(LayoutId id);
/// LayoutInfo::node_cost.
float node_cost(LayoutId id);
/// Leaves are blocks of quads, not of triangles.
bool has_quads(LayoutId id);

/// PBRT's 32-byte node, depth first: the first child of an inner node follows it, the second is at `offset`.
/// `count_and_axis`: bits 0-1 split axis of an inner node, bits 2-31 triangles of a leaf (0 = inner).
struct LinearNode {
  Box bounds;
  std::uint32_t offset = 0;  ///< inner: second child; leaf: first triangle
  std::uint32_t count_and_axis = 0;
};
static_assert(sizeof(LinearNode) == 32);

/// A triangle of the linear layout: its corners in the mesh's order and its id.
struct LinearTriangle {
  Triangle triangle;
  std::uint32_t primitive;
};
static_assert(sizeof(LinearTriangle) == 40);

/// A node of up to W children, planes apart: planes[2 * axis] are the lower sides, planes[2 * axis + 1] the upper ones.
/// Unused children have an empty box (+inf, -inf), which no ray meets, and stand behind the used ones.
template <int W>
struct alignas(64) WideNode {
  float planes[6][W];
  std::uint32_t child[W];
};
static_assert(sizeof(WideNode<4>) == 128 && sizeof(WideNode<8>) == 256 && sizeof(WideNode<16>) == 448);

/// Child words of a wide node: inner = index of the node; leaf = bit 31, bits 28-30 blocks - 1, bits 0-27 first block.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;
inline constexpr std::uint32_t kNoRoot = 0xffffffffu;
constexpr std::uint32_t leaf_word(std::uint32_t first_block, std::uint32_t blocks) {
  return kLeafBit | (blocks - 1) << 28 | first_block;
}
constexpr std::uint32_t leaf_blocks(std::uint32_t word) {
  return (word >> 28 & 7) + 1;
}
constexpr std::uint32_t leaf_first(std::uint32_t word) {
  return word & 0x0fffffff;
}

inline constexpr std::uint32_t kInvalidPrimitive = 0xffffffffu;

/// Four triangles, planes apart: corner[vertex][axis][lane], corners in the mesh's order. Unused lanes are NaN, which
/// no test accepts, with primitive kInvalidPrimitive, and stand behind the used ones.
struct alignas(32) TriangleBlock {
  float corner[3][3][4];
  std::uint32_t primitive[4];
};
static_assert(sizeof(TriangleBlock) == 160);

/// Four quads, planes apart: two triangles each that share the edge from edge[0] to edge[1] and have one corner more,
/// apex[axis][quad] and apex[axis][4 + quad]. A triangle without a partner is a quad whose second apex is NaN and
/// second primitive kInvalidPrimitive. Unused quads are NaN, both primitives kInvalidPrimitive, and stand behind the
/// used ones. `primitive` is the triangle's id in bits 0 to 28, in bits 29 and 30 by how many places the mesh's corners
/// are turned against (apex, edge[0], edge[1]), and bit 31 if the edge is run through from edge[1] to edge[0] instead.
struct alignas(32) QuadBlock {
  float apex[3][8];
  float edge[2][3][4];
  std::uint32_t primitive[8];
};
static_assert(sizeof(QuadBlock) == 224);
inline constexpr std::uint32_t kQuadIdMask = 0x1fffffffu, kQuadTurnBit = 1u << 29, kQuadFlipBit = 1u << 31;

inline constexpr std::uint8_t kQuadCornerPlaces[8][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {},
                                                         {0, 2, 1}, {2, 1, 0}, {1, 0, 2}, {}};
/// Where corner `corner` of the mesh's triangle stands: 0 apex, 1 edge[0], 2 edge[1].
constexpr int quad_corner_place(std::uint32_t primitive, int corner) {
  return kQuadCornerPlaces[primitive >> 29][corner];
}

/// An encoded tree with its triangles. Immutable once made; read from any number of threads.
struct Layout {
  LayoutId id = LayoutId::wide8;
  AlignedBuffer<std::byte> nodes;      ///< LinearNode or WideNode<W>
  AlignedBuffer<std::byte> triangles;  ///< LinearTriangle, TriangleBlock or QuadBlock
  std::uint32_t root = kNoRoot;        ///< wide: child word of the root; linear: 0; kNoRoot when empty
  Box bounds;
  std::size_t max_stack = 0;  ///< most entries a traversal can have waiting
  std::size_t node_count = 0, leaf_count = 0, reference_count = 0;

  std::size_t bytes() const { return nodes.bytes() + triangles.bytes(); }
};

/// Encodes a binary tree as `linear` over the mesh it was built from. Errors: more nodes or triangles than the words
/// can address, a reference past the mesh, out of memory. Deterministic, parallel, any depth.
Result<Layout> encode_linear(const tree::BinaryTree& tree, const MeshView& mesh, Executor& executor);

/// Encodes a tree of width 4, 8 or 16 as `wide4`, `wide8` or `wide16`. Leaves must hold 1 to 32 references. Errors as
/// above.
Result<Layout> encode_wide(const tree::WideTree& tree, const MeshView& mesh, Executor& executor);

/// Encodes a tree of width 8 as `wide8-quads`, pairing triangles of one leaf that have an edge
/// in common. Errors as above, and a mesh of more than 2^29 triangles.
Result<Layout> encode_wide_quads(const tree::WideTree& tree, const MeshView& mesh, Executor& executor);

/// Blocks that a leaf over these references takes in layouts with quads; above 32 references, leaves of 32 each.
std::uint32_t quad_blocks(std::span<const std::uint32_t> references, const MeshView& mesh);

/// What a layout was made of, as far as it still holds it. A reference's box is not kept: where the tree splits
/// references it is the part of the triangle inside the leaf's box.
struct Decoded {
  tree::WideTree tree;              ///< of width 2 (`linear`), 4 or 8; nodes and children as they stand in the layout
  std::vector<Triangle> triangles;  ///< by primitive id up to the largest one; zeros where the tree has none

  /// The triangles as a mesh without shared vertices, to encode from. It looks into this object.
  MeshView mesh() const { return {triangles.data(), 3 * triangles.size(), nullptr, triangles.size()}; }
};

/// Turns any layout back into a tree and triangles, with the mesh's exact corners; encoding these gives the same layout
/// again, up to the order of children. Error: out of memory. O(nodes + triangles).
Result<Decoded> decode(const Layout& layout);

/// Where nodes and children of a wide layout go.
struct Arrangement {
  std::vector<std::uint32_t>
      nodes;  ///< by new place, the old number; the root stays first, all parents before children
  std::vector<std::uint8_t>
      lanes;  ///< width for each node, by old number: the old lanes in their new order, used first
};

/// The same tree in another order: any-hit queries take the children of a node as they stand, closest-hit queries by
/// distance, and nodes that are visited one after the other are best side by side. Hits stay the same. Leaves follow
/// their nodes. Errors: the layout `linear`, an arrangement of another size, out of memory; that it is a permutation is
/// the caller's part.
Result<Layout> arrange(const Layout& layout, const Arrangement& arrangement);

/// Walks the encoded tree and gives the first contradiction as an error: every child box holds all triangles below it
/// (meets them, when references are split), every word points inside the arrays, every reference is found exactly as
/// often as in `references`, those of the binary tree (when references are split: at least once and at most as often),
/// with the mesh's exact corners, and no path needs more stack than max_stack.
Status validate(const Layout& layout, std::span<const std::uint32_t> references, bool splits_references,
                const MeshView& mesh);

}  // namespace boxwood::layouts
