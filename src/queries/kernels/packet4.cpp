// Packets of four rays (Wald, Slusallek, Benthin and Wagner 2001, bib key wald2001, for kd-trees): all four go
// through the tree together, one instruction testing the four against a box, and a mask says whose box was met. Ours
// differs: the mask goes onto the stack with a node, so that what is counted for a ray is what it would have done
// alone; directions may differ in sign; triangles are tested ray by ray. O(depth) stack, nothing random.
#include <bit>

#include "queries/kernels/packet.h"

namespace boxwood::queries {
namespace {

class Packet4Walk {
 public:
  Packet4Walk(const Layout& layout, std::size_t) : stack_(layout.max_stack + 1) {}
  static std::size_t packet_size(const TraversalOptions&) { return Packet::kGroup; }

  template <bool kRobust, bool kCount>
  void run(Packet& packet) {
    Entry* top = stack_.data();
    Entry entry{0, 15};
    for (;;) {
      const LinearNode& node = packet.node(entry.node);
      if constexpr (kCount) count(packet, entry.mask);
      const Packet::Mask mask = packet.meets_four(0, node.bounds) & entry.mask;
      if (mask && node.count_and_axis < 4) {
        const auto first = static_cast<std::size_t>(std::countr_zero(mask));
        const std::uint32_t index = entry.node;
        const bool second_first = packet.second_first(first, node);
        *top++ = {second_first ? index + 1 : node.offset, mask};
        entry = {second_first ? node.offset : index + 1, mask};
        continue;
      }
      for (Packet::Mask left = mask; left; left &= left - 1)
        packet.test_leaf<kRobust, kCount>(node, static_cast<std::size_t>(std::countr_zero(left)));
      packet.finish_leaf();
      if (top == stack_.data() || packet.all_done()) return;
      entry = *--top;
    }
  }

 private:
  struct Entry {
    std::uint32_t node;
    Packet::Mask mask;
  };

  static void count(Packet& packet, Packet::Mask mask) {
    ++packet.counts(0).packet_nodes;
    for (std::size_t i = 0; i < Packet::kGroup; ++i) packet.counts(i).nodes += mask >> i & 1;
  }

  std::vector<Entry> stack_;
};

}  // namespace

TraversalKernels packet4_kernels(Mode mode) {
  return mode == Mode::robust ? make_packet_kernels<Packet4Walk, true>() : make_packet_kernels<Packet4Walk, false>();
}

}  // namespace boxwood::queries
