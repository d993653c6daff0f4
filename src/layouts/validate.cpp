// The checker of encoded trees: decodes every node and triangle and holds them against the tree and the mesh.
#include <cstring>
#include <vector>

#include "boxwood/layouts.h"
#include "layouts/encode.h"

namespace boxwood::layouts {
namespace {

/// One decoded entry of the walk: a node or leaf with the box its parent gives it.
struct Item {
  std::uint32_t word;
  Box box;
  std::size_t waiting;  // entries on a traversal's stack when it comes here
};

class Checker {
 public:
  Checker(const Layout& layout, bool splits, const MeshView& mesh)
      : layout_(layout), splits_(splits), mesh_(mesh), found_(mesh.triangle_count, 0) {}

  Status run(std::span<const std::uint32_t> references) {
    if (layout_.root == kNoRoot) {
      if (!references.empty() || layout_.node_count)
        return bad("it has no root but " + std::to_string(references.size()) + " references");
      return {};
    }
    std::vector<std::size_t> expected(found_.size());
    for (std::uint32_t id : references) {
      if (id >= found_.size()) return bad("reference " + std::to_string(id) + " is past the mesh");
      ++expected[id];
    }
    stack_.push_back({layout_.root, layout_.bounds, 0});
    while (!stack_.empty()) {
      const Item item = stack_.back();
      stack_.pop_back();
      const int children = width(layout_.id);
      Status status = children == 2   ? linear(item)
                      : children == 4 ? wide<4>(item)
                      : children == 8 ? wide<8>(item)
                                      : wide<16>(item);
      if (!status) return status;
    }
    if (nodes_ != layout_.node_count)
      return bad(std::to_string(nodes_) + " nodes can be reached, node_count says " +
                 std::to_string(layout_.node_count));
    for (std::size_t id = 0; id < found_.size(); ++id) {
      // Parts of a primitive that meet in one leaf are one reference there.
      const std::size_t least = splits_ ? std::min<std::size_t>(expected[id], 1) : expected[id];
      if (found_[id] < least || found_[id] > expected[id])
        return bad("triangle " + std::to_string(id) + " stands there " + std::to_string(found_[id]) +
                   " times, expected are " + std::to_string(expected[id]) + (splits_ ? " or fewer" : ""));
    }
    return {};
  }

 private:
  static Status bad(std::string what) { return {ErrorCode::malformed, "invalid layout: " + std::move(what)}; }

  Status triangle(const Triangle& t, std::uint32_t id, const Box& box) {
    if (id >= mesh_.triangle_count) return bad("triangle id " + std::to_string(id) + " is past the mesh");
    ++found_[id];
    const Triangle expected = mesh_.triangle(id);
    if (std::memcmp(&t, &expected, sizeof t) != 0)
      return bad("triangle " + std::to_string(id) + " differs from the mesh's");
    const Box b = t.bounds();
    const bool meets = minimum(b.upper, box.upper) == maximum(minimum(b.upper, box.upper), maximum(b.lower, box.lower));
    if (splits_ ? !meets : !box.contains(b))
      return bad("triangle " + std::to_string(id) + " sticks out of its leaf's box");
    return {};
  }

  Status linear(const Item& item) {
    if (item.word >= layout_.nodes.size() / sizeof(LinearNode))
      return bad("node " + std::to_string(item.word) + " is past the array");
    const auto& node = reinterpret_cast<const LinearNode*>(layout_.nodes.data())[item.word];
    ++nodes_;
    if (!item.box.contains(node.bounds)) return bad("node " + std::to_string(item.word) + " sticks out of its parent");
    const std::uint32_t count = node.count_and_axis >> 2;
    if (count == 0) {
      if (node.offset <= item.word + 1)
        return bad("second child of node " + std::to_string(item.word) + " does not follow it");
      if (item.waiting + 1 > layout_.max_stack) return bad("max_stack is too small");
      stack_.push_back({node.offset, node.bounds, item.waiting});
      stack_.push_back({item.word + 1, node.bounds, item.waiting + 1});
      return {};
    }
    if (node.offset + std::size_t{count} > layout_.triangles.size() / sizeof(LinearTriangle))
      return bad("leaf " + std::to_string(item.word) + " reaches past the triangles");
    const auto* triangles = reinterpret_cast<const LinearTriangle*>(layout_.triangles.data()) + node.offset;
    for (std::uint32_t i = 0; i < count; ++i)
      if (Status s = triangle(triangles[i].triangle, triangles[i].primitive, node.bounds); !s) return s;
    return {};
  }

