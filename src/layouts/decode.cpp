// From an encoded tree back to the tree and the triangles it was made of. Nodes keep their numbers and children their
// order; references stand in the order of the leaves' parents. O(nodes + references + largest primitive id).
#include <algorithm>
#include <vector>

#include "layouts/blocks.h"
#include "layouts/encode.h"

namespace boxwood::layouts {
namespace {

class Decoder {
 public:
  explicit Decoder(const Layout& layout) : layout_(layout) {
    out_.tree.bounds = layout.bounds;
    out_.tree.references.reserve(layout.reference_count);
    triangles_.reserve(layout.reference_count);
  }

  Decoded run() && {
    switch (layout_.id) {
      case LayoutId::linear:
        linear();
        break;
      case LayoutId::wide4:
        wide<4, TriangleBlock>();
        break;
      case LayoutId::wide8:
        wide<8, TriangleBlock>();
        break;
      case LayoutId::wide8_quads:
        wide<8, QuadBlock>();
        break;
      case LayoutId::wide16:
        wide<16, TriangleBlock>();
        break;
    }
    out_.tree.first_child.push_back(std::uint32_t(out_.tree.children.size()));
    out_.tree.max_stack = layout_.max_stack;
    std::uint32_t end = 0;
    for (const std::uint32_t id : out_.tree.references) end = std::max(end, id + 1);
    out_.triangles.resize(end);
    for (std::size_t i = 0; i < triangles_.size(); ++i) out_.triangles[out_.tree.references[i]] = triangles_[i];
    return std::move(out_);
  }

 private:
  void begin_node() { out_.tree.first_child.push_back(std::uint32_t(out_.tree.children.size())); }
  void add(std::uint32_t id, const Triangle& triangle) {
    out_.tree.references.push_back(id);
    triangles_.push_back(triangle);
  }
  void add_leaf(const Box& box, std::size_t first) {
    const std::size_t count = out_.tree.references.size() - first;
    out_.tree.children.push_back({box, std::uint32_t(first), std::uint32_t(count)});
  }

  template <int W, class Block>
  void wide() {
    out_.tree.width = W;
    const auto* nodes = reinterpret_cast<const WideNode<W>*>(layout_.nodes.data());
    for (std::size_t n = 0; n < layout_.node_count; ++n) {
      begin_node();
      for (int i = 0; i < W; ++i) {
        const auto& planes = nodes[n].planes;
        const Box box{{planes[0][i], planes[2][i], planes[4][i]}, {planes[1][i], planes[3][i], planes[5][i]}};
        if (box.is_empty()) break;  // unused children stand behind the used ones
        const std::uint32_t word = nodes[n].child[i];
        const std::size_t first = out_.tree.references.size();
        if (word & kLeafBit) {
          for_leaf_triangles<Block>(layout_, word, [&](std::uint32_t id, const Triangle& t) { add(id, t); });
          add_leaf(box, first);
        } else {
          out_.tree.children.push_back({box, word, 0});
        }
      }
    }
  }

  /// Inner nodes become nodes of two children, numbered in the order they stand in.
  void linear() {
    out_.tree.width = 2;
    const auto* nodes = reinterpret_cast<const LinearNode*>(layout_.nodes.data());
    const auto is_leaf = [&](std::size_t n) { return nodes[n].count_and_axis >> 2 != 0; };
    std::vector<std::uint32_t> number(layout_.node_count);
    std::uint32_t inner = 0;
    for (std::size_t n = 0; n < layout_.node_count; ++n) number[n] = is_leaf(n) ? 0 : inner++;
    const auto add_child = [&](std::size_t n) {
      if (!is_leaf(n)) return void(out_.tree.children.push_back({nodes[n].bounds, number[n], 0}));
      const auto* leaf = reinterpret_cast<const LinearTriangle*>(layout_.triangles.data()) + nodes[n].offset;
      const std::size_t first = out_.tree.references.size();
      for (std::uint32_t i = 0; i < nodes[n].count_and_axis >> 2; ++i) add(leaf[i].primitive, leaf[i].triangle);
      add_leaf(nodes[n].bounds, first);
    };
    if (layout_.node_count > 0 && is_leaf(0)) begin_node(), add_child(0);
    for (std::size_t n = 0; n < layout_.node_count; ++n) {
      if (is_leaf(n)) continue;
      begin_node();
      add_child(n + 1);
      add_child(nodes[n].offset);
    }
  }

  const Layout& layout_;
  Decoded out_;
  std::vector<Triangle> triangles_;  // by reference
};

}  // namespace

Result<Decoded> decode(const Layout& layout) {
  return guard_memory([&]() -> Result<Decoded> { return Decoder(layout).run(); });
}

}  // namespace boxwood::layouts
