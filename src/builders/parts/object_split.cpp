#include "builders/parts/object_split.h"

#include <algorithm>

namespace boxwood::builders {
namespace {

Box4 centroid_bounds(std::span<const refs::Reference> references, Executor& executor) {
  const auto measure = [&](std::size_t begin, std::size_t end) {
    const Float4 mask = xyz_mask();
    Box4 box = Box4::empty();
    for (std::size_t i = begin; i < end; ++i) box.grow(centroid2(Box4::of(references[i]), mask));
    return box;
  };
  if (references.size() <= kLargeRange) return measure(0, references.size());
  std::vector<Box4> chunks((references.size() + kChunk - 1) / kChunk);
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    chunks[chunk] = measure(begin, end);
  });
  Box4 all = Box4::empty();
  for (const Box4& chunk : chunks) all.grow(chunk);
  return all;
}

void fill(Bins& bins, std::span<const refs::Reference> references, const BinGrid& grid, Executor& executor) {
  if (references.size() <= kLargeRange) {
    bins.add(grid, references.data(), references.size());
    return;
  }
  std::vector<std::unique_ptr<Bins>> chunks((references.size() + kChunk - 1) / kChunk);
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    chunks[chunk] = std::make_unique<Bins>(grid.count);
    chunks[chunk]->add(grid, references.data() + begin, end - begin);
  });
  for (const auto& chunk : chunks) bins.add(*chunk);
}

}  // namespace

ObjectSplit best_object_split(std::span<const refs::Reference> references, int bins, float area_scale,
                              Executor& executor) {
  const auto few = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(bins), 4 + references.size()));
  const BinGrid grid = BinGrid::over(centroid_bounds(references, executor), few, -1);
  ObjectSplit split;
  if (!grid.any_usable()) return split;
  Bins filled(grid.count);
  fill(filled, references, grid, executor);
  split.bins = filled.best_split(grid, area_scale);
  if (!split.exists()) return split;
  alignas(16) float origin[4], scale[4];
  grid.origin.store(origin);
  grid.scale.store(scale);
  split.origin = origin[split.bins.axis];
  split.scale = scale[split.bins.axis];
  return split;
}

}  // namespace boxwood::builders
