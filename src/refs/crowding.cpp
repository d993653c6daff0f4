#include "refs/crowding.h"

#include <algorithm>
#include <atomic>

namespace boxwood::refs {

Crowding::Crowding(const ReferenceSet& set, Executor& executor)
    : bounds_(set.bounds), count_(static_cast<double>(set.references.size())), sums_(place(0, 0, kCells + 1)) {
  for (int axis = 0; axis < 3; ++axis) {
    const double side = double(bounds_.upper[axis]) - bounds_.lower[axis];
    scale_[static_cast<std::size_t>(axis)] = side > 0 ? kCells / side : 0;
  }
  executor.for_chunks(set.references.size(), 1 << 14, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 center = set.references[i].box().center();
      std::uint32_t& sum = sums_[place(cell(center.x, 0) + 1, cell(center.y, 1) + 1, cell(center.z, 2) + 1)];
      std::atomic_ref(sum).fetch_add(1, std::memory_order_relaxed);
    }
  });
  const std::size_t steps[] = {place(1, 0, 0), place(0, 1, 0), place(0, 0, 1)};
  for (const std::size_t step : steps)
    for (int z = 0; z <= kCells; ++z)
      for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x) {
          const int along = step == steps[0] ? x : step == steps[1] ? y : z;
          if (along > 0) sums_[place(x, y, z)] += sums_[place(x, y, z) - step];
        }
}

int Crowding::cell(float coordinate, int axis) const {
  const double at = (double(coordinate) - bounds_.lower[axis]) * scale_[static_cast<std::size_t>(axis)];
  return std::clamp(static_cast<int>(at), 0, kCells - 1);
}

double Crowding::around(const Box& box) const {
  int lower[3], upper[3];
  double volume = 1;
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = cell(box.lower[axis], axis);
    upper[axis] = cell(box.upper[axis], axis) + 1;
    volume *= double(upper[axis] - lower[axis]) / kCells;
  }
  std::uint32_t inside = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::uint32_t sum = sums_[place(corner & 1 ? upper[0] : lower[0], corner & 2 ? upper[1] : lower[1],
                                          corner & 4 ? upper[2] : lower[2])];
    const bool negative = ((corner & 1) + (corner >> 1 & 1) + (corner >> 2)) % 2 == 0;
    inside += negative ? 0u - sum : sum;  // wraps around and back
  }
  return std::clamp(inside / count_ / volume, 1 / kMost, kMost);
}

}  // namespace boxwood::refs
