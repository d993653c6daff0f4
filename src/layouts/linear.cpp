// Layout `linear`: PBRT's compact binary nodes (Pharr, Jakob and Humphreys 2016, bib key pbrt), depth first, the first
// child right behind its parent. Ours differs in two points: the triangle count has 30 bits instead of 16, so a leaf of
// any size works, and the split axis is found from the children's boxes, because a bottom-up tree has none.
// O(nodes + triangles), any depth.
#include <vector>

#include "boxwood/layouts.h"
#include "layouts/encode.h"

namespace boxwood::layouts {
namespace {

// The axis on which the children's centres lie farthest apart; traversal enters the lower one first when the ray
// goes upwards on it.
int separating_axis(const Box& a, const Box& b) {
  const Vec3 d = b.center() - a.center();
  const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  return x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
}

struct Pending {
  std::uint32_t node;    // of the tree
  std::uint32_t parent;  // in the layout, whose second child it is; kNoRoot: none
  std::uint32_t depth;
};

}  // namespace

Result<Layout> encode_linear(const tree::BinaryTree& tree, const MeshView& mesh, Executor& executor) {
  return guard_memory([&]() -> Result<Layout> {
    Layout layout;
    layout.id = LayoutId::linear;
    if (tree.empty()) return layout;
    if (tree.references.size() >= 1u << 30)
      return {ErrorCode::too_large, "the linear layout holds at most 2^30 - 1 references, the tree has " +
                                        std::to_string(tree.references.size())};
    if (auto status = check_references(tree.references.span(), mesh, executor); !status) return status.error();
    layout.root = 0;
    layout.bounds = tree.bounds();
    layout.node_count = tree.nodes.size();
    layout.reference_count = tree.references.size();
    layout.nodes = AlignedBuffer<std::byte>(tree.nodes.size() * sizeof(LinearNode));
    auto* nodes = reinterpret_cast<LinearNode*>(layout.nodes.data());

    std::uint32_t next = 0;
    std::vector<Pending> stack{{0, kNoRoot, 0}};
    while (!stack.empty()) {
      const Pending item = stack.back();
      stack.pop_back();
      const tree::Node& node = tree.nodes[item.node];
      if (item.parent != kNoRoot) nodes[item.parent].offset = next;
      LinearNode& out = nodes[next] = {node.bounds, node.first, node.count << 2};
      if (node.is_leaf()) {
        ++layout.leaf_count;
      } else {
        const Box &left = tree.nodes[node.first].bounds, &right = tree.nodes[node.first + 1].bounds;
        const int axis = separating_axis(left, right);
        const std::uint32_t first = left.center()[axis] <= right.center()[axis] ? 0 : 1;
        out.count_and_axis = static_cast<std::uint32_t>(axis);
        stack.push_back({node.first + 1 - first, next, item.depth + 1});
        stack.push_back({node.first + first, kNoRoot, item.depth + 1});
        layout.max_stack = std::max<std::size_t>(layout.max_stack, item.depth + 1);
      }
      ++next;
    }

    layout.triangles = AlignedBuffer<std::byte>(tree.references.size() * sizeof(LinearTriangle));
    auto* triangles = reinterpret_cast<LinearTriangle*>(layout.triangles.data());
    executor.for_chunks(tree.references.size(), 8192, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) triangles[i] = {mesh.triangle(tree.references[i]), tree.references[i]};
    });
    return layout;
  });
}

}  // namespace boxwood::layouts
