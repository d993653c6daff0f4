// Layouts `wide4`, `wide8` and `wide16`: nodes that hold the boxes of all their children plane by plane, so that one
// SIMD operation tests them together (Dammertz, Hanika and Keller 2008, bib key qbvh; Ernst and Greiner 2008; Wald,
// Benthin and Boulos 2008), over blocks of four triangles stored the same way; `wide8-quads`, the
// same nodes over blocks of four quads (quads.cpp). O(nodes + triangles), deterministic, parallel.
#include <limits>
#include <vector>

#include "boxwood/layouts.h"
#include "layouts/encode.h"
#include "layouts/quads.h"

namespace boxwood::layouts {
namespace {

void fill_block(TriangleBlock& block, std::span<const std::uint32_t> references, const MeshView& mesh) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const bool used = lane < references.size();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const Vec3 unused{kNaN, kNaN, kNaN};
    const Triangle t = used ? mesh.triangle(references[lane]) : Triangle{unused, unused, unused};
    for (int axis = 0; axis < 3; ++axis) {
      block.corner[0][axis][lane] = t.v0[axis];
      block.corner[1][axis][lane] = t.v1[axis];
      block.corner[2][axis][lane] = t.v2[axis];
    }
    block.primitive[lane] = used ? references[lane] : kInvalidPrimitive;
  }
}

/// How leaves become blocks: of triangles, or of quads.
struct TriangleBlocks {
  using Block = TriangleBlock;
  static std::uint32_t count(std::span<const std::uint32_t> references, const MeshView&) {
    return static_cast<std::uint32_t>((references.size() + 3) / 4);
  }
  static void fill(Block* blocks, std::span<const std::uint32_t> references, const MeshView& mesh) {
    for (std::size_t done = 0; done < references.size(); done += 4)
      fill_block(blocks[done / 4], references.subspan(done, std::min<std::size_t>(4, references.size() - done)), mesh);
  }
};
struct QuadBlocks {
  using Block = QuadBlock;
  static std::uint32_t count(std::span<const std::uint32_t> references, const MeshView& mesh) {
    return quad_blocks(references, mesh);
  }
  static void fill(Block* blocks, std::span<const std::uint32_t> references, const MeshView& mesh) {
    fill_quads(blocks, references, mesh);
  }
};

template <int W>
void fill_node(WideNode<W>& node, std::span<const tree::WideTree::Child> children,
               std::span<const std::uint32_t> words) {
  for (std::size_t i = 0; i < W; ++i) {
    const Box box = i < children.size() ? children[i].bounds : Box{};
    for (int axis = 0; axis < 3; ++axis) {
      node.planes[2 * axis][i] = box.lower[axis];
      node.planes[2 * axis + 1][i] = box.upper[axis];
    }
    node.child[i] = i < children.size() ? words[i] : 0;
  }
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

using Children = AlignedBuffer<tree::WideTree::Child>;

/// The order in which an any-hit query tries the children of each node: likely to be met and cheap to search first, by
/// area / (1 + references), descending. Closest-hit queries go by distance and don't mind.
Children order_children(const tree::WideTree& tree, Executor& executor) {
  const auto below = count_references(tree);
  Children children(tree.children.size());
  executor.for_chunks(tree.first_child.size() - 1, 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<float> worth;
    for (std::size_t node = begin; node < end; ++node) {
      const std::uint32_t first = tree.first_child[node], count = tree.first_child[node + 1] - first;
      worth.resize(count);
      for (std::uint32_t i = 0; i < count; ++i) {  // insertion sort: few children, and equal ones stay in order
        const tree::WideTree::Child& child = tree.children[first + i];
        const float own = child.bounds.half_area() / (1.0f + static_cast<float>(below[first + i]));
        std::uint32_t place = i;
        for (; place > 0 && worth[place - 1] < own; --place) {
          worth[place] = worth[place - 1];
          children[first + place] = children[first + place - 1];
        }
        worth[place] = own;
        children[first + place] = child;
      }
    }
  });
  return children;
}

