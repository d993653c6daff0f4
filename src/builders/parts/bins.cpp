// Binned surface area heuristic after Wald 2007 (bib key wald2007): one pass drops every reference into a bin of each
// axis by its centroid, two sweeps over the bins price all splits between them. The sweeps price three axes at once,
// one per SIMD lane. O(references + bins).
#include "builders/parts/bins.h"

#include <cmath>

namespace boxwood::builders {
namespace {

/// Just under one, so that the largest centroid stays inside the last bin.
constexpr float kBelowOne = 0.99999f;

constexpr std::size_t kWorthQuarters = 16;

/// Finds the bins of references.
class Placer {
 public:
  explicit Placer(const BinGrid& grid) : mask_(xyz_mask()), origin_(grid.origin), scale_(grid.scale) {}

  Bins::Placed operator()(const refs::Reference& reference) const {
    Bins::Placed placed;
    placed.box = Box4::of(reference);
    // A primitive id in lane 3 would be a denormal number: very slow to multiply with.
    placed.box.lower = placed.box.lower & mask_;
    ((placed.box.lower + placed.box.upper - origin_) * scale_).store_integers(placed.bin);
    return placed;
  }

 private:
  Float4 mask_, origin_, scale_;
};

}  // namespace

BinGrid BinGrid::over(const Box4& centroids2, int bins, int axis) {
  const Box box = centroids2.box();
  float scale[3] = {};
  BinGrid grid;
  grid.count = bins;
  for (int a = 0; a < 3; ++a) {
    if (axis >= 0 && a != axis) continue;
    const float wanted = kBelowOne * static_cast<float>(bins) / (box.upper[a] - box.lower[a]);
    grid.usable[a] = std::isfinite(wanted);  // not when the centroids are (almost) in one plane
    if (grid.usable[a]) scale[a] = wanted;
  }
  grid.origin = Float4::of(box.lower.x, box.lower.y, box.lower.z);
  grid.scale = Float4::of(scale[0], scale[1], scale[2]);
  return grid;
}

void Bins::clear(int count) {
  count_ = count;
  for (int i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis) boxes_[i].axis[axis] = Box4::empty();
  std::memset(counts_, 0, sizeof(Counts) * count);
}

inline void Bins::add(const Placed& placed, int axis) {
  boxes_[placed.bin[axis]].axis[axis].grow(placed.box);
  ++counts_[placed.bin[axis]].axis[axis];
}

void Bins::add(const BinGrid& grid, const refs::Reference* references, std::size_t count) {
  // Neighbours in memory are mostly neighbours in space: one after the other they would wait for each other's bins.
  // So the four quarters of the references are walked side by side, and the halves of a few.
  const Placer place(grid);
  const std::size_t quarter = count < kWorthQuarters ? 0 : count / 4;
  for (std::size_t i = 0; i < quarter; ++i) {
    const Placed a = place(references[i]), b = place(references[i + quarter]), c = place(references[i + 2 * quarter]),
                 d = place(references[i + 3 * quarter]);
    for (int axis = 0; axis < 3; ++axis) add(a, axis), add(b, axis), add(c, axis), add(d, axis);
  }
  references += 4 * quarter;
  count -= 4 * quarter;
  const std::size_t half = count / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const Placed a = place(references[i]), b = place(references[i + half]);
    for (int axis = 0; axis < 3; ++axis) add(a, axis), add(b, axis);
  }
  if (count % 2 == 0) return;
  const Placed last = place(references[count - 1]);
  for (int axis = 0; axis < 3; ++axis) add(last, axis);
}

void Bins::add(const Bins& other) {
  for (int i = 0; i < count_; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[i].axis[axis].grow(other.boxes_[i].axis[axis]);
      counts_[i].axis[axis] += other.counts_[i].axis[axis];
    }
}

BinSplit Bins::best_split(const BinGrid& grid, float area_scale) const {
  const Float4 scale = Float4::fill(area_scale);
  const auto areas = [&](const Box4* boxes) {
    return half_areas((boxes[0].upper - boxes[0].lower) * scale, (boxes[1].upper - boxes[1].lower) * scale,
                      (boxes[2].upper - boxes[2].lower) * scale);
  };
  Float4 right_cost[kMostBins];  // of bins i and up
  Box4 grown[3] = {Box4::empty(), Box4::empty(), Box4::empty()};
  Float4 number = Float4::fill(0);
  for (int i = count_ - 1; i > 0; --i) {
    for (int axis = 0; axis < 3; ++axis) grown[axis].grow(boxes_[i].axis[axis]);
    number = number + Float4::load_integers(counts_[i].axis);
    right_cost[i] = areas(grown) * number;
  }
  for (Box4& box : grown) box = Box4::empty();
  number = Float4::fill(0);
  Float4 best_cost = Float4::fill(kInfinity), best_bin = Float4::fill(0);
  for (int i = 1; i < count_; ++i) {
    for (int axis = 0; axis < 3; ++axis) grown[axis].grow(boxes_[i - 1].axis[axis]);
    number = number + Float4::load_integers(counts_[i - 1].axis);
    const Float4 cost = areas(grown) * number + right_cost[i];
    const Float4 better = less(cost, best_cost);
    best_cost = select(better, cost, best_cost);
    best_bin = select(better, Float4::fill(static_cast<float>(i)), best_bin);
  }

  alignas(16) float costs[4], bins[4];
  best_cost.store(costs);
  best_bin.store(bins);
  BinSplit split;
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid.usable[axis] || !(costs[axis] < split.cost)) continue;
    split.axis = axis;
    split.cost = costs[axis];
  }
  if (split.axis < 0) return split;
  split.left = split.right = Box4::empty();
  split.bin = static_cast<int>(bins[split.axis]);
  for (int i = 0; i < count_; ++i) (i < split.bin ? split.left : split.right).grow(boxes_[i].axis[split.axis]);
  split.left_count = count_below(split.axis, split.bin);
  return split;
}

std::uint32_t Bins::count_below(int axis, int bin) const {
  std::uint32_t sum = 0;
  for (int i = 0; i < bin; ++i) sum += counts_[i].axis[axis];
  return sum;
}

}  // namespace boxwood::builders
