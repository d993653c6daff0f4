// Which triangles stand on which edge. An edge is an unordered pair of vertex ids; its uses lie next to each other.
#pragma once

#include <cstdint>
#include <span>

#include "boxwood/base.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"

namespace boxwood::mesh {

/// One side of one triangle, in the bucket of the edge's lower vertex.
struct EdgeUse {
  std::uint32_t high;  ///< the edge's higher vertex
  std::uint32_t side;  ///< 2 * triangle, plus 1 if the triangle runs from the higher to the lower vertex

  std::uint32_t triangle() const { return side >> 1; }
  bool reversed() const { return side & 1; }
};

/// The uses of edges whose lower vertex is v are uses[first[v]] to uses[first[v + 1] - 1], ascending by higher vertex,
/// then by triangle: so all uses are ascending by edge and the uses of one edge by triangle.
struct EdgeTable {
  AlignedBuffer<std::uint64_t> first;  ///< one per vertex, and one more
  AlignedBuffer<EdgeUse> uses;

  std::size_t vertex_count() const { return first.empty() ? 0 : first.size() - 1; }
};

/// `vertex_ids` renames vertices, as weld does (empty: the mesh's own indices). Triangles with left_out[t] != 0 are
/// passed over (empty: none), and so are sides that begin and end at the same vertex. Bucket sort by lower vertex, then
/// a comparison sort in each bucket: O(n log(largest bucket)). The same table for every thread count.
EdgeTable make_edge_table(const MeshView& mesh, std::span<const std::uint32_t> vertex_ids,
                          std::span<const std::uint8_t> left_out, Executor& executor);

/// Calls f(low, high, std::span<const EdgeUse>) for each edge whose lower vertex is in [begin, end), in order.
template <class F>
void for_each_edge(const EdgeTable& table, std::size_t begin, std::size_t end, F&& f) {
  for (std::size_t low = begin; low < end; ++low) {
    const EdgeUse* const stop = table.uses.data() + table.first[low + 1];
    for (const EdgeUse* use = table.uses.data() + table.first[low]; use != stop;) {
      const EdgeUse* next = use + 1;
      while (next != stop && next->high == use->high) ++next;
      f(static_cast<std::uint32_t>(low), use->high, std::span<const EdgeUse>(use, next));
      use = next;
    }
  }
}

}  // namespace boxwood::mesh