template <int W, class Blocks>
void fill(Layout& layout, const tree::WideTree& tree, std::span<const tree::WideTree::Child> children,
          std::span<const std::uint32_t> words, const MeshView& mesh, Executor& executor) {
  const std::span<const std::uint32_t> references = tree.references;
  const std::size_t nodes = tree.first_child.size() - 1;
  layout.nodes = AlignedBuffer<std::byte>(nodes * sizeof(WideNode<W>));
  auto* out = reinterpret_cast<WideNode<W>*>(layout.nodes.data());
  auto* blocks = reinterpret_cast<typename Blocks::Block*>(layout.triangles.data());
  executor.for_chunks(nodes, 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t first = tree.first_child[n], last = tree.first_child[n + 1];
      fill_node<W>(out[n], children.subspan(first, last - first), words.subspan(first, last - first));
      for (std::size_t c = first; c < last; ++c)
        if (const auto& child = children[c]; child.count != 0)
          Blocks::fill(blocks + leaf_first(words[c]), references.subspan(child.first, child.count), mesh);
    }
  });
}

/// The child words, with leaves one behind the other, and the number of blocks.
template <class Blocks>
std::pair<AlignedBuffer<std::uint32_t>, std::size_t> place_leaves(const tree::WideTree& tree, const Children& children,
                                                                  const MeshView& mesh, Executor& executor) {
  AlignedBuffer<std::uint32_t> words(children.size());
  executor.for_chunks(words.size(), 1024, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      words[c] = children[c].count == 0
                     ? children[c].first
                     : Blocks::count(std::span(tree.references).subspan(children[c].first, children[c].count), mesh);
  });
  std::size_t blocks = 0;
  for (std::size_t c = 0; c < words.size(); ++c) {
    if (children[c].count == 0) continue;
    const std::uint32_t count = words[c];
    words[c] = leaf_word(static_cast<std::uint32_t>(blocks), count);
    blocks += count;
  }
  return {std::move(words), blocks};
}

template <int W, class Blocks>
Result<Layout> encode(LayoutId id, const tree::WideTree& tree, const MeshView& mesh, Executor& executor) {
  return guard_memory([&]() -> Result<Layout> {
    Layout layout;
    layout.id = id;
    if (tree.children.empty()) return layout;
    if (auto status = check_references(tree.references, mesh, executor); !status) return status.error();
    layout.bounds = tree.bounds;
    layout.max_stack = tree.max_stack;
    layout.node_count = tree.first_child.size() - 1;
    layout.reference_count = tree.references.size();

    const Children children = order_children(tree, executor);
    for (std::size_t c = 0; c < children.size(); ++c) {
      if (children[c].count > 32)
        return {ErrorCode::too_large, "a leaf of a wide layout holds at most 32 references, child " +
                                          std::to_string(c) + " has " + std::to_string(children[c].count)};
      layout.leaf_count += children[c].count != 0;
    }
    const auto [words, blocks] = place_leaves<Blocks>(tree, children, mesh, executor);
    if (blocks > 1u << 28 || layout.node_count >= kLeafBit)
      return {ErrorCode::too_large,
              "a wide layout addresses at most 2^28 blocks of triangles, the tree needs " + std::to_string(blocks)};
    layout.triangles = AlignedBuffer<std::byte>(blocks * sizeof(typename Blocks::Block));
    layout.root = 0;
    fill<W, Blocks>(layout, tree, children.span(), words.span(), mesh, executor);
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
  if (mesh.triangle_count > kQuadIdMask + std::size_t{1})
    return {ErrorCode::too_large,
            "layouts with quads hold meshes of at most 2^29 triangles, not " + std::to_string(mesh.triangle_count)};
  if (tree.width == 8) return encode<8, QuadBlocks>(LayoutId::wide8_quads, tree, mesh, executor);
  return {ErrorCode::invalid_argument, "layouts with quads have 8 children a node, not " + std::to_string(tree.width)};
}

}  // namespace boxwood::layouts