  Status leaf(const Item& item) {
    const std::size_t first = leaf_first(item.word), count = leaf_blocks(item.word);
    if (first + count > layout_.triangles.size() / sizeof(TriangleBlock)) return bad("a leaf reaches past the blocks");
    const auto* blocks = reinterpret_cast<const TriangleBlock*>(layout_.triangles.data()) + first;
    for (std::size_t b = 0; b < count; ++b) {
      const TriangleBlock& block = blocks[b];
      for (int lane = 0; lane < 4; ++lane) {
        if (block.primitive[lane] == kInvalidPrimitive) {
          if (lane == 0 || b + 1 != count || !std::isnan(block.corner[0][0][lane]))
            return bad("an unused lane is not at a leaf's end");
          continue;
        }
        Triangle t;
        for (int axis = 0; axis < 3; ++axis) {
          t.v0[axis] = block.corner[0][axis][lane];
          t.v1[axis] = block.corner[1][axis][lane];
          t.v2[axis] = block.corner[2][axis][lane];
        }
        if (Status s = triangle(t, block.primitive[lane], item.box); !s) return s;
      }
    }
    return {};
  }

  Status quad_leaf(const Item& item) {
    const std::size_t first = leaf_first(item.word), count = leaf_blocks(item.word);
    if (first + count > layout_.triangles.size() / sizeof(QuadBlock)) return bad("a leaf reaches past the blocks");
    const auto* blocks = reinterpret_cast<const QuadBlock*>(layout_.triangles.data()) + first;
    for (std::size_t b = 0; b < count; ++b)
      for (int lane = 0; lane < 8; ++lane) {
        const QuadBlock& block = blocks[b];
        const std::uint32_t word = block.primitive[lane];
        if (word == kInvalidPrimitive) {
          const bool lone = lane >= 4 && block.primitive[lane - 4] != kInvalidPrimitive;
          if (!std::isnan(block.apex[0][lane]) || (!lone && (lane == 0 || b + 1 != count)))
            return bad("an unused lane is not at a leaf's end");
          continue;
        }
        if (block.primitive[lane & 3] == kInvalidPrimitive ||
            (lane % 4 && block.primitive[lane % 4 - 1] == kInvalidPrimitive))
          return bad("a quad stands behind an unused lane");
        if ((word >> 29 & 3) == 3) return bad("a quad's corners are turned by three places");
        float corner[3][3];
        for (int k = 0; k < 3; ++k)
          for (int axis = 0; axis < 3; ++axis) {
            const int place = quad_corner_place(word, k);
            corner[k][axis] = place == 0 ? block.apex[axis][lane] : block.edge[place - 1][axis][lane & 3];
          }
        Triangle t;
        static_assert(sizeof t == sizeof corner);
        std::memcpy(&t, corner, sizeof t);
        if (Status s = triangle(t, word & kQuadIdMask, item.box); !s) return s;
      }
    return {};
  }

  template <int W>
  Status wide(const Item& item) {
    if (item.word & kLeafBit) return has_quads(layout_.id) ? quad_leaf(item) : leaf(item);
    if (item.word >= layout_.nodes.size() / sizeof(WideNode<W>))
      return bad("node " + std::to_string(item.word) + " is past the array");
    const auto& node = reinterpret_cast<const WideNode<W>*>(layout_.nodes.data())[item.word];
    ++nodes_;
    int used = 0;
    for (int i = 0; i < W; ++i) {
      const Box box{{node.planes[0][i], node.planes[2][i], node.planes[4][i]},
                    {node.planes[1][i], node.planes[3][i], node.planes[5][i]}};
      if (box.is_empty()) continue;
      if (used != i) return bad("an unused child of node " + std::to_string(item.word) + " stands before a used one");
      if (!item.box.contains(box))
        return bad("child " + std::to_string(i) + " of node " + std::to_string(item.word) + " sticks out");
      if (!(node.child[i] & kLeafBit) && node.child[i] <= item.word)
        return bad("child " + std::to_string(i) + " of node " + std::to_string(item.word) + " stands before it");
      ++used;
    }
    if (used == 0) return bad("node " + std::to_string(item.word) + " has no children");
    const std::size_t waiting = item.waiting + static_cast<std::size_t>(used) - 1;
    if (waiting + 1 > layout_.max_stack) return bad("max_stack is too small");
    for (int i = 0; i < used; ++i)
      stack_.push_back({node.child[i],
                        Box{{node.planes[0][i], node.planes[2][i], node.planes[4][i]},
                            {node.planes[1][i], node.planes[3][i], node.planes[5][i]}},
                        waiting});
    return {};
  }

  const Layout& layout_;
  const bool splits_;
  const MeshView& mesh_;
  std::vector<std::size_t> found_;  // by triangle: references to it
  std::vector<Item> stack_;
  std::size_t nodes_ = 0;
};

}  // namespace

Status validate(const Layout& layout, std::span<const std::uint32_t> references, bool splits_references,
                const MeshView& mesh) {
  return guard_memory([&]() -> Status { return Checker(layout, splits_references, mesh).run(references); });
}

}  // namespace boxwood::layouts
