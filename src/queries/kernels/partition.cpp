// Packets that keep their active rays in front (Overbeck, Ramamoorthi and Mark 2008, bib key overbeck2008): at each
// node the numbers of the rays that meet its box are moved before those of the others, in place, and only they go on.
// What lies below a node permutes nothing but the numbers that were active there, so a node that waits on the stack
// needs to remember how many they were, not which. The packet as a whole is tested first, by bounds of all its rays.
// Ours differs: those bounds are intervals instead of a frustum. O(depth) stack, nothing random.
#include <numeric>

#include "queries/kernels/packet.h"

namespace boxwood::queries {
namespace {

class PartitionWalk {
 public:
  PartitionWalk(const Layout& layout, std::size_t packet_size) : stack_(layout.max_stack + 1), order_(packet_size) {}
  static std::size_t packet_size(const TraversalOptions& options) {
    return (options.packet_size + Packet::kGroup - 1) / Packet::kGroup * Packet::kGroup;
  }

  template <bool kRobust, bool kCount>
  void run(Packet& packet) {
    std::iota(order_.begin(), order_.end(), 0u);
    Entry* top = stack_.data();
    Entry entry{0, static_cast<std::uint32_t>(packet.size())};
    for (;;) {
      const LinearNode& node = packet.node(entry.node);
      if constexpr (kCount) ++packet.counts(0).packet_nodes;
      const std::uint32_t active = packet.may_meet(node.bounds) ? partition<kCount>(packet, node, entry.active) : 0;
      if (active && node.count_and_axis < 4) {
        const std::uint32_t index = entry.node;
        const bool second_first = packet.second_first(order_[0], node);
        *top++ = {second_first ? index + 1 : node.offset, active};
        entry = {second_first ? node.offset : index + 1, active};
        continue;
      }
      for (std::uint32_t i = 0; i < active; ++i) packet.test_leaf<kRobust, kCount>(node, order_[i]);
      packet.finish_leaf();
      if (top == stack_.data() || packet.all_done()) return;
      entry = *--top;
    }
  }

 private:
  struct Entry {
    std::uint32_t node, active;
  };

  /// Of the first `count` numbers, puts those of rays that meet the node's box in front; how many there are.
  template <bool kCount>
  std::uint32_t partition(Packet& packet, const LinearNode& node, std::uint32_t count) {
    std::uint32_t active = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t ray = order_[i];
      if constexpr (kCount) ++packet.counts(ray).nodes;
      // Without a branch on the outcome: whether a ray meets the box is what can't be foreseen here.
      const bool meets = packet.meets(ray, node.bounds);
      order_[i] = order_[active];
      order_[active] = ray;
      active += meets;
    }
    return active;
  }

  std::vector<Entry> stack_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

TraversalKernels partition_kernels(Mode mode) {
  return mode == Mode::robust ? make_packet_kernels<PartitionWalk, true>()
                              : make_packet_kernels<PartitionWalk, false>();
}

}  // namespace boxwood::queries
