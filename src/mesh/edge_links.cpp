// Links between triangles over their edges, in the order in which EBBVH (Houghton and Spoerer, bib key ebbvh) pairs
// them. The edge table has the uses of each edge side by side and the edges ascending by vertex ids; a stable radix
// sort by the area of the edge's box does the rest. The key is the top of the area as a double: monotone, of any scale,
// and three digits long. O(n) but for the table's small sorts; the same links for every thread count.
#include <bit>

#include "mesh/chunks.h"
#include "mesh/edge_table.h"
#include "parallel/radix_sort.h"

namespace boxwood::mesh {
namespace {

constexpr int kKeyBits = 33;
constexpr std::uint64_t kLargestKey = (std::uint64_t{1} << kKeyBits) - 1;

/// Ascending where the area of the box around two points descends: 11 bits of exponent, 22 of the mantissa.
std::uint64_t area_key(Vec3 p, Vec3 q) {
  const double x = std::fabs(double(p.x) - q.x), y = std::fabs(double(p.y) - q.y), z = std::fabs(double(p.z) - q.z);
  return kLargestKey - (std::bit_cast<std::uint64_t>(x * y + y * z + z * x) >> (63 - kKeyBits));
}

bool is_usable_vertex(Vec3 p) {
  return std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
         std::fabs(p.z) <= kLargestCoordinate;
}

/// Flags of the triangles that can't be used; empty when all can.
std::vector<std::uint8_t> find_unusable(const MeshView& mesh, Executor& executor) {
  std::vector<std::uint8_t> bad_chunks(chunk_count(mesh.vertex_count));
  executor.for_chunks(mesh.vertex_count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    bool usable = true;
    for (std::size_t v = begin; v < end; ++v) usable &= is_usable_vertex(mesh.vertex(v));
    bad_chunks[chunk] = !usable;
  });
  bool all_usable = true;
  for (const std::uint8_t bad : bad_chunks) all_usable &= !bad;
  if (all_usable) return {};
  std::vector<std::uint8_t> unusable(mesh.triangle_count);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) unusable[t] = !mesh::is_usable(mesh.triangle(t));
  });
  return unusable;
}

/// Calls f(edge's lower vertex, higher vertex, triangle, triangle) for each link of edges in [begin, end), in order.
template <class F>
void for_each_link(const EdgeTable& table, std::size_t begin, std::size_t end, F&& f) {
  for_each_edge(table, begin, end, [&](std::uint32_t low, std::uint32_t high, std::span<const EdgeUse> uses) {
    for (std::size_t u = 1; u < uses.size(); ++u)
      if (uses[u - 1].triangle() != uses[u].triangle()) f(low, high, uses[u - 1].triangle(), uses[u].triangle());
  });
}

}  // namespace

AlignedBuffer<EdgeLink> edge_links(const MeshView& mesh, Weld weld, Executor& executor) {
  const std::vector<std::uint32_t> vertex_ids =
      weld == Weld::position ? mesh::weld(mesh, executor) : std::vector<std::uint32_t>();
  const EdgeTable table = make_edge_table(mesh, vertex_ids, find_unusable(mesh, executor), executor);

  std::vector<std::size_t> first(chunk_count(table.vertex_count()) + 1);
  executor.for_chunks(table.vertex_count(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for_each_link(table, begin, end, [&](std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t) { ++count; });
    first[chunk + 1] = count;
  });
  for (std::size_t chunk = 1; chunk < first.size(); ++chunk) first[chunk] += first[chunk - 1];

  AlignedBuffer<KeyedIndex> keyed(first.back());
  executor.for_chunks(table.vertex_count(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    KeyedIndex* next = keyed.data() + first[chunk];
    for_each_link(table, begin, end, [&](std::uint32_t low, std::uint32_t high, std::uint32_t a, std::uint32_t b) {
      *next++ = {area_key(mesh.vertex(low), mesh.vertex(high)), a, b};
    });
  });
  radix_sort(keyed, kKeyBits, executor);
  AlignedBuffer<EdgeLink> links(keyed.size());
  executor.for_chunks(links.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) links[i] = {keyed[i].index, keyed[i].other};
  });
  return links;
}

}  // namespace boxwood::mesh
