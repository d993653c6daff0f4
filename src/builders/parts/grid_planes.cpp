#include "builders/parts/grid_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace boxwood::builders {
namespace {

/// Intervals between two planes of each axis, all combinations: the entries of a CountingTable.
constexpr double kMostIntervals = 1 << 24;

using Resolution = std::array<double, 3>;

/// Cells by axis when a cell's side is 1 / `density`.
Resolution resolution(const Resolution& extent, double density) {
  Resolution cells;
  for (int i = 0; i < 3; ++i) cells[i] = std::max(1.0, std::round(extent[i] * density));
  return cells;
}

bool fits(const Resolution& cells, double limit) {
  double product = 1, intervals = 1;
  for (const double n : cells) product *= n, intervals *= (n + 1) * (n + 2) / 2;
  return product <= limit && intervals <= kMostIntervals;
}

}  // namespace

double GridRule::cells(std::size_t references) const {
  const auto n = static_cast<double>(references);
  return factor_outside_root ? factor * std::sqrt(n) : std::sqrt(factor * n);
}

CandidatePlanes grid_planes(const Box& node, double cells) {
  Resolution extent;
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    extent[i] = static_cast<double>(node.upper[i]) - static_cast<double>(node.lower[i]);
    longest = std::max(longest, extent[i]);
  }
  if (longest > 0)
    for (double& side : extent) side /= longest;
  double low = 0, high = 2 * std::max(1.0, cells);
  for (int step = 0; step < 40; ++step) {
    const double middle = (low + high) / 2;
    (fits(resolution(extent, middle), cells) ? low : high) = middle;
  }
  const Resolution counts = resolution(extent, low);
  CandidatePlanes planes;
  for (int i = 0; i < 3; ++i) {
    std::vector<float>& axis = planes.lower[i];
    const auto count = static_cast<int>(counts[i]);
    const double begin = static_cast<double>(node.lower[i]), side = static_cast<double>(node.upper[i]) - begin;
    axis.push_back(node.lower[i]);
    for (int k = 1; k < count; ++k) {
      const auto plane = static_cast<float>(begin + side * k / count);
      if (plane > axis.back() && plane < node.upper[i]) axis.push_back(plane);
    }
    if (node.upper[i] > axis.back()) axis.push_back(node.upper[i]);
    planes.upper[i] = axis;
  }
  return planes;
}

CandidatePlanes side_planes(std::span<const refs::Reference> references) {
  CandidatePlanes planes;
  planes.flat_boxes = true;
  for (int i = 0; i < 3; ++i) {
    for (const refs::Reference& reference : references) {
      planes.lower[i].push_back(reference.lower[i]);
      planes.upper[i].push_back(reference.upper[i]);
    }
    for (std::vector<float>* axis : {&planes.lower[i], &planes.upper[i]}) {
      std::sort(axis->begin(), axis->end());
      axis->erase(std::unique(axis->begin(), axis->end()), axis->end());
    }
  }
  return planes;
}

}  // namespace boxwood::builders
