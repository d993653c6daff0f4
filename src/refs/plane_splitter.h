// Pre-splits that halve boxes by planes; they differ in what makes a box too large.
#pragma once

#include <array>

#include "refs/presplit_passes.h"

namespace boxwood::refs {

/// Cuts a reference at the centre of its box's longest axis while Measure::of(box) exceeds the threshold, and boxes
/// what lies on each side. Parts stop at 48 cuts, and where a box's centre is on its border for want of digits.
template <class Measure>
struct PlaneSplitter {
  static constexpr std::uint32_t kDeepestCut = 48;

  const Primitives& primitives;
  double threshold;

  struct Waiting {
    Reference reference;
    std::uint32_t depth = 0;
  };

  bool is_too_large(const Box& box) const { return Measure::of(box) > threshold; }

  /// False when the part is small enough, or can't be made smaller.
  bool cut(const Waiting& part, Box& left, Box& right) const {
    const Box box = part.reference.box();
    if (part.depth >= kDeepestCut || !is_too_large(box)) return false;
    const int axis = box.widest_axis();
    const float position = box.center()[axis];
    if (!(position > box.lower[axis] && position < box.upper[axis])) return false;
    primitives.cut(part.reference, axis, position, left, right);
    return true;
  }

  template <class Sink>
  void operator()(const Reference& reference, Sink& sink) const {
    if (!is_too_large(reference.box())) {  // nearly all: spare them the stack
      sink.part(reference.box());
      return;
    }
    std::array<Waiting, kDeepestCut + 1> stack;
    std::size_t waiting = 0;
    stack[waiting++] = {reference};
    while (waiting > 0 && !sink.is_full()) {
      const Waiting part = stack[--waiting];
      Box left, right;
      if (!cut(part, left, right)) {
        sink.part(part.reference.box());
        continue;
      }
      if (!left.is_empty() && !right.is_empty()) sink.cut(part.reference.box(), left, right);
      for (const Box& side : {right, left})  // the left one is on top
        if (!side.is_empty()) stack[waiting++] = {{side.lower, reference.primitive, side.upper, 0}, part.depth + 1};
    }
  }
};

}  // namespace boxwood::refs
