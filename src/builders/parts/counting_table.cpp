#include "builders/parts/counting_table.h"

#include <algorithm>

namespace boxwood::builders {
namespace {

PlaneBox both(const PlaneBox& a, const PlaneBox& b) {
  PlaneBox box;
  for (int i = 0; i < 3; ++i) {
    box.lower[i] = std::max(a.lower[i], b.lower[i]);
    box.upper[i] = std::min(a.upper[i], b.upper[i]);
  }
  return box;
}

}  // namespace

CountingTable::CountingTable(std::span<const refs::Reference> references, const CandidatePlanes& planes)
    : all_(static_cast<std::uint32_t>(references.size())) {
  for (int i = 0; i < 3; ++i) {
    const std::size_t count = planes.lower[i].size();
    row_[i].resize(count);
    std::size_t next = 0;
    for (std::size_t lower = 0; lower < count; ++lower) {
      row_[i][lower] = next - lower;  // wraps around for lower > 0 only until `upper >= lower` is added
      next += count - lower;
    }
    size_[i] = next;
  }
  table_.assign(size_[0] * size_[1] * size_[2], 0);
  for (const refs::Reference& reference : references) {
    std::size_t index = 0;
    for (int i = 0; i < 3; ++i) {
      const std::vector<float>& axis = planes.lower[i];
      const auto lower = std::upper_bound(axis.begin(), axis.end(), reference.lower[i]) - axis.begin() - 1;
      const auto upper = std::lower_bound(axis.begin() + lower, axis.end(), reference.upper[i]) - axis.begin();
      index = index * size_[i] + row_[i][static_cast<std::size_t>(lower)] + static_cast<std::size_t>(upper);
    }
    ++table_[index];
  }
  for (int axis = 0; axis < 3; ++axis) sum_up(axis);
}

/// Adds to each interval of the axis what is in the intervals inside it.
void CountingTable::sum_up(int axis) {
  std::size_t step = 1, outer = 1;
  for (int i = axis + 1; i < 3; ++i) step *= size_[i];
  for (int i = 0; i < axis; ++i) outer *= size_[i];
  const std::size_t planes = row_[axis].size();
  for (std::size_t block = 0; block < outer; ++block) {
    std::uint32_t* const begin = table_.data() + block * size_[axis] * step;
    const auto at = [&](std::size_t lower, std::size_t upper) { return begin + (row_[axis][lower] + upper) * step; };
    const auto add = [step](std::uint32_t* to, const std::uint32_t* from) {
      for (std::size_t k = 0; k < step; ++k) to[k] += from[k];
    };
    for (std::size_t lower = planes; lower-- > 0;)
      for (std::size_t upper = lower + 1; upper < planes; ++upper) add(at(lower, upper), at(lower, upper - 1));
    for (std::size_t lower = planes - 1; lower-- > 0;)
      for (std::size_t upper = lower + 1; upper < planes; ++upper) add(at(lower, upper), at(lower + 1, upper));
  }
}

SideCounts CountingTable::count(const PlaneBox& left, const PlaneBox& right, bool may_split) const {
  const PlaneBox middle = both(left, right);
  SideCounts counts;
  counts.both = inside(middle);
  counts.left = inside(left) - counts.both;
  counts.right = inside(right) - counts.both;
  counts.covered = counts.left + counts.right + counts.both == all_;
  if (may_split && !counts.covered) {
    for (int i = 0; i < 3; ++i) {
      // References inside both children on the other axes, and inside the two together on this one.
      if (middle.lower[i] > middle.upper[i]) continue;
      PlaneBox joined = middle;
      joined.lower[i] = std::min(left.lower[i], right.lower[i]);
      joined.upper[i] = std::max(left.upper[i], right.upper[i]);
      counts.split += inside(joined) - inside(both(joined, left)) - inside(both(joined, right)) + counts.both;
    }
    counts.covered = counts.left + counts.right + counts.both + counts.split == all_;
  }
  return counts;
}

}  // namespace boxwood::builders
