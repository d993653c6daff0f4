#include "builders/parts/morton_order.h"

#include <vector>

#include "math/morton.h"

namespace boxwood::builders {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 12;

Box centroid_bounds(std::span<const refs::Reference> references, Executor& executor) {
  std::vector<Box> boxes((references.size() + kChunk - 1) / kChunk);
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Box box;
    for (std::size_t r = begin; r < end; ++r) box.grow(references[r].centroid2());
    boxes[chunk] = box;
  });
  Box all;
  for (const Box& box : boxes) all.grow(box);
  return all;
}

}  // namespace

AlignedBuffer<KeyedIndex> morton_order(std::span<const refs::Reference> references, int bits_per_axis,
                                       Executor& executor) {
  const MortonGrid grid(centroid_bounds(references, executor), bits_per_axis);
  AlignedBuffer<KeyedIndex> order(references.size());
  executor.for_chunks(references.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) order[r] = {grid.code(references[r].centroid2()), std::uint32_t(r), 0};
  });
  radix_sort(order, 3 * bits_per_axis, executor);
  return order;
}

}  // namespace boxwood::builders
