// Layouts `wide4`, `wide8` and `wide16`: nodes that hold the boxes of all their children plane by plane, so that one
// SIMD operation tests them together (Dammertz, Hanika and Keller 2008, bib key qbvh; Ernst and Greiner 2008; Wald,
// Benthin and Boulos 2008), over blocks of four triangles stored the same way; `wide8-quads`, the
// same nodes over blocks of four quads (quads.cpp). O(nodes + triangles), deterministic, parallel.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>

#include "boxwood/layouts.h"
#include "layouts/encode.h"
#include "layouts/quads.h"
#include "math/float4.h"
#include "mesh/load_vertex.h"

namespace boxwood::layouts {
namespace {

/// False, with the block not filled in: a reference is not to a triangle of the mesh.
bool fill_block(TriangleBlock& block, std::span<const std::uint32_t> references, const MeshView& mesh) {
  std::array<std::uint32_t, 3> vertices[4] = {};
  std::uint32_t largest = 0;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    if (lane >= references.size()) {
      block.primitive[lane] = kInvalidPrimitive;
      continue;
    }
    const std::uint32_t primitive = block.primitive[lane] = references[lane];
    if (primitive >= mesh.triangle_count) return false;
    vertices[lane] = mesh.corners(primitive);
    largest = std::max({largest, vertices[lane][0], vertices[lane][1], vertices[lane][2]});
  }
  if (largest >= mesh.vertex_count) return false;
  const mesh::VertexLoader load(mesh, largest);
  for (std::size_t k = 0; k < 3; ++k) {
    Float4 corner[4];
    for (std::size_t lane = 0; lane < 4; ++lane)
      corner[lane] =
          lane < references.size() ? load(vertices[lane][k]) : Float4::fill(std::numeric_limits<float>::quiet_NaN());
    auto& [x, y, z, rest] = corner;
    transpose(x, y, z, rest);
    x.store_anywhere(block.corner[k][0]);
    y.store_anywhere(block.corner[k][1]);
    z.store_anywhere(block.corner[k][2]);
  }
  return true;
}

/// How leaves become blocks: of triangles, or of quads.
struct TriangleBlocks {
  using Block = TriangleBlock;
  static std::uint32_t count(std::span<const std::uint32_t> references, const MeshView&) {
    return static_cast<std::uint32_t>((references.size() + 3) / 4);
  }
  /// False: not all references are to triangles of the mesh.
  static bool fill(Block* blocks, std::span<const std::uint32_t> references, const MeshView& mesh) {
    for (std::size_t done = 0; done < references.size(); done += 4)
      if (!fill_block(blocks[done / 4], references.subspan(done, std::min<std::size_t>(4, references.size() - done)),
                      mesh))
        return false;
    return true;
  }
};
struct QuadBlocks {
  using Block = QuadBlock;
  static std::uint32_t count(std::span<const std::uint32_t> references, const MeshView& mesh) {
    return quad_blocks(references, mesh);
  }
  static bool fill(Block* blocks, std::span<const std::uint32_t> references, const MeshView& mesh) {
    fill_quads(blocks, references, mesh);
    return true;
  }
};

using Child = tree::WideTree::Child;

template <int W>
void fill_node(WideNode<W>& node, std::span<const Child> children, std::span<const std::uint32_t> words) {
  static_assert(sizeof(Child) == 32);  // two registers: x, y, z and x again; y, z and what is not needed
  const Child unused;
  for (std::size_t first = 0; first < W; first += 4) {
    Float4 a[4], b[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const Child* const child = first + i < children.size() ? &children[first + i] : &unused;
      a[i] = Float4::load_anywhere(child);
      b[i] = Float4::load_anywhere(&child->bounds.upper.y);
      node.child[first + i] = first + i < children.size() ? words[first + i] : 0;
    }
    transpose(a[0], a[1], a[2], a[3]);
    transpose(b[0], b[1], b[2], b[3]);
    for (int axis = 0; axis < 3; ++axis) a[axis].store_anywhere(node.planes[2 * axis] + first);
    a[3].store_anywhere(node.planes[1] + first);
    b[0].store_anywhere(node.planes[3] + first);
    b[1].store_anywhere(node.planes[5] + first);
  }
  // Equal trees shall be equal to the last byte, those behind the children included.
  constexpr std::size_t used = sizeof(node.planes) + sizeof(node.child);
  if constexpr (used < sizeof(node)) std::memset(reinterpret_cast<std::byte*>(&node) + used, 0, sizeof(node) - used);
}

/// References below each child. Children's nodes stand behind their parents, so one backward pass is enough.
AlignedBuffer<std::uint32_t> count_references(const tree::WideTree& tree) {
  AlignedBuffer<std::uint32_t> below(tree.children.size());
  for (std::size_t node = tree.first_child.size() - 1; node-- > 0;)
    for (std::size_t c = tree.first_child[node]; c < tree.first_child[node + 1]; ++c) {
      const auto& child = tree.children[c];
      below[c] = child.count;
      if (child.count) continue;
      for (std::size_t g = tree.first_child[child.first]; g < tree.first_child[child.first + 1]; ++g)
        below[c] += below[g];
    }
  return below;
}

/// The order in which an any-hit query tries the children of each node: likely to be met and cheap to search first, by
/// area / (1 + references), descending. Closest-hit queries go by distance and don't mind. Beside the children their
/// words: the blocks of a leaf, the node of an inner child.
template <class Blocks>
std::pair<AlignedBuffer<Child>, AlignedBuffer<std::uint32_t>> order_children(const tree::WideTree& tree,
                                                                             const MeshView& mesh, Executor& executor) {
  const auto below = count_references(tree);
  AlignedBuffer<Child> children(tree.children.size());
  AlignedBuffer<std::uint32_t> words(tree.children.size());
  executor.for_chunks(tree.first_child.size() - 1, 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    struct Place {
      float worth;
      std::uint32_t child;
    };
    std::array<Place, 16> order;
    for (std::size_t node = begin; node < end; ++node) {
      const std::uint32_t first = tree.first_child[node], count = tree.first_child[node + 1] - first;
      for (std::uint32_t i = 0; i < count; ++i) {  // insertion sort: few children, and equal ones stay in order
        const float worth = tree.children[first + i].bounds.half_area() / (1.0f + static_cast<float>(below[first + i]));
        std::uint32_t place = i;
        for (; place > 0 && order[place - 1].worth < worth; --place) order[place] = order[place - 1];
        order[place] = {worth, first + i};
      }
      for (std::uint32_t i = 0; i < count; ++i) {
        const Child& child = children[first + i] = tree.children[order[i].child];
        words[first + i] = child.count == 0
                               ? child.first
                               : Blocks::count(std::span(tree.references).subspan(child.first, child.count), mesh);
      }
    }
  });
  return {std::move(children), std::move(words)};
}

