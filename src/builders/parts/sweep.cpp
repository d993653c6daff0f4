// Sweeps: one pass from the right remembers the area of all that lies from a reference on, one from the left prices the
// split before each reference. In a chunk both start from the box of what lies outside of it, so that chunks can be
// swept side by side and give the same numbers as one sweep.
#include "builders/parts/sweep.h"

#include <algorithm>

#include "builders/parts/area_scale.h"
#include "builders/parts/ordered_bits.h"
#include "builders/parts/radix_sort.h"

namespace boxwood::builders {
namespace {

using refs::Reference;

using Keys = AlignedBuffer<KeyedIndex>;

/// Reference numbers by primitive; the sorts by centroid start from here, which settles their ties.
Keys by_primitive(std::span<const Reference> references, Executor& executor) {
  Keys keys(references.size());
  executor.for_chunks(references.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) keys[i] = {references[i].primitive, static_cast<std::uint32_t>(i), 0};
  });
  const auto by_key = [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; };
  if (!std::is_sorted(keys.begin(), keys.end(), by_key)) radix_sort(keys, 32, executor);
  return keys;
}

AlignedBuffer<std::uint32_t> by_centroid(std::span<const Reference> references, const Keys& start, int axis,
                                         Executor& executor) {
  Keys keys(references.size());
  executor.for_chunks(references.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = {ordered_bits(references[start[i].index].centroid2(axis)), start[i].index, 0};
  });
  radix_sort(keys, 32, executor);
  AlignedBuffer<std::uint32_t> order(references.size());
  executor.for_chunks(references.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) order[i] = keys[i].index;
  });
  return order;
}

std::size_t chunk_count(std::size_t count) {
  return (count + kChunk - 1) / kChunk;
}

}  // namespace

SweepFinder::SweepFinder(refs::ReferenceSet&& set, const LeafRule& leaf_rule, Executor& executor)
    : references_(std::move(set.references)), leaf_rule_(leaf_rule) {
  const std::size_t count = references_.size();
  {
    const Keys start = by_primitive(references_.span(), executor);
    for (int axis = 0; axis < 3; ++axis) order_[axis] = by_centroid(references_.span(), start, axis, executor);
  }
  other_ = AlignedBuffer<std::uint32_t>(count);
  right_cost_ = AlignedBuffer<Float4>(count);
  is_left_ = AlignedBuffer<std::uint8_t>(count);
  area_scale_ = area_scale(measure_in_chunks(0, 0, count, executor).box());
}

BuildRange SweepFinder::root(Executor& executor) const {
  BuildRange range;
  range.last = static_cast<std::uint32_t>(references_.size());
  range.bounds = measure_in_chunks(0, 0, references_.size(), executor);
  measure_centroids(range);
  return range;
}

Box4 SweepFinder::measure(int axis, std::size_t begin, std::size_t end) const {
  const Float4 mask = xyz_mask();
  Box4 box = Box4::empty();
  for (std::size_t i = begin; i < end; ++i) box.grow(Box4::of(reference(axis, i)));
  return {box.lower & mask, box.upper};
}

Box4 SweepFinder::measure_in_chunks(int axis, std::size_t begin, std::size_t end, Executor& executor) const {
  if (end - begin <= kLargeRange) return measure(axis, begin, end);
  std::vector<Box4> parts(chunk_count(end - begin));
  executor.for_chunks(end - begin, kChunk, [&](std::size_t chunk, std::size_t from, std::size_t to) {
    parts[chunk] = measure(axis, begin + from, begin + to);
  });
  Box4 box = Box4::empty();
  for (const Box4& part : parts) box.grow(part);
  return box;
}

void SweepFinder::measure_centroids(BuildRange& range) const {
  Vec3 lower, upper;  // the orders are sorted: the ends are the extremes
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = reference(axis, range.first).centroid2(axis);
    upper[axis] = reference(axis, range.last - 1).centroid2(axis);
  }
  range.centroids2 = Box4::of({lower, upper});
}

SweepSplit SweepFinder::median(const BuildRange& range) const {
  return {range.centroids2.box().widest_axis(), range.first + range.size() / 2, kInfinity};
}

SweepSplit SweepFinder::find(const BuildRange& range, Executor& executor) {
  const double area = scaled_half_area(range.bounds.box(), area_scale_);
  // Where centroids coincide their order says nothing, and where there is no area all splits cost the same.
  if (range.centroids2.box().extent() == Vec3{} || !(area > 0))
    return leaf_rule_.may_be_leaf(range.size()) ? SweepSplit() : median(range);
  const SweepSplit best = sweep(range, executor);
  if (leaf_rule_.prefers_leaf(range.size(), area, best.cost)) return SweepSplit();
  return best.is_leaf() ? median(range) : best;
}

