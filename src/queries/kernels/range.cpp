// Packets that keep a range of rays (Wald, Boulos and Shirley 2007, bib key waldboulos2007; the cull by interval
// arithmetic from Boulos, Wald and Shirley 2006, boulos2006). At each node the packet as a whole is tested first, by
// bounds of all its rays; then the first ray that meets the box is looked for from the front. Rays before it are out
// below this node, those behind it are taken to be in without a test until a leaf, where each is asked. Ours differs:
// four rays are tested at a time and counted so, the end of the range is not searched for, and directions may differ in
// sign, which only makes the cull weaker. O(depth) stack, nothing random.
#include <bit>

#include "queries/kernels/packet.h"

namespace boxwood::queries {
namespace {

class RangeWalk {
 public:
  RangeWalk(const Layout& layout, std::size_t) : stack_(layout.max_stack + 1) {}
  static std::size_t packet_size(const TraversalOptions& options) {
    return (options.packet_size + Packet::kGroup - 1) / Packet::kGroup * Packet::kGroup;
  }

  template <bool kRobust, bool kCount>
  void run(Packet& packet) {
    Entry* top = stack_.data();
    Entry entry{0, 0};
    for (;;) {
      const LinearNode& node = packet.node(entry.node);
      if constexpr (kCount) ++packet.counts(0).packet_nodes;
      if (packet.may_meet(node.bounds)) {
        if (node.count_and_axis >= 4) {
          visit_leaf<kRobust, kCount>(packet, node, entry.first);
        } else if (const auto first = find_first<kCount>(packet, node.bounds, entry.first); first < packet.size()) {
          const std::uint32_t index = entry.node, from = static_cast<std::uint32_t>(first);
          const bool second_first = packet.second_first(first, node);
          *top++ = {second_first ? index + 1 : node.offset, from};
          entry = {second_first ? node.offset : index + 1, from};
          continue;
        }
      }
      if (top == stack_.data() || packet.all_done()) return;
      entry = *--top;
    }
  }

 private:
  struct Entry {
    std::uint32_t node, first;  // first: ray before which none is active
  };

  template <bool kCount>
  static Packet::Mask test(Packet& packet, const Box& box, std::size_t group, std::size_t first) {
    const Packet::Mask within = group < first ? 15u << (first - group) & 15u : 15u;
    if constexpr (kCount)
      for (std::size_t i = 0; i < Packet::kGroup; ++i) packet.counts(group + i).nodes += within >> i & 1;
    return packet.meets_four(group, box) & within;
  }

  template <bool kCount>
  static std::size_t find_first(Packet& packet, const Box& box, std::size_t first) {
    for (std::size_t group = first / Packet::kGroup * Packet::kGroup; group < packet.size(); group += Packet::kGroup)
      if (const Packet::Mask mask = test<kCount>(packet, box, group, first))
        return group + static_cast<std::size_t>(std::countr_zero(mask));
    return packet.size();
  }

  template <bool kRobust, bool kCount>
  static void visit_leaf(Packet& packet, const LinearNode& leaf, std::size_t first) {
    for (std::size_t group = first / Packet::kGroup * Packet::kGroup; group < packet.size(); group += Packet::kGroup)
      for (Packet::Mask mask = test<kCount>(packet, leaf.bounds, group, first); mask; mask &= mask - 1)
        packet.test_leaf<kRobust, kCount>(leaf, group + static_cast<std::size_t>(std::countr_zero(mask)));
    packet.finish_leaf();
  }

  std::vector<Entry> stack_;
};

}  // namespace

TraversalKernels range_kernels(Mode mode) {
  return mode == Mode::robust ? make_packet_kernels<RangeWalk, true>() : make_packet_kernels<RangeWalk, false>();
}

}  // namespace boxwood::queries
