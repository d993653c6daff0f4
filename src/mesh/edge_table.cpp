#include "mesh/edge_table.h"

#include <algorithm>
#include <atomic>

#include "mesh/chunks.h"

namespace boxwood::mesh {
namespace {

/// Calls f(low, use) for each side of the triangles in [begin, end) that counts.
template <class F>
void for_each_side(const MeshView& mesh, std::span<const std::uint32_t> vertex_ids,
                   std::span<const std::uint8_t> left_out, std::size_t begin, std::size_t end, F&& f) {
  for (std::size_t t = begin; t < end; ++t) {
    if (!left_out.empty() && left_out[t]) continue;
    auto corner = mesh.corners(t);
    if (!vertex_ids.empty())
      for (std::uint32_t& c : corner) c = vertex_ids[c];
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t a = corner[side], b = corner[side == 2 ? 0 : side + 1];
      if (a == b) continue;
      f(std::min(a, b), EdgeUse{std::max(a, b), static_cast<std::uint32_t>(2 * t + (a > b))});
    }
  }
}

}  // namespace

EdgeTable make_edge_table(const MeshView& mesh, std::span<const std::uint32_t> vertex_ids,
                          std::span<const std::uint8_t> left_out, Executor& executor) {
  // Counts stand two places late, so that after the prefix sum first[v + 1] is where bucket v begins; filling the
  // buckets moves it to where bucket v ends, which is what the table needs.
  EdgeTable table;
  table.first = AlignedBuffer<std::uint64_t>(mesh.vertex_count + 2);
  std::fill(table.first.begin(), table.first.end(), 0);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for_each_side(mesh, vertex_ids, left_out, begin, end, [&](std::uint32_t low, EdgeUse) {
      std::atomic_ref(table.first[low + 2]).fetch_add(1, std::memory_order_relaxed);
    });
  });
  for (std::size_t v = 1; v < table.first.size(); ++v) table.first[v] += table.first[v - 1];

  table.uses = AlignedBuffer<EdgeUse>(table.first[mesh.vertex_count + 1]);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for_each_side(mesh, vertex_ids, left_out, begin, end, [&](std::uint32_t low, EdgeUse use) {
      table.uses[std::atomic_ref(table.first[low + 1]).fetch_add(1, std::memory_order_relaxed)] = use;
    });
  });
  table.first.truncate(mesh.vertex_count + 1);

  // Threads filled the buckets in any order; a total order inside each makes the table unique.
  executor.for_chunks(mesh.vertex_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      std::sort(
          table.uses.data() + table.first[v], table.uses.data() + table.first[v + 1],
          [](const EdgeUse& a, const EdgeUse& b) { return a.high != b.high ? a.high < b.high : a.side < b.side; });
  });
  return table;
}

}  // namespace boxwood::mesh
