#include "builders/parts/centroid_sweep.h"

#include <algorithm>
#include <vector>

namespace boxwood::builders {
namespace {

struct Key {
  float centroid2;
  std::uint32_t primitive, place;
};

CentroidSplit sweep_axis(std::span<const refs::Reference> references, const Box& node, int axis,
                         const ConfigurationPrice& price) {
  const std::size_t count = references.size();
  std::vector<Key> keys(count);
  for (std::size_t i = 0; i < count; ++i)
    keys[i] = {references[i].centroid2(axis), references[i].primitive, static_cast<std::uint32_t>(i)};
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    if (a.centroid2 != b.centroid2) return a.centroid2 < b.centroid2;
    return a.primitive != b.primitive ? a.primitive < b.primitive : a.place < b.place;
  });
  CentroidSplit best;
  if (keys.front().centroid2 == keys.back().centroid2) return best;
  std::vector<Box> right(count + 1);
  for (std::size_t i = count; i-- > 0;) right[i] = merge(right[i + 1], references[keys[i].place].box());
  Box left;
  std::size_t mid = 0;
  // In single precision, like sweep.h, so that both find the same split.
  for (std::size_t i = 1; i < count; ++i) {
    left.grow(references[keys[i - 1].place].box());
    const float cost = scaled_half_area(left, price.area_scale) * static_cast<float>(i) +
                       scaled_half_area(right[i], price.area_scale) * static_cast<float>(count - i);
    if (!(static_cast<double>(cost) < best.cost)) continue;  // the penalty is no discount
    const double with_penalty = static_cast<double>(cost) * price.penalty(left, right[i], node);
    if (with_penalty < best.cost) best.cost = with_penalty, mid = i;
  }
  if (mid > 0) {
    best.axis = axis;
    best.centroid2 = keys[mid].centroid2, best.primitive = keys[mid].primitive, best.place = keys[mid].place;
  }
  return best;
}

}  // namespace

CentroidSplit sweep_centroids(std::span<const refs::Reference> references, const Box& node,
                              const ConfigurationPrice& price, Executor& executor) {
  CentroidSplit axes[3];
  executor.for_chunks(3, 1, [&](std::size_t axis, std::size_t, std::size_t) {
    axes[axis] = sweep_axis(references, node, static_cast<int>(axis), price);
  });
  CentroidSplit best;
  for (const CentroidSplit& split : axes)
    if (split.cost < best.cost) best = split;
  return best;
}

}  // namespace boxwood::builders
