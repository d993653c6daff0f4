#include "builders/parts/median_price.h"

#include <algorithm>

#include "builders/parts/area_scale.h"
#include "builders/parts/leaf_rule.h"

namespace boxwood::builders {
namespace {

constexpr std::uint32_t kDepthLimit = 64;  // further down ranges are halved by number

struct Range {
  std::uint32_t begin, end, depth;
  Box bounds;
};

Box bounds_of(const std::vector<refs::Reference>& references, std::uint32_t begin, std::uint32_t end) {
  Box box;
  for (std::uint32_t i = begin; i < end; ++i) box.grow(references[i].box());
  return box;
}

}  // namespace

double median_tree_price(std::vector<refs::Reference>& references, const tree::CostModel& cost, float area_scale) {
  const LeafRule leaf_rule(cost, 0);
  const auto count = static_cast<std::uint32_t>(references.size());
  std::vector<Range> stack{{0, count, 0, bounds_of(references, 0, count)}};
  double price = 0;
  while (!stack.empty()) {
    const Range range = stack.back();
    stack.pop_back();
    const std::uint32_t size = range.end - range.begin;
    const double area = scaled_half_area(range.bounds, area_scale);
    Range left{range.begin, range.begin + size / 2, range.depth + 1, {}}, right{};
    double children = std::numeric_limits<double>::infinity();
    if (size > 1) {
      Box centroids;
      for (std::uint32_t i = range.begin; i < range.end; ++i) centroids.grow(references[i].centroid2());
      const int axis = centroids.widest_axis();
      const float middle = centroids.center()[axis];
      const auto mid =
          std::stable_partition(references.begin() + range.begin, references.begin() + range.end,
                                [&](const refs::Reference& reference) { return reference.centroid2(axis) < middle; });
      const auto at = static_cast<std::uint32_t>(mid - references.begin());
      if (at != range.begin && at != range.end && range.depth < kDepthLimit) left.end = at;
      right = {left.end, range.end, range.depth + 1, {}};
      for (Range* child : {&left, &right}) child->bounds = bounds_of(references, child->begin, child->end);
      children = static_cast<double>(scaled_half_area(left.bounds, area_scale)) * (left.end - left.begin) +
                 static_cast<double>(scaled_half_area(right.bounds, area_scale)) * (right.end - right.begin);
    }
    if (leaf_rule.prefers_leaf(size, area, children)) {
      price += cost.intersection * area * size;
      continue;
    }
    price += cost.traversal * area;
    stack.push_back(left);
    stack.push_back(right);
  }
  return price;
}

}  // namespace boxwood::builders
