// Chopped binning of Stich, Friedrich and Dietrich 2009 (bib key stich2009). A reference enters the bin of its first
// side and leaves the one of its last side; each bin it passes is grown by the part of it inside. What goes where is
// decided by comparisons with the borders themselves, so the counts are those that sifting at the border will give.
// O(references * bins they pass).
#include "builders/parts/spatial_bins.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "builders/parts/area_scale.h"

namespace boxwood::builders {

SpatialBins::SpatialBins(const Box& region, int count)
    : region_(region), count_(count), bins_(3 * static_cast<std::size_t>(count)) {
  const Vec3 extent = region.extent();
  for (int axis = 0; axis < 3; ++axis) {
    const float scale = static_cast<float>(count) / extent[axis];
    bins_per_length_[axis] = std::isfinite(scale) ? scale : 0;  // 0: the region is flat, all is in one bin
    for (int i = 0; i < count; ++i)
      borders_[axis][static_cast<std::size_t>(i)] =
          region.lower[axis] + static_cast<float>(i) / static_cast<float>(count) * extent[axis];
  }
}

/// The last bin whose lower border is not above the position.
int SpatialBins::bin_at(int axis, float position) const {
  int i = std::min(static_cast<int>((position - region_.lower[axis]) * bins_per_length_[axis]), count_ - 1);
  while (i > 0 && border(axis, i) > position) --i;
  while (i + 1 < count_ && border(axis, i + 1) <= position) ++i;
  return i;
}

void SpatialBins::add(const refs::Reference& reference, const refs::Primitives& primitives) {
  for (int axis = 0; axis < 3; ++axis)
    if (bins_per_length_[axis] > 0) add(axis, reference, primitives);
}

void SpatialBins::add(int axis, const refs::Reference& reference, const refs::Primitives& primitives) {
  const int first = bin_at(axis, reference.lower[axis]);
  int last = bin_at(axis, reference.upper[axis]);
  // One that ends on a border lies before it.
  while (last > first && border(axis, last) >= reference.upper[axis]) --last;
  ++bin(axis, first).begins;
  ++bin(axis, last).ends;
  if (first == last) {
    bin(axis, first).box.grow(reference.box());
    return;
  }
  const std::size_t cuts = static_cast<std::size_t>(last - first);
  const std::span<const float> borders(borders_[axis].data() + first + 1, cuts);
  std::array<Box, kMostSpatialBins> parts;
  primitives.chop(reference, axis, borders, {parts.data(), cuts + 1});
  for (std::size_t i = 0; i <= cuts; ++i) bin(axis, first + static_cast<int>(i)).box.grow(parts[i]);
}

void SpatialBins::add(const SpatialBins& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    bins_[i].box.grow(other.bins_[i].box);
    bins_[i].begins += other.bins_[i].begins;
    bins_[i].ends += other.bins_[i].ends;
  }
}

SpatialBinSplit SpatialBins::best_split(std::size_t total, std::uint64_t spare, float area_scale) const {
  SpatialBinSplit best;
  for (int axis = 0; axis < 3; ++axis)
    if (bins_per_length_[axis] > 0) find_best(axis, total, spare, area_scale, best);
  return best;
}

void SpatialBins::find_best(int axis, std::size_t total, std::uint64_t spare, float area_scale,
                            SpatialBinSplit& best) const {
  struct Right {
    Box box;
    std::size_t count;
  };
  std::vector<Right> rights(static_cast<std::size_t>(count_));
  Right right{{}, 0};
  for (int i = count_ - 1; i > 0; --i) {
    right.box.grow(bin(axis, i).box);
    right.count += bin(axis, i).ends;
    rights[static_cast<std::size_t>(i)] = right;
  }
  Box left;
  std::size_t left_count = 0;
  for (int i = 1; i < count_; ++i) {
    left.grow(bin(axis, i - 1).box);
    left_count += bin(axis, i - 1).begins;
    const Right& beyond = rights[static_cast<std::size_t>(i)];
    if (left_count == 0 || beyond.count == 0 || left_count + beyond.count - total > spare) continue;
    const double cost =
        static_cast<double>(scaled_half_area(left, area_scale)) * static_cast<double>(left_count) +
        static_cast<double>(scaled_half_area(beyond.box, area_scale)) * static_cast<double>(beyond.count);
    if (cost < best.plane.cost)
      best = {{axis, border(axis, i), false, left_count, beyond.count, cost}, left, beyond.box};
  }
}

}  // namespace boxwood::builders
