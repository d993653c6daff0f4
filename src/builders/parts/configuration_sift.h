// Sifting: brings references into the two boxes of a configuration, cutting those that it splits, and measures what
// comes out (Popov et al. 2009, bib key popov2009, sections 4.1 and 4.4).
#pragma once

#include <span>
#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/configuration.h"

namespace boxwood::builders {

/// What one side of a partition holds.
struct SiftedSide {
  std::size_t count = 0;
  Box bounds;
};

class Sifter {
 public:
  Sifter(const refs::Primitives& primitives, const Configuration& boxes, float area_scale)
      : primitives_(primitives),
        boxes_(boxes),
        left_is_smaller_(scaled_half_area(boxes.left, area_scale) <= scaled_half_area(boxes.right, area_scale)) {}

  /// The parts of a reference that go left and right; empty boxes where nothing goes.
  void place(const refs::Reference& reference, Box& left, Box& right) const {
    left = right = Box{};
    switch (side_of(reference.box(), boxes_)) {
      case Side::both:
        (left_is_smaller_ ? left : right) = reference.box();
        break;
      case Side::left:
        left = reference.box();
        break;
      case Side::right:
        right = reference.box();
        break;
      case Side::split:
        cut(reference, left, right);
        break;
      case Side::neither:  // not of a configuration that was checked; nothing may get lost all the same
        (left_is_smaller_ ? right : left) = reference.box();
        break;
    }
  }

  /// Counts and tight boxes, without moving anything.
  void measure(std::span<const refs::Reference> references, SiftedSide& left, SiftedSide& right) const {
    for (const refs::Reference& reference : references) {
      Box to_left, to_right;
      place(reference, to_left, to_right);
      if (!to_left.is_empty()) ++left.count, left.bounds.grow(to_left);
      if (!to_right.is_empty()) ++right.count, right.bounds.grow(to_right);
    }
  }

  /// Appends the parts to both sides, in order.
  void sift(std::span<const refs::Reference> references, std::vector<refs::Reference>& left,
            std::vector<refs::Reference>& right) const {
    for (const refs::Reference& reference : references) {
      Box to_left, to_right;
      place(reference, to_left, to_right);
      if (!to_left.is_empty()) left.push_back({to_left.lower, reference.primitive, to_left.upper, 0});
      if (!to_right.is_empty()) right.push_back({to_right.lower, reference.primitive, to_right.upper, 0});
    }
  }

 private:
  /// At the inner side of the smaller child, where that is the one that is used up first.
  void cut(const refs::Reference& reference, Box& left, Box& right) const {
    const int axis = shared_axis(reference.box(), boxes_);
    const bool left_is_lower = boxes_.left.lower[axis] <= reference.lower[axis];
    const Box &lower = left_is_lower ? boxes_.left : boxes_.right, &upper = left_is_lower ? boxes_.right : boxes_.left;
    const float position = left_is_smaller_ == left_is_lower ? lower.upper[axis] : upper.lower[axis];
    primitives_.cut(reference, axis, position, left_is_lower ? left : right, left_is_lower ? right : left);
  }

  const refs::Primitives& primitives_;
  const Configuration& boxes_;
  bool left_is_smaller_;
};

}  // namespace boxwood::builders
