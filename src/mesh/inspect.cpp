// What a mesh looks like: one pass over the triangles, then welding, a hash table of corner triples, disjoint sets and
// an edge table. Sums are joined in the order of fixed chunks, so every number is the same for every thread count.
#include <algorithm>
#include <atomic>

#include "boxwood/mesh.h"
#include "mesh/chunks.h"
#include "mesh/edge_table.h"
#include "mesh/first_equal.h"
#include "mesh/union_find.h"

namespace boxwood::mesh {
namespace {

enum Kind : std::uint8_t { proper, degenerate, non_finite };
using Corners = std::array<std::uint32_t, 3>;

/// Area in double. Differences of floats of like size are exact there and so are their products, so that an area of
/// zero means collinear corners and not rounding.
double area(const Triangle& t) {
  const double ax = double(t.v1.x) - t.v0.x, ay = double(t.v1.y) - t.v0.y, az = double(t.v1.z) - t.v0.z;
  const double bx = double(t.v2.x) - t.v0.x, by = double(t.v2.y) - t.v0.y, bz = double(t.v2.z) - t.v0.z;
  const double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
  return 0.5 * std::sqrt(x * x + y * y + z * z);
}

/// Fills `kind` and the report's counts, bounds and area.
void classify(const MeshView& mesh, Executor& executor, AlignedBuffer<std::uint8_t>& kind, Report& report) {
  std::vector<Report> parts(chunk_count(mesh.triangle_count));
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Report part;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle triangle = mesh.triangle(i);
      kind[i] = non_finite;
      if (!is_usable(triangle)) {
        ++part.non_finite;
        continue;
      }
      const double a = area(triangle);
      kind[i] = a == 0 ? degenerate : proper;
      part.degenerate += a == 0;
      part.surface_area += a;
      part.bounds.grow(triangle.bounds());
    }
    parts[chunk] = part;
  });
  for (const Report& part : parts) {
    report.non_finite += part.non_finite;
    report.degenerate += part.degenerate;
    report.surface_area += part.surface_area;
    report.bounds.grow(part.bounds);
  }
}

Corners welded_corners(const MeshView& mesh, const std::vector<std::uint32_t>& ids, std::size_t triangle) {
  Corners c = mesh.corners(triangle);
  for (std::uint32_t& v : c) v = ids[v];
  return c;
}

std::size_t count_duplicates(const MeshView& mesh, const std::vector<std::uint32_t>& ids,
                             const AlignedBuffer<std::uint8_t>& kind, Executor& executor) {
  const auto sorted_corners = [&](std::size_t i) {
    Corners c = welded_corners(mesh, ids, i);
    if (c[0] > c[1]) std::swap(c[0], c[1]);
    if (c[1] > c[2]) std::swap(c[1], c[2]);
    if (c[0] > c[1]) std::swap(c[0], c[1]);
    return c;
  };
  AlignedBuffer<std::uint32_t> first(mesh.triangle_count);
  find_first_equal(
      mesh.triangle_count, first.data(), executor, [&](std::size_t i) { return kind[i] != non_finite; },
      [&](std::size_t i) {
        const Corners c = sorted_corners(i);
        return scramble(scramble(c[0] | std::uint64_t(c[1]) << 32) + c[2] * 0x9e3779b97f4a7c15ull);
      },
      [&](std::size_t a, std::size_t b) { return sorted_corners(a) == sorted_corners(b); });
  std::vector<std::size_t> parts(chunk_count(mesh.triangle_count));
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[chunk] += first[i] != i;
  });
  std::size_t total = 0;
  for (const std::size_t part : parts) total += part;
  return total;
}

/// Vertices in use minus successful unions: each union joins two components into one.
std::size_t count_components(const MeshView& mesh, const std::vector<std::uint32_t>& ids,
                             const AlignedBuffer<std::uint8_t>& kind, Executor& executor) {
  UnionFind sets(mesh.vertex_count);
  AlignedBuffer<std::uint8_t> used(mesh.vertex_count);
  std::fill(used.begin(), used.end(), 0);
  std::atomic<std::size_t> unions = 0, vertices = 0;
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::size_t joined = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (kind[i] == non_finite) continue;
      const Corners c = welded_corners(mesh, ids, i);
      for (const std::uint32_t v : c) std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
      joined += sets.unite(c[0], c[1]);
      joined += sets.unite(c[1], c[2]);
    }
    unions.fetch_add(joined, std::memory_order_relaxed);
  });
  executor.for_chunks(mesh.vertex_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    vertices.fetch_add(static_cast<std::size_t>(std::count(used.data() + begin, used.data() + end, 1)),
                       std::memory_order_relaxed);
  });
  return vertices - unions;
}

void count_edges(const EdgeTable& table, Executor& executor, Report& report) {
  std::vector<std::array<std::size_t, 2>> parts(chunk_count(table.vertex_count()));
  executor.for_chunks(table.vertex_count(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t boundary = 0, crowded = 0;
    for_each_edge(table, begin, end, [&](std::uint32_t, std::uint32_t, std::span<const EdgeUse> uses) {
      boundary += uses.size() == 1;
      crowded += uses.size() > 2;
    });
    parts[chunk] = {boundary, crowded};
  });
  for (const auto& [boundary, crowded] : parts) report.boundary_edges += boundary, report.non_manifold_edges += crowded;
}

}  // namespace

Report inspect(const MeshView& mesh, Executor& executor) {
  Report report;
  report.vertices = mesh.vertex_count;
  report.triangles = mesh.triangle_count;
  AlignedBuffer<std::uint8_t> kind(mesh.triangle_count);
  classify(mesh, executor, kind, report);

  const std::vector<std::uint32_t> ids = weld(mesh, executor);
  report.duplicate = count_duplicates(mesh, ids, kind, executor);
  report.components = count_components(mesh, ids, kind, executor);
  count_edges(make_edge_table(mesh, ids, kind.span(), executor), executor, report);
  report.closed = report.boundary_edges == 0 && mesh.triangle_count > report.non_finite + report.degenerate;
  report.manifold = report.non_manifold_edges == 0;
  return report;
}

}  // namespace boxwood::mesh
