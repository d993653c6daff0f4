// Triangles across the sides of triangles. Sides are sorted by counting under the lower of their two vertices; under a
// vertex there are few, which are sorted by the other vertex and triangle and partnered two by two. Counters are shared
// by atomic additions when there are several threads: the order in which sides arrive does not matter, since each
// vertex's are sorted after all. Expected O(n), the same neighbours for every thread count.
#include <algorithm>
#include <atomic>
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

class SideTable {
 public:
  SideTable(const MeshView& mesh, std::span<const std::uint32_t> vertex_ids, Executor& executor)
      : mesh_(mesh),
        vertex_ids_(vertex_ids),
        unusable_(find_unusable(mesh, executor)),
        executor_(executor),
        first_(mesh.vertex_count + 1),
        sides_(3 * mesh.triangle_count) {
    if (executor.threads() == 1)
      fill([](std::uint64_t& counter) { return counter++; });
    else
      fill([](std::uint64_t& counter) { return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed); });
  }

  AlignedBuffer<EdgeNeighbours> neighbours() {
    AlignedBuffer<EdgeNeighbours> result(mesh_.triangle_count);
    executor_.for_chunks(result.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::fill(result.begin() + begin, result.begin() + end, EdgeNeighbours{kNoNeighbour, kNoNeighbour, kNoNeighbour});
    });
    executor_.for_chunks(mesh_.vertex_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (first_[v + 1] - first_[v] > 1) partner(sides_.span().subspan(first_[v], first_[v + 1] - first_[v]), result);
    });
    return result;
  }

 private:
  /// Calls f(lower vertex, side) for all sides of usable triangles that have two ends.
  template <class F>
  void for_sides(F f) const {
    executor_.for_chunks(mesh_.triangle_count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        if (!unusable_.empty() && unusable_[t]) continue;
        auto corner = mesh_.corners(t);
        if (!vertex_ids_.empty())
          for (std::uint32_t& c : corner) c = vertex_ids_[c];
        for (std::size_t side = 0; side < 3; ++side) {
          const std::uint32_t a = corner[side], b = corner[side == 2 ? 0 : side + 1];
          if (a != b) f(std::min(a, b), Side(std::max(a, b)) << kPlaceBits | (3 * t + side));
        }
      }
    });
  }

  /// Counts, then puts each side where its vertex has room. Afterwards vertex v has [first_[v], first_[v + 1]).
  template <class Take>
  void fill(Take take) {
    std::fill(first_.begin(), first_.end(), std::uint64_t{0});
    for_sides([&](std::uint32_t low, Side) { take(first_[low]); });
    std::uint64_t sum = 0;
    for (std::uint64_t& first : first_) sum += std::exchange(first, sum);
    // Taking places moves each vertex's first to the next one's, so they are one further up when all are taken.
    for_sides([&](std::uint32_t low, Side side) { sides_[take(first_[low])] = side; });
    std::copy_backward(first_.begin(), first_.end() - 1, first_.end());
    first_[0] = 0;
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
  AlignedBuffer<std::uint64_t> first_;
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
