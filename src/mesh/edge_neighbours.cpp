// Triangles across the sides of triangles. Sides are sorted by counting under the lower of their two vertices; under a
// vertex there are few, which are sorted by the other vertex and triangle and partnered two by two. The triangles are
// cut into parts, one for each thread, with counters of their own: into how many does not matter, since each vertex's
// sides are sorted after all. (One set of counters with atomic additions made two threads slower than one; lists of
// sides that wait for their partner took a sixth longer than counting, hash tables of them for each 16,384
// triangles more than half as long again.) Expected O(n).
#include <algorithm>
#include <utility>

#include "boxwood/mesh.h"
#include "mesh/chunks.h"
#include "mesh/usable.h"

namespace boxwood::mesh {
namespace {

/// A side by its higher vertex, then by its place 3 * triangle + side: 31 and 33 bits.
using Side = std::uint64_t;
constexpr int kPlaceBits = 33;
constexpr Side kPlaceMask = (Side{1} << kPlaceBits) - 1;
/// Counters of more parts would take more memory than the sides.
constexpr std::size_t kMostParts = 8;

class SideTable {
 public:
  SideTable(const MeshView& mesh, std::span<const std::uint32_t> vertex_ids, Executor& executor)
      : mesh_(mesh),
        vertex_ids_(vertex_ids),
        unusable_(find_unusable(mesh, executor)),
        executor_(executor),
        parts_(std::min({kMostParts, std::size_t(executor.threads()), chunk_count(mesh.triangle_count)})),
        first_(parts_ * mesh.vertex_count),
        sides_(3 * mesh.triangle_count) {
    executor.for_chunks(first_.size(), 4 * kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::fill(first_.begin() + begin, first_.begin() + end, std::uint64_t{0});
    });
    for_sides([](std::uint64_t& counter, Side) { ++counter; });
    std::uint64_t sum = 0;
    for (std::size_t v = 0; v < mesh.vertex_count; ++v)
      for (std::size_t part = 0; part < parts_; ++part) {
        std::uint64_t& first = first_[part * mesh.vertex_count + v];
        sum += std::exchange(first, sum);
      }
    // Taking places moves each part's first to where the next part's was.
    for_sides([&](std::uint64_t& first, Side side) { sides_[first++] = side; });
  }

  AlignedBuffer<EdgeNeighbours> neighbours() {
    AlignedBuffer<EdgeNeighbours> result(mesh_.triangle_count);
    executor_.for_chunks(result.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::fill(result.begin() + begin, result.begin() + end, EdgeNeighbours{kNoNeighbour, kNoNeighbour, kNoNeighbour});
    });
    const std::span<const std::uint64_t> ends = first_.span().last(mesh_.vertex_count);
    executor_.for_chunks(mesh_.vertex_count, kChunk / 4, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const std::uint64_t first = v == 0 ? 0 : ends[v - 1], last = ends[v];
        if (last - first > 1) partner(sides_.span().subspan(first, last - first), result);
      }
    });
    return result;
  }

 private:
  /// Calls f(counter of the part and the lower vertex, side) for all sides of usable triangles that have two ends.
  template <class F>
  void for_sides(F f) {
    const std::size_t size = (mesh_.triangle_count + parts_ - 1) / parts_;
    executor_.for_chunks(mesh_.triangle_count, size, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::uint64_t* const first = first_.data() + part * mesh_.vertex_count;
      for (std::size_t t = begin; t < end; ++t) {
        if (!unusable_.empty() && unusable_[t]) continue;
        auto corner = mesh_.corners(t);
        if (!vertex_ids_.empty())
          for (std::uint32_t& c : corner) c = vertex_ids_[c];
        for (std::size_t side = 0; side < 3; ++side) {
          const std::uint32_t a = corner[side], b = corner[side == 2 ? 0 : side + 1];
          if (a == b) continue;
          f(first[std::min(a, b)], Side(std::max(a, b)) << kPlaceBits | (3 * t + side));
        }
      }
    });
  }

  static void sort(std::span<Side> sides) {
    constexpr std::size_t kFew = 24;
    if (sides.size() > kFew) return std::sort(sides.begin(), sides.end());
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Side side = sides[i];
      std::size_t place = i;
      for (; place > 0 && sides[place - 1] > side; --place) sides[place] = sides[place - 1];
      sides[place] = side;
    }
  }

  static void partner(std::span<Side> sides, AlignedBuffer<EdgeNeighbours>& result) {
    sort(sides);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (sides[i - 1] >> kPlaceBits != sides[i] >> kPlaceBits) continue;
      const std::uint64_t a = sides[i - 1] & kPlaceMask, b = sides[i] & kPlaceMask;
      if (a / 3 == b / 3) continue;
      result[a / 3][a % 3] = std::uint32_t(b / 3);
      result[b / 3][b % 3] = std::uint32_t(a / 3);
      ++i;
    }
  }

  MeshView mesh_;
  std::span<const std::uint32_t> vertex_ids_;
  std::vector<std::uint8_t> unusable_;
  Executor& executor_;
  std::size_t parts_;
  AlignedBuffer<std::uint64_t> first_;  ///< by part, then by vertex
  AlignedBuffer<Side> sides_;
};

}  // namespace

AlignedBuffer<EdgeNeighbours> edge_neighbours(const MeshView& mesh, Weld weld, Executor& executor) {
  if (mesh.triangle_count == 0) return {};
  const std::vector<std::uint32_t> vertex_ids =
      weld == Weld::position ? mesh::weld(mesh, executor) : std::vector<std::uint32_t>();
  return SideTable(mesh, vertex_ids, executor).neighbours();
}

}  // namespace boxwood::mesh