/// False: not all references are to triangles of the mesh.
template <int W, class Blocks>
bool fill(Layout& layout, const tree::WideTree& tree, std::span<const Child> children,
          std::span<const std::uint32_t> words, const MeshView& mesh, Executor& executor) {
  const std::span<const std::uint32_t> references = tree.references;
  const std::size_t nodes = tree.first_child.size() - 1;
  layout.nodes = AlignedBuffer<std::byte>(nodes * sizeof(WideNode<W>));
  auto* out = reinterpret_cast<WideNode<W>*>(layout.nodes.data());
  auto* blocks = reinterpret_cast<typename Blocks::Block*>(layout.triangles.data());
  const auto* const rows = static_cast<const char*>(mesh.indices ? mesh.indices : mesh.positions);
  const std::size_t row_stride = mesh.indices ? mesh.triangle_stride : 3 * mesh.vertex_stride;
  std::atomic<bool> good{true};
  executor.for_chunks(nodes, 64, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t first = tree.first_child[n], last = tree.first_child[n + 1];
      // The triangles of the next node are asked for now. (In a function of its own gcc 12 takes the loop for one
      // without effects and drops it.)
      const std::size_t next = n + 1 < end ? tree.first_child[n + 2] : last;
      for (std::size_t c = last; c < next; ++c)
        for (std::uint32_t i = 0; i < children[c].count; ++i)
          prefetch(rows + references[children[c].first + i] * row_stride);
      fill_node<W>(out[n], children.subspan(first, last - first), words.subspan(first, last - first));
      for (std::size_t c = first; c < last; ++c)
        if (const auto& child = children[c]; child.count != 0)
          if (!Blocks::fill(blocks + leaf_first(words[c]), references.subspan(child.first, child.count), mesh))
            return good.store(false, std::memory_order_relaxed);
    }
  });
  return good;
}

