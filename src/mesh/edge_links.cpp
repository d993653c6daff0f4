// Links between triangles over their edges, in the order in which EBBVH (Houghton and Spoerer, bib key ebbvh) pairs
// them. A radix sort brings the sides of each edge together, ascending by vertex ids; a second, stable one orders the
// links between them by the area of the edge's box. Its key is the top of the area as a double: monotone, of any scale,
// and three digits long. The edge table is not used here: it would take two atomic additions for each side of a
// triangle, and the sort none. O(n), the same links for every thread count.
#include <algorithm>
#include <bit>

#include "boxwood/mesh.h"
#include "mesh/chunks.h"
#include "mesh/usable.h"
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

/// A side of a triangle is keyed by the ends of its edge, the lower vertex above the higher one.
struct EdgeKeys {
  int bits;  ///< of a vertex number

  explicit EdgeKeys(std::size_t vertex_count) : bits(std::bit_width(std::max<std::size_t>(vertex_count, 2) - 1)) {}
  std::uint64_t key(std::uint32_t a, std::uint32_t b) const {
    return std::uint64_t(std::min(a, b)) << bits | std::max(a, b);
  }
  std::uint32_t low(std::uint64_t key) const { return std::uint32_t(key >> bits); }
  std::uint32_t high(std::uint64_t key) const { return std::uint32_t(key & ((std::uint64_t{1} << bits) - 1)); }
};

/// All sides sorted by edge, those of an edge by triangle. Sides to be left out begin and end at one vertex.
AlignedBuffer<KeyedIndex> sorted_sides(const MeshView& mesh, const EdgeKeys& keys,
                                       std::span<const std::uint32_t> vertex_ids, Executor& executor) {
  const std::vector<std::uint8_t> unusable = find_unusable(mesh, executor);
  AlignedBuffer<KeyedIndex> sides(3 * mesh.triangle_count);
  executor.for_chunks(mesh.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      auto corner = mesh.corners(t);
      if (!vertex_ids.empty())
        for (std::uint32_t& c : corner) c = vertex_ids[c];
      if (!unusable.empty() && unusable[t]) corner = {};
      for (std::size_t side = 0; side < 3; ++side)
        sides[3 * t + side] = {keys.key(corner[side], corner[side == 2 ? 0 : side + 1]), std::uint32_t(t), 0};
    }
  });
  radix_sort(sides, 2 * keys.bits, executor);
  return sides;
}

/// Is there a link between this side and the one before it?
bool is_linked(std::span<const KeyedIndex> sides, const EdgeKeys& keys, std::size_t s) {
  const KeyedIndex &a = sides[s - 1], &b = sides[s];
  return a.key == b.key && a.index != b.index && keys.low(a.key) != keys.high(a.key);
}

}  // namespace

AlignedBuffer<EdgeLink> edge_links(const MeshView& mesh, Weld weld, Executor& executor) {
  if (mesh.triangle_count == 0) return {};
  const EdgeKeys keys(mesh.vertex_count);
  const AlignedBuffer<KeyedIndex> sides = sorted_sides(
      mesh, keys, weld == Weld::position ? mesh::weld(mesh, executor) : std::vector<std::uint32_t>(), executor);

  // Chunk c looks at the sides from 1 + c * kChunk on, each together with the one before.
  std::vector<std::size_t> first(chunk_count(sides.size() - 1) + 1);
  executor.for_chunks(sides.size() - 1, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t s = begin + 1; s <= end; ++s) count += is_linked(sides.span(), keys, s);
    first[chunk + 1] = count;
  });
  for (std::size_t chunk = 1; chunk < first.size(); ++chunk) first[chunk] += first[chunk - 1];

  AlignedBuffer<KeyedIndex> ranked(first.back());
  executor.for_chunks(sides.size() - 1, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    KeyedIndex* next = ranked.data() + first[chunk];
    for (std::size_t s = begin + 1; s <= end; ++s) {
      if (!is_linked(sides.span(), keys, s)) continue;
      const std::uint64_t key = sides[s].key;
      *next++ = {area_key(mesh.vertex(keys.low(key)), mesh.vertex(keys.high(key))), sides[s - 1].index, sides[s].index};
    }
  });
  radix_sort(ranked, kKeyBits, executor);
  AlignedBuffer<EdgeLink> links(ranked.size());
  executor.for_chunks(links.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) links[i] = {ranked[i].index, ranked[i].other};
  });
  return links;
}

}  // namespace boxwood::mesh
