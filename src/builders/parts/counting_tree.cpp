#include "builders/parts/counting_tree.h"

#include <algorithm>

namespace boxwood::builders {
namespace {

constexpr std::uint32_t kLeafBoxes = 4;

Box box_of(const PlaneBox& box, const CandidatePlanes& planes) {
  Box out;
  for (int axis = 0; axis < 3; ++axis) {
    out.lower[axis] = planes.lower[axis][static_cast<std::size_t>(box.lower[axis])];
    out.upper[axis] = planes.upper[axis][static_cast<std::size_t>(box.upper[axis])];
  }
  return out;
}

bool are_apart(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (a.upper[i] < b.lower[i] || b.upper[i] < a.lower[i]) return true;
  return false;
}

/// Is there certainly a reference in a tight box that the children do not hold? A side of the box is one of some
/// reference, so both children must not be beyond it.
bool sticks_out(const Box& box, const Configuration& c) {
  for (int i = 0; i < 3; ++i)
    if (box.lower[i] < minimum(c.left.lower[i], c.right.lower[i]) ||
        box.upper[i] > maximum(c.left.upper[i], c.right.upper[i]))
      return true;
  return are_apart(box, c.left) && are_apart(box, c.right);
}

std::uint32_t part(std::vector<Box>& boxes, std::uint32_t begin, std::uint32_t end) {
  Box centroids;
  for (std::uint32_t i = begin; i < end; ++i) centroids.grow(boxes[i].lower + boxes[i].upper);
  const int axis = centroids.widest_axis();
  const float middle = centroids.center()[axis];
  const auto mid = std::stable_partition(boxes.begin() + begin, boxes.begin() + end,
                                         [&](const Box& box) { return box.lower[axis] + box.upper[axis] < middle; });
  const auto at = static_cast<std::uint32_t>(mid - boxes.begin());
  return at == begin || at == end ? begin + (end - begin) / 2 : at;
}

}  // namespace

CountingTree::CountingTree(std::span<const refs::Reference> references, const CandidatePlanes& planes)
    : planes_(planes) {
  boxes_.reserve(references.size());
  for (const refs::Reference& reference : references) boxes_.push_back(reference.box());
  struct Waiting {
    std::uint32_t begin, end;
  };
  std::vector<Waiting> stack{{0, static_cast<std::uint32_t>(boxes_.size())}};
  while (!stack.empty()) {
    const Waiting range = stack.back();
    stack.pop_back();
    Node node{{}, range.begin, range.end, 0, range.end - range.begin <= kLeafBoxes};
    for (std::uint32_t i = range.begin; i < range.end; ++i) node.bounds.grow(boxes_[i]);
    if (!node.is_leaf) {
      const std::uint32_t mid = part(boxes_, range.begin, range.end);
      stack.push_back({mid, range.end});
      stack.push_back({range.begin, mid});
    }
    nodes_.push_back(node);
  }
  // Depth first, the nodes below a node are those after it whose references begin before its end.
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i <= nodes_.size(); ++i) {
    const std::uint32_t begin = i < nodes_.size() ? nodes_[i].begin : UINT32_MAX;
    while (!open.empty() && nodes_[open.back()].end <= begin) {
      nodes_[open.back()].skip = i;
      open.pop_back();
    }
    open.push_back(i);
  }
}

SideCounts CountingTree::count(const PlaneBox& left, const PlaneBox& right, bool may_split) const {
  return count(Configuration{box_of(left, planes_), box_of(right, planes_)}, may_split);
}

SideCounts CountingTree::count(const Configuration& boxes, bool may_split) const {
  SideCounts counts;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const std::uint32_t size = node.end - node.begin;
    if (sticks_out(node.bounds, boxes)) return counts;
    const bool in_left = boxes.left.contains(node.bounds), in_right = boxes.right.contains(node.bounds);
    if (in_left && in_right) {
      counts.both += size, i = node.skip;
    } else if (in_left && are_apart(node.bounds, boxes.right)) {
      counts.left += size, i = node.skip;
    } else if (in_right && are_apart(node.bounds, boxes.left)) {
      counts.right += size, i = node.skip;
    } else if (!node.is_leaf) {
      ++i;
    } else {
      for (std::uint32_t k = node.begin; k < node.end; ++k) {
        const Side side = side_of(boxes_[k], boxes);
        if (side == Side::neither || (side == Side::split && !may_split)) return counts;
        ++(side == Side::both    ? counts.both
           : side == Side::left  ? counts.left
           : side == Side::right ? counts.right
                                 : counts.split);
      }
      i = node.skip;
    }
  }
  counts.covered = true;
  return counts;
}

}  // namespace boxwood::builders
