// A split by a plane that may cut references.
#pragma once

#include "builders/parts/sift.h"

namespace boxwood::builders {

/// A plane that parts references: those below it go left, those above it right, those that it cuts go to both.
struct PlaneSplit {
  int axis = -1;  ///< -1: there is none
  float position = 0;
  bool flat_left = true;            ///< boxes that lie flat in the plane go left, otherwise right
  std::size_t left = 0, right = 0;  ///< references on each side; cut ones count twice
  double cost = kInfinity;          ///< area * count of both sides, added, in scaled areas

  bool exists() const { return axis >= 0; }
  bool is_left(const refs::Reference& reference) const {
    return reference.upper[axis] < position ||
           (reference.upper[axis] == position && (reference.lower[axis] < position || flat_left));
  }
  bool is_right(const refs::Reference& reference) const { return reference.lower[axis] >= position; }
  /// What becomes of a reference.
  Sides sides(const refs::Reference& reference, const refs::Primitives& primitives) const {
    if (is_left(reference)) return Sides::only_left(reference);
    if (is_right(reference)) return Sides::only_right(reference);
    Sides sides;
    primitives.cut(reference, axis, position, sides.left, sides.right);
    return sides;
  }
};

}  // namespace boxwood::builders
