// Binned surface area heuristic after Wald 2007 (bib key wald2007): one pass drops every reference into a bin of each
// axis by its centroid, two sweeps over the bins price all splits between them. The sweeps price three axes at once,
// one per SIMD lane. O(references + bins).
#include "builders/parts/bins.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "builders/kernels/reference_kernels.h"

namespace boxwood::builders {
namespace {

/// Just under one, so that the largest centroid stays inside the last bin.
constexpr float kBelowOne = 0.99999f;

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
  table_.count = count;
  for (int i = 0; i < count; ++i) std::fill_n(&table_.boxes[i].axis[0][0], 24, kInfinity);
  std::memset(table_.counts, 0, sizeof(BinTable::Counts) * count);
}

void Bins::add(const BinGrid& grid, const refs::Reference* references, std::size_t count) {
  reference_kernels().bin(grid, references, count, table_);
}

void Bins::add(const Bins& other) {
  for (int i = 0; i < table_.count; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      float* const box = table_.boxes[i].axis[axis];
      const float* const grown = other.table_.boxes[i].axis[axis];
      for (int lane = 0; lane < 8; ++lane) box[lane] = grown[lane] < box[lane] ? grown[lane] : box[lane];
      table_.counts[i].axis[axis] += other.table_.counts[i].axis[axis];
    }
}

BinSplit Bins::best_split(const BinGrid& grid, float area_scale) const {
  return reference_kernels().best_split(grid, table_, area_scale);
}

std::uint32_t Bins::count_below(int axis, int bin) const {
  std::uint32_t sum = 0;
  for (int i = 0; i < bin; ++i) sum += table_.counts[i].axis[axis];
  return sum;
}

}  // namespace boxwood::builders
