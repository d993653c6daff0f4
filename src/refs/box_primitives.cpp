// Primitives of which only their boxes are known.
#include "boxwood/refs.h"
#include "math/clip.h"

namespace boxwood::refs {
namespace {

class BoxPrimitives final : public Primitives {
 public:
  Box clip(const Reference& reference, const Box& box) const override { return intersection(reference.box(), box); }

  void cut(const Reference& reference, int axis, float position, Box& left, Box& right) const override {
    left = right = reference.box();
    left.upper[axis] = right.lower[axis] = position;
  }

  void chop(const Reference& reference, int axis, std::span<const float> positions,
            std::span<Box> parts) const override {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i] = reference.box();
      if (i > 0) parts[i].lower[axis] = positions[i - 1];
      if (i < positions.size()) parts[i].upper[axis] = positions[i];
    }
  }
};

}  // namespace

AlignedBuffer<mesh::EdgeLink> Primitives::edge_links(mesh::Weld, Executor&) const {
  return {};
}

AlignedBuffer<mesh::EdgeNeighbours> Primitives::edge_neighbours(mesh::Weld, Executor&) const {
  return {};
}

bool Primitives::share_edge(std::uint32_t, std::uint32_t, mesh::Weld) const {
  return false;
}

std::shared_ptr<const Primitives> box_primitives() {
  return std::make_shared<BoxPrimitives>();
}

}  // namespace boxwood::refs
