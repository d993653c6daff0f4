// The same encoded tree with its children in another order within their nodes and its nodes and blocks in another order
// in memory. O(nodes + blocks).
#include <cstring>
#include <string>
#include <vector>

#include "layouts/encode.h"

namespace boxwood::layouts {
namespace {

template <int W>
Layout arranged(const Layout& from, const Arrangement& how, std::size_t block_bytes) {
  Layout to;
  to.id = from.id;
  to.root = 0;
  to.bounds = from.bounds;
  to.max_stack = from.max_stack;
  to.node_count = from.node_count, to.leaf_count = from.leaf_count, to.reference_count = from.reference_count;
  to.nodes = AlignedBuffer<std::byte>(from.nodes.size());
  to.triangles = AlignedBuffer<std::byte>(from.triangles.size());
  std::memset(to.nodes.data(), 0, to.nodes.bytes());  // nodes have bytes at their end that hold nothing
  const auto* in = reinterpret_cast<const WideNode<W>*>(from.nodes.data());
  auto* out = reinterpret_cast<WideNode<W>*>(to.nodes.data());
  std::vector<std::uint32_t> place(from.node_count);
  for (std::uint32_t n = 0; n < how.nodes.size(); ++n) place[how.nodes[n]] = n;
  std::uint32_t next_block = 0;
  for (std::size_t n = 0; n < how.nodes.size(); ++n) {
    const WideNode<W>& node = in[how.nodes[n]];
    for (std::size_t lane = 0; lane < W; ++lane) {
      const std::size_t old = how.lanes[how.nodes[n] * W + lane];
      for (int p = 0; p < 6; ++p) out[n].planes[p][lane] = node.planes[p][old];
      std::uint32_t word = node.child[old];
      const bool used = node.planes[0][old] <= node.planes[1][old];
      if (used && word & kLeafBit) {
        const std::uint32_t count = leaf_blocks(word);
        std::memcpy(to.triangles.data() + next_block * block_bytes,
                    from.triangles.data() + leaf_first(word) * block_bytes, count * block_bytes);
        word = leaf_word(next_block, count);
        next_block += count;
      } else if (used) {
        word = place[word];
      }
      out[n].child[lane] = word;
    }
  }
  return to;
}

}  // namespace

Result<Layout> arrange(const Layout& layout, const Arrangement& arrangement) {
  const auto width = static_cast<std::size_t>(layouts::width(layout.id));
  if (layout.id == LayoutId::linear)
    return {ErrorCode::unsupported, "the layout linear has its order from its format and can't be arranged"};
  if (arrangement.nodes.size() != layout.node_count || arrangement.lanes.size() != layout.node_count * width)
    return {ErrorCode::invalid_argument, "the arrangement is of " + std::to_string(arrangement.nodes.size()) +
                                             " nodes, the layout has " + std::to_string(layout.node_count)};
  return guard_memory([&]() -> Result<Layout> {
    if (layout.node_count == 0) {
      Layout empty;
      empty.id = layout.id;
      return empty;
    }
    const std::size_t block = has_quads(layout.id) ? sizeof(QuadBlock) : sizeof(TriangleBlock);
    return width == 4   ? arranged<4>(layout, arrangement, block)
           : width == 8 ? arranged<8>(layout, arrangement, block)
                        : arranged<16>(layout, arrangement, block);
  });
}

}  // namespace boxwood::layouts
