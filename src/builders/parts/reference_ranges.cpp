// References in two buffers. A plane split copies a range from one buffer into the other without a branch per
// reference; large ranges go in fixed chunks, each of which knows from the counts where its references belong, so the
// order of the references is that of a stable partition for any number of threads.
#include "builders/parts/reference_ranges.h"

#include <algorithm>

#include "builders/kernels/reference_kernels.h"

namespace boxwood::builders {
namespace {

using refs::Reference;

std::size_t chunk_count(std::size_t count) {
  return (count + kChunk - 1) / kChunk;
}

bool goes_left(const RangeSplit& split, const Reference& reference) {
  return (reference.centroid2(split.axis) - split.origin) * split.scale < split.threshold;
}

ReferenceBoxes measure_all(const Reference* references, std::size_t count) {
  const Float4 mask = xyz_mask();
  ReferenceBoxes measure;
  for (std::size_t i = 0; i < count; ++i) measure.add(references[i], mask);
  return measure;
}

}  // namespace

ReferenceRanges::ReferenceRanges(refs::ReferenceSet&& set)
    : buffers_{std::move(set.references), AlignedBuffer<Reference>()} {
  buffers_[1] = AlignedBuffer<Reference>(buffers_[0].size());
}

BuildRange ReferenceRanges::root(Executor& executor) const {
  BuildRange range;
  range.last = size();
  measure(range, executor);
  return range;
}

void ReferenceRanges::measure(BuildRange& range, Executor& executor) const {
  const Reference* const source = references(range);
  ReferenceBoxes total;
  if (range.size() <= kLargeRange) {
    total = measure_all(source, range.size());
  } else {
    std::vector<ReferenceBoxes> parts(chunk_count(range.size()));
    executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      parts[chunk] = measure_all(source + begin, end - begin);
    });
    for (const ReferenceBoxes& part : parts) total.add(part);
  }
  range.bounds = total.bounds;
  range.centroids2 = total.centroids2;
}

RangeSplit ReferenceRanges::median(const BuildRange& range) const {
  const Box centroids = range.centroids2.box();
  RangeSplit split;
  split.axis = centroids.widest_axis();
  split.kind = centroids.extent()[split.axis] > 0 ? RangeSplit::Kind::median : RangeSplit::Kind::index_halves;
  split.mid = range.first + range.size() / 2;
  return split;
}

void ReferenceRanges::count(const BuildRange& range, RangeSplit& split, Executor& executor) const {
  const Reference* const source = references(range);
  const auto count_left = [&](std::size_t begin, std::size_t end) {
    std::uint32_t left = 0;
    for (std::size_t i = begin; i < end; ++i) left += goes_left(split, source[i]);
    return left;
  };
  if (range.size() <= kLargeRange) {
    split.mid = range.first + count_left(0, range.size());
    return;
  }
  split.left_per_chunk.resize(chunk_count(range.size()));
  executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    split.left_per_chunk[chunk] = count_left(begin, end);
  });
  split.mid = range.first;
  for (const std::uint32_t left : split.left_per_chunk) split.mid += left;
}

void ReferenceRanges::partition(const RangeSplit& split, const BuildRange& range, Executor& executor, BuildRange& left,
                                BuildRange& right) {
  left.buffer = right.buffer = 1 - range.buffer;
  const Reference* const source = references(range);
  Reference* const target = buffers_[left.buffer].data();
  ReferenceSides sides;
  if (range.size() <= kLargeRange) {
    sides = reference_kernels().part(split, source, range.size(), target + range.first, target + split.mid);
  } else {
    std::vector<ReferenceSides> parts(split.left_per_chunk.size());
    std::vector<std::uint32_t> left_begin(parts.size() + 1);
    for (std::size_t i = 0; i < parts.size(); ++i) left_begin[i + 1] = left_begin[i] + split.left_per_chunk[i];
    executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      const std::size_t before = left_begin[chunk];
      parts[chunk] = reference_kernels().part(split, source + begin, end - begin, target + range.first + before,
                                              target + split.mid + (begin - before));
    });
    for (const ReferenceSides& part : parts) sides.left.add(part.left), sides.right.add(part.right);
  }
  left.bounds = split.has_boxes ? split.left : sides.left.bounds;
  right.bounds = split.has_boxes ? split.right : sides.right.bounds;
  left.centroids2 = sides.left.centroids2;
  right.centroids2 = sides.right.centroids2;
}

void ReferenceRanges::apply(const RangeSplit& split, const BuildRange& range, Executor& executor, BuildRange& left,
                            BuildRange& right) {
  left.first = range.first;
  left.last = right.first = split.mid;
  right.last = range.last;
  if (split.kind == RangeSplit::Kind::plane) {
    partition(split, range, executor, left, right);
    return;
  }
  left.buffer = right.buffer = range.buffer;
  if (split.kind == RangeSplit::Kind::median) {
    Reference* const all = buffers_[range.buffer].data();
    const int axis = split.axis;
    std::nth_element(all + range.first, all + split.mid, all + range.last,
                     [axis](const Reference& a, const Reference& b) {
                       const float x = a.centroid2(axis), y = b.centroid2(axis);
                       return x < y || (x == y && a.primitive < b.primitive);
                     });
  }
  measure(left, executor);
  measure(right, executor);
}

void ReferenceRanges::write_leaf(const BuildRange& range, std::uint32_t* ids) const {
  const Reference* const source = references(range);
  for (std::uint32_t i = 0; i < range.size(); ++i) ids[i] = source[i].primitive;
}

}  // namespace boxwood::builders
