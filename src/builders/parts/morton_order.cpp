#include "builders/parts/morton_order.h"

#include <vector>

#include "builders/kernels/reference_kernels.h"
#include "builders/parts/box4.h"
#include "math/morton.h"

namespace boxwood::builders {
namespace {

constexpr std::size_t kCodesPerChunk = std::size_t{1} << 12;

Box centroid_bounds(std::span<const refs::Reference> references, Executor& executor) {
  std::vector<Box> boxes((references.size() + kCodesPerChunk - 1) / kCodesPerChunk);
  executor.for_chunks(references.size(), kCodesPerChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    const Float4 mask = xyz_mask();
    Box4 box = Box4::empty();
    for (std::size_t r = begin; r < end; ++r) box.grow(centroid2(Box4::of(references[r]), mask));
    boxes[chunk] = box.box();
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
  executor.for_chunks(references.size(), kCodesPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    reference_kernels().morton_codes(grid, references.data(), begin, end, order.data() + begin);
  });
  radix_sort(order, 3 * bits_per_axis, executor);
  return order;
}

}  // namespace boxwood::builders