/// The best split of each axis before one of the references [begin, end) of its order; ties: the first.
SweepFinder::Best SweepFinder::sweep_chunk(const BuildRange& range, std::size_t begin, std::size_t end,
                                           const Part& part) {
  const Float4 scale = Float4::fill(area_scale_) & xyz_mask(), mask = xyz_mask();
  const auto grow = [&](Box4* boxes, std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Box4 box = Box4::of(reference(axis, i));
      boxes[axis].grow({box.lower & mask, box.upper});  // a primitive id in lane 3 is slow to multiply with
    }
  };
  const auto cost = [&](const Box4* b, std::size_t count) {
    return half_areas((b[0].upper - b[0].lower) * scale, (b[1].upper - b[1].lower) * scale,
                      (b[2].upper - b[2].lower) * scale) *
           Float4::fill(static_cast<float>(count));
  };
  Box4 right[3] = {part.after[0], part.after[1], part.after[2]};
  for (std::size_t i = end; i-- > begin;) {
    grow(right, i);
    right_cost_[i] = cost(right, range.last - i);
  }
  Box4 left[3] = {part.before[0], part.before[1], part.before[2]};
  Float4 best_cost = Float4::fill(kInfinity), best_mid = Float4::fill_bits(range.first);
  if (begin == range.first) grow(left, begin++);
  for (std::size_t i = begin; i < end; ++i) {
    const Float4 here = cost(left, i - range.first) + right_cost_[i];
    const Float4 better = less(here, best_cost);
    best_cost = select(better, here, best_cost);
    best_mid = select(better, Float4::fill_bits(static_cast<std::uint32_t>(i)), best_mid);
    grow(left, i);
  }
  Best best;
  best_cost.store(best.cost);
  best_mid.store(best.mid);
  return best;
}

SweepFinder::Best SweepFinder::sweep_in_chunks(const BuildRange& range, Executor& executor) {
  std::vector<Part> parts(chunk_count(range.size()));
  executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t from, std::size_t to) {
    for (int axis = 0; axis < 3; ++axis) parts[chunk].box[axis] = measure(axis, range.first + from, range.first + to);
  });
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 1; i < parts.size(); ++i) {
      parts[i].before[axis] = parts[i - 1].before[axis];
      parts[i].before[axis].grow(parts[i - 1].box[axis]);
    }
    for (std::size_t i = parts.size() - 1; i > 0; --i) {
      parts[i - 1].after[axis] = parts[i].after[axis];
      parts[i - 1].after[axis].grow(parts[i].box[axis]);
    }
  }
  executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t from, std::size_t to) {
    parts[chunk].best = sweep_chunk(range, range.first + from, range.first + to, parts[chunk]);
  });
  Best best;
  for (const Part& part : parts)
    for (int axis = 0; axis < 3; ++axis)
      if (part.best.cost[axis] < best.cost[axis]) {
        best.cost[axis] = part.best.cost[axis];
        best.mid[axis] = part.best.mid[axis];
      }
  return best;
}

SweepSplit SweepFinder::sweep(const BuildRange& range, Executor& executor) {
  const Best best = range.size() > kLargeRange ? sweep_in_chunks(range, executor)
                                               : sweep_chunk(range, range.first, range.last, Part());
  SweepSplit split;
  for (int axis = 0; axis < 3; ++axis)
    if (best.cost[axis] < split.cost) split = {axis, best.mid[axis], best.cost[axis]};
  return split;
}

void SweepFinder::apply(const SweepSplit& split, const BuildRange& range, Executor& executor, BuildRange& left,
                        BuildRange& right) {
  left.first = range.first;
  left.last = right.first = split.mid;
  right.last = range.last;
  const std::uint32_t* const order = order_[split.axis].data();
  const auto mark = [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = range.first + begin; i < range.first + end; ++i) is_left_[order[i]] = i < split.mid;
  };
  if (range.size() > kLargeRange)
    executor.for_chunks(range.size(), kChunk, mark);
  else
    mark(0, 0, range.size());
  for (int axis = 0; axis < 3; ++axis)
    if (axis != split.axis) partition(range, split.mid, axis, executor);
  for (BuildRange* child : {&left, &right}) {
    child->bounds = measure_in_chunks(split.axis, child->first, child->last, executor);
    measure_centroids(*child);
  }
}

/// Brings the references that go left to the front of an order, stable on both sides.
void SweepFinder::partition(const BuildRange& range, std::uint32_t mid, int axis, Executor& executor) {
  std::uint32_t* const order = order_[axis].data() + range.first;
  std::uint32_t* const other = other_.data() + range.first;
  const std::uint32_t mid_offset = mid - range.first;
  const auto scatter = [&](std::size_t begin, std::size_t end, std::size_t next_left, std::size_t next_right) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t is_left = is_left_[order[i]];
      other[is_left ? next_left : next_right] = order[i];
      next_left += is_left;
      next_right += 1 - is_left;
    }
  };
  if (range.size() <= kLargeRange) {
    scatter(0, range.size(), 0, mid_offset);
    std::memcpy(order, other, range.size() * sizeof *order);
    return;
  }
  std::vector<std::size_t> left_begin(chunk_count(range.size()) + 1);
  executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t left = 0;
    for (std::size_t i = begin; i < end; ++i) left += is_left_[order[i]];
    left_begin[chunk + 1] = left;
  });
  for (std::size_t i = 1; i < left_begin.size(); ++i) left_begin[i] += left_begin[i - 1];
  executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    scatter(begin, end, left_begin[chunk], mid_offset + (begin - left_begin[chunk]));
  });
  executor.for_chunks(range.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::memcpy(order + begin, other + begin, (end - begin) * sizeof *order);
  });
}

void SweepFinder::write_leaf(const BuildRange& range, std::uint32_t* ids) const {
  for (std::uint32_t i = 0; i < range.size(); ++i) ids[i] = reference(0, range.first + i).primitive;
}

}  // namespace boxwood::builders
