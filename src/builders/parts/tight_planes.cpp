#include "builders/parts/tight_planes.h"

#include <algorithm>

namespace boxwood::builders {
namespace {

/// References in the order of one of their sides on an axis.
struct Side {
  struct Key {
    float at;
    std::uint32_t index;
  };
  std::vector<Key> keys;
  std::vector<Box> before;  ///< [i]: around the first i
  std::vector<Box> after;   ///< [i]: around all from the i-th on

  Side(std::span<const refs::Reference> references, int axis, bool upper) {
    const std::size_t count = references.size();
    keys.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      keys[i] = {upper ? references[i].upper[axis] : references[i].lower[axis], static_cast<std::uint32_t>(i)};
    std::sort(keys.begin(), keys.end(),
              [](const Key& a, const Key& b) { return a.at != b.at ? a.at < b.at : a.index < b.index; });
    before.resize(count + 1), after.resize(count + 1);
    for (std::size_t i = 0; i < count; ++i) before[i + 1] = merge(before[i], references[keys[i].index].box());
    for (std::size_t i = count; i-- > 0;) after[i] = merge(after[i + 1], references[keys[i].index].box());
  }
};

class AxisPlanes {
 public:
  AxisPlanes(std::span<const refs::Reference> references, const Box& node, int axis, const ConfigurationPrice& price)
      : count_(references.size()),
        node_(node),
        axis_(axis),
        price_(price),
        lower_(references, axis, false),
        upper_(references, axis, true) {
    for (const refs::Reference& reference : references)
      if (reference.lower[axis] == reference.upper[axis]) flat_.push_back(reference.lower[axis]);
    std::sort(flat_.begin(), flat_.end());
  }

  TightPlanes find(double limit) {
    TightPlanes found;
    const std::vector<Side::Key>&lower = lower_.keys, &upper = upper_.keys;
    for (std::size_t i = 0, k = 0; i < count_ || k < count_;) {
      const float position = i < count_ && lower[i].at <= upper[k].at ? lower[i].at : upper[k].at;
      begins_below_ = i, ends_below_ = k;
      while (i < count_ && lower[i].at <= position) ++i;
      while (k < count_ && upper[k].at <= position) ++k;
      begins_at_ = i, ends_at_ = k;
      if (node_.lower[axis_] < position && position < node_.upper[axis_]) consider(position, limit, found);
    }
    return found;
  }

 private:
  void consider(float position, double limit, TightPlanes& found) const {
    const auto flat_range = std::equal_range(flat_.begin(), flat_.end(), position);
    const auto flat = static_cast<std::size_t>(flat_range.second - flat_range.first);
    const std::size_t left = begins_below_, right = count_ - ends_at_, split = left + right + flat - count_;
    if (left == count_ || right == count_) return;
    const auto cost = [&](double left_area, double right_area) {
      return left_area * static_cast<double>(left) + right_area * static_cast<double>(right) +
             std::min(left_area, right_area) * static_cast<double>(flat);
    };
    // Split references reach up to the plane on both sides; more is not known of their parts.
    Box left_box = upper_.before[ends_below_], right_box = lower_.after[begins_at_];
    left_box.lower[axis_] = node_.lower[axis_], right_box.upper[axis_] = node_.upper[axis_];
    if (split > 0) left_box.upper[axis_] = right_box.lower[axis_] = position;
    const double least = cost(area(left_box), area(right_box));
    if (!(least < limit)) return;
    if (split > price_.spare) {
      found.refused = std::min(found.refused, least);
      return;
    }
    left_box = lower_.before[begins_below_], right_box = upper_.after[ends_at_];
    left_box.upper[axis_] = minimum(left_box.upper[axis_], position);
    right_box.lower[axis_] = maximum(right_box.lower[axis_], position);
    found.planes.push_back({axis_, position, least, cost(area(left_box), area(right_box))});
  }

  double area(const Box& box) const { return scaled_half_area(box, price_.area_scale); }

  std::size_t count_;
  const Box& node_;
  int axis_;
  const ConfigurationPrice& price_;
  Side lower_, upper_;
  std::vector<float> flat_;  ///< positions of references without extent on the axis
  /// Numbers of references that begin or end below the plane at hand, or at most there.
  std::size_t begins_below_ = 0, begins_at_ = 0, ends_below_ = 0, ends_at_ = 0;
};

}  // namespace

TightPlanes tight_planes(std::span<const refs::Reference> references, const Box& node, const ConfigurationPrice& price,
                         double limit, Executor& executor) {
  TightPlanes axes[3];
  executor.for_chunks(3, 1, [&](std::size_t axis, std::size_t, std::size_t) {
    axes[axis] = AxisPlanes(references, node, static_cast<int>(axis), price).find(limit);
  });
  TightPlanes all;
  for (const TightPlanes& found : axes) {
    all.planes.insert(all.planes.end(), found.planes.begin(), found.planes.end());
    all.refused = std::min(all.refused, found.refused);
  }
  std::stable_sort(all.planes.begin(), all.planes.end(),
                   [](const TightPlane& a, const TightPlane& b) { return a.estimate < b.estimate; });
  return all;
}

}  // namespace boxwood::builders
