// The box of all that lies on one side of a plane that moves away from that side, parts of cut references included.
#pragma once

#include <vector>

#include "boxwood/refs.h"

namespace boxwood::builders {

/// Parts only grow as the plane moves on, so a reference whose box across the axis is already covered need not be cut
/// again: what stays in the queue (the priority queue of Popov et al. 2009, 5.2) is what may still widen the box.
class SideBox {
 public:
  /// The side below the plane (`below`) or above it.
  SideBox(const refs::Primitives& primitives, int axis, bool below)
      : primitives_(primitives), axis_(axis), below_(below) {}

  /// A reference that lies on this side altogether from now on.
  void add(const refs::Reference& reference) { box_.grow(reference.box()); }

  /// A reference whose first side the plane has reached; it will be cut until it is added.
  void begin(const refs::Reference& reference) {
    Box first = reference.box();
    (below_ ? first.upper : first.lower)[axis_] = (below_ ? first.lower : first.upper)[axis_];
    if (box_.contains(first)) return;
    if (queue_.size() < kMostCut)
      queue_.push_back(&reference);
    else
      box_.grow(first);  // too large at worst, and the time stays linear
  }

  /// To be called when all references that end here were added.
  void move_to(float position) {
    std::size_t kept = 0;
    for (const refs::Reference* reference : queue_) {
      if (covers_across(*reference)) continue;  // as all that were added are
      Box below, above;
      primitives_.cut(*reference, axis_, position, below, above);
      box_.grow(below_ ? below : above);
      queue_[kept++] = reference;
    }
    queue_.resize(kept);
  }

  /// The box where the plane is now; `cuts`: it cuts references.
  Box at(float position, bool cuts) const {
    Box box = box_;
    if (cuts && !box.is_empty()) (below_ ? box.upper : box.lower)[axis_] = position;
    return box;
  }

 private:
  static constexpr std::size_t kMostCut = 32;

  bool covers_across(const refs::Reference& reference) const {
    for (int axis = 0; axis < 3; ++axis)
      if (axis != axis_ && !(box_.lower[axis] <= reference.lower[axis] && reference.upper[axis] <= box_.upper[axis]))
        return false;
    return true;
  }

  const refs::Primitives& primitives_;
  int axis_;
  bool below_;
  Box box_;
  std::vector<const refs::Reference*> queue_;
};

}  // namespace boxwood::builders
