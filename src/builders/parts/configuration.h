// Configurations of Popov, Georgiev, Dimov and Slusallek 2009 (bib key popov2009): the boxes of two children, which
// decide by themselves where each reference goes.
#pragma once

#include <algorithm>
#include <utility>

#include "boxwood/math.h"
#include "builders/parts/area_scale.h"

namespace boxwood::builders {

struct Configuration {
  Box left, right;
};

/// Where a configuration puts a box. `split`: inside both children together, in none alone.
enum class Side { neither, left, right, both, split };

/// The axis across which the two children share `box`, which is inside none of them: on it they meet and together reach
/// over the box, on the other two the box is inside both. -1: they do not cover the box.
inline int shared_axis(const Box& box, const Configuration& boxes) {
  int axis = -1;
  for (int i = 0; i < 3; ++i) {
    const Box &l = boxes.left, &r = boxes.right;
    const bool inside_both = maximum(l.lower[i], r.lower[i]) <= box.lower[i] &&  //
                             minimum(l.upper[i], r.upper[i]) >= box.upper[i];
    if (inside_both) continue;
    const bool covered = minimum(l.lower[i], r.lower[i]) <= box.lower[i] &&
                         maximum(l.upper[i], r.upper[i]) >= box.upper[i] &&
                         maximum(l.lower[i], r.lower[i]) <= minimum(l.upper[i], r.upper[i]);
    if (!covered || axis >= 0) return -1;
    axis = i;
  }
  return axis;
}

inline Side side_of(const Box& box, const Configuration& boxes) {
  const bool in_left = boxes.left.contains(box), in_right = boxes.right.contains(box);
  if (in_left) return in_right ? Side::both : Side::left;
  if (in_right) return Side::right;
  return shared_axis(box, boxes) >= 0 ? Side::split : Side::neither;
}

/// V(L n R) / V(N). An axis on which the node is flat does not count, so flat nodes have a share too.
inline double overlap_share(const Box& left, const Box& right, const Box& node) {
  double share = 1;
  for (int i = 0; i < 3; ++i) {
    const double both = static_cast<double>(minimum(left.upper[i], right.upper[i])) -
                        static_cast<double>(maximum(left.lower[i], right.lower[i]));
    const double whole = static_cast<double>(node.upper[i]) - static_cast<double>(node.lower[i]);
    if (both < 0) return 0;
    if (whole > 0) share *= both / whole;
  }
  return share;
}

}  // namespace boxwood::builders