template <int W, class Blocks>
Result<Layout> encode(LayoutId id, const tree::WideTree& tree, const MeshView& mesh, Executor& executor) {
  return guard_memory([&]() -> Result<Layout> {
    Layout layout;
    layout.id = id;
    if (tree.children.empty()) return layout;
    layout.bounds = tree.bounds;
    layout.max_stack = tree.max_stack;
    layout.node_count = tree.first_child.size() - 1;
    layout.reference_count = tree.references.size();

    for (std::size_t n = 0; n < layout.node_count; ++n)
      if (tree.first_child[n + 1] - tree.first_child[n] > W)
        return {ErrorCode::malformed, "node " + std::to_string(n) + " of a wide tree of width " + std::to_string(W) +
                                          " has " + std::to_string(tree.first_child[n + 1] - tree.first_child[n]) +
                                          " children"};
    auto [children, words] = order_children<Blocks>(tree, mesh, executor);
    std::size_t blocks = 0;
    for (std::size_t c = 0; c < children.size(); ++c) {
      if (children[c].count == 0) continue;
      if (children[c].count > 32)
        return {ErrorCode::too_large, "a leaf of a wide layout holds at most 32 references, child " +
                                          std::to_string(c) + " has " + std::to_string(children[c].count)};
      ++layout.leaf_count;
      const std::uint32_t count = words[c];
      words[c] = leaf_word(static_cast<std::uint32_t>(blocks), count);
      blocks += count;
    }
    if (blocks > 1u << 28 || layout.node_count >= kLeafBit)
      return {ErrorCode::too_large,
              "a wide layout addresses at most 2^28 blocks of triangles, the tree needs " + std::to_string(blocks)};
    layout.triangles = AlignedBuffer<std::byte>(blocks * sizeof(typename Blocks::Block));
    layout.root = 0;
    if (!fill<W, Blocks>(layout, tree, children.span(), words.span(), mesh, executor))
      return check_references(tree.references, mesh, executor).error();
    return layout;
  });
}

}  // namespace

Result<Layout> encode_wide(const tree::WideTree& tree, const MeshView& mesh, Executor& executor) {
  if (tree.width == 4) return encode<4, TriangleBlocks>(LayoutId::wide4, tree, mesh, executor);
  if (tree.width == 8) return encode<8, TriangleBlocks>(LayoutId::wide8, tree, mesh, executor);
  if (tree.width == 16) return encode<16, TriangleBlocks>(LayoutId::wide16, tree, mesh, executor);
  return {ErrorCode::invalid_argument,
          "wide layouts have 4, 8 or 16 children a node, not " + std::to_string(tree.width)};
}

Result<Layout> encode_wide_quads(const tree::WideTree& tree, const MeshView& mesh, Executor& executor) {
  if (auto status = check_references(tree.references, mesh, executor); !status) return status.error();
  if (mesh.triangle_count > kQuadIdMask + std::size_t{1})
    return {ErrorCode::too_large,
            "layouts with quads hold meshes of at most 2^29 triangles, not " + std::to_string(mesh.triangle_count)};
  if (tree.width == 8) return encode<8, QuadBlocks>(LayoutId::wide8_quads, tree, mesh, executor);
  return {ErrorCode::invalid_argument, "layouts with quads have 8 children a node, not " + std::to_string(tree.width)};
}

}  // namespace boxwood::layouts
