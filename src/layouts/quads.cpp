// Pairs of triangles that share an edge (Aman and Fenney 2023, bib key aman2023; EBBVH's first round, bib key ebbvh).
// Ours differs: pairs are sought within one leaf when it is encoded, so they are found behind every builder, and by
// the corners' positions, so also across vertices that a mesh has twice. An edge is shared when both its ends have the
// same bits; how the two triangles are wound does not matter, nor does the angle between them.
//
// A leaf should need few quads, so the most pairs are wanted: again and again the triangle that has the fewest
// unpaired neighbours is paired with the one of them that has the fewest, the lower place in the leaf first among
// equals. O(k^2) for k triangles, at most 32; deterministic.
#include "layouts/quads.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace boxwood::layouts {
namespace {

constexpr std::size_t kMost = 32;  // references of a leaf
constexpr std::uint8_t kNone = 0xff;

struct Corner {
  std::uint32_t x, y, z;  // the floats' bits
  bool operator==(const Corner&) const = default;
};
using Corners = std::array<Corner, 3>;

/// An edge that two triangles have in common, by the corner of each that is not on it. `same_way`: both run through it
/// in the same direction, which consistently wound neighbours don't.
struct SharedEdge {
  int apex[2];
  bool same_way;
};

bool find_shared_edge(const Corners& a, const Corners& b, SharedEdge& edge) {
  for (int i = 0; i < 3; ++i) {
    const Corner &a1 = a[(i + 1) % 3], &a2 = a[(i + 2) % 3];
    for (int j = 0; j < 3; ++j) {
      const Corner &b1 = b[(j + 1) % 3], &b2 = b[(j + 2) % 3];
      const bool against = a1 == b2 && a2 == b1;
      if (!against && !(a1 == b1 && a2 == b2)) continue;
      edge = {{i, j}, !against};
      return true;
    }
  }
  return false;
}

/// The triangles of a leaf and, after pairing, the partner of each.
class LeafPairs {
 public:
  LeafPairs(std::span<const std::uint32_t> references, const MeshView& mesh) : size_(references.size()) {
    for (std::size_t i = 0; i < size_; ++i) {
      const Triangle t = mesh.triangle(references[i]);
      static_assert(sizeof t == sizeof corners_[i]);
      std::memcpy(&corners_[i], &t, sizeof t);
      for (std::size_t k = 0; k < 3; ++k) {
        const Corner& c = corners_[i][k];
        keys_[k][i] = c.x ^ c.y * 0x9e3779b1u ^ c.z * 0x85ebca77u;
      }
      find_neighbours(i);
    }
    partner_.fill(kNone);
    while (pair_one()) ++pairs_;
  }

  std::size_t quads() const { return size_ - pairs_; }
  std::size_t size() const { return size_; }
  const Corners& corners(std::size_t i) const { return corners_[i]; }
  std::uint8_t partner(std::size_t i) const { return partner_[i]; }

 private:
  /// Those before triangle i that share an edge with it. Pairs with fewer than two corners whose keys are equal, nearly
  /// all, are out at once.
  void find_neighbours(std::size_t i) {
    std::uint32_t equal[kMost] = {};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        for (std::size_t j = 0; j < i; ++j) equal[j] += keys_[k][i] == keys_[l][j];
    SharedEdge edge;
    for (std::size_t j = 0; j < i; ++j)
      if (equal[j] >= 2 && find_shared_edge(corners_[i], corners_[j], edge)) {
        neighbours_[i] |= 1u << j;
        neighbours_[j] |= 1u << i;
        ++degree_[i], ++degree_[j];
        open_ |= 1u << i | 1u << j;
      }
  }

  /// The one of `candidates` with the fewest unpaired neighbours.
  std::size_t loneliest(std::uint32_t candidates) const {
    std::size_t best = std::size_t(std::countr_zero(candidates));
    while (candidates &= candidates - 1) {
      const std::size_t i = std::size_t(std::countr_zero(candidates));
      if (degree_[i] < degree_[best]) best = i;
    }
    return best;
  }

  bool pair_one() {
    if (!open_) return false;
    const std::size_t a = loneliest(open_), b = loneliest(neighbours_[a]);
    partner_[a] = std::uint8_t(b), partner_[b] = std::uint8_t(a);
    take_out(a);
    take_out(b);
    return true;
  }

  void take_out(std::size_t i) {
    open_ &= ~(1u << i);
    for (std::uint32_t rest = neighbours_[i]; rest; rest &= rest - 1) {
      const std::size_t j = std::size_t(std::countr_zero(rest));
      neighbours_[j] &= ~(1u << i);
      if (--degree_[j] == 0) open_ &= ~(1u << j);
    }
    neighbours_[i] = 0;
  }

  std::size_t size_, pairs_ = 0;
  std::array<Corners, kMost> corners_;
  std::uint32_t keys_[3][kMost];                   // of the corners; different keys, different corners
  std::array<std::uint32_t, kMost> neighbours_{};  // unpaired triangles that share an edge, as bits
  std::array<std::uint8_t, kMost> degree_{};       // how many they are
  std::uint32_t open_ = 0;                         // unpaired triangles that have any
  std::array<std::uint8_t, kMost> partner_;
};

constexpr std::uint32_t primitive_word(std::uint32_t id, int apex, bool flipped) {
  return id | std::uint32_t((3 - apex) % 3) * kQuadTurnBit | (flipped ? kQuadFlipBit : 0);
}

void put(float* place, std::size_t stride, const Corner& corner) {
  place[0] = std::bit_cast<float>(corner.x);
  place[stride] = std::bit_cast<float>(corner.y);
  place[2 * stride] = std::bit_cast<float>(corner.z);
}

}  // namespace

std::uint32_t quad_blocks(std::span<const std::uint32_t> references, const MeshView& mesh) {
  // One block holds any four triangles, so up to there nothing needs to be looked at.
  if (references.size() <= 4) return 1;
  std::size_t blocks = 0;
  for (std::size_t done = 0; done < references.size(); done += kMost) {
    const std::size_t count = std::min(kMost, references.size() - done);
    blocks += (LeafPairs(references.subspan(done, count), mesh).quads() + 3) / 4;
  }
  return std::uint32_t(blocks);
}

void fill_quads(QuadBlock* blocks, std::span<const std::uint32_t> references, const MeshView& mesh) {
  const LeafPairs leaf(references, mesh);
  const std::uint32_t nan = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN());
  const Corner unused{nan, nan, nan};
  std::size_t quad = 0;
  const auto add = [&](const Corner& apex_a, const Corner& apex_b, const Corner& from, const Corner& to,
                       std::uint32_t word_a, std::uint32_t word_b) {
    QuadBlock& block = blocks[quad / 4];
    const std::size_t lane = quad++ % 4;
    put(block.apex[0] + lane, 8, apex_a);
    put(block.apex[0] + lane + 4, 8, apex_b);
    put(block.edge[0][0] + lane, 4, from);
    put(block.edge[1][0] + lane, 4, to);
    block.primitive[lane] = word_a;
    block.primitive[lane + 4] = word_b;
  };
  for (std::size_t i = 0; i < leaf.size(); ++i) {
    const Corners& a = leaf.corners(i);
    const std::size_t other = leaf.partner(i);
    if (other == kNone) {
      add(a[0], unused, a[1], a[2], primitive_word(references[i], 0, false), kInvalidPrimitive);
    } else if (i < other) {
      const Corners& b = leaf.corners(other);
      SharedEdge edge{};
      (void)find_shared_edge(a, b, edge);
      const int p = edge.apex[0], q = edge.apex[1];
      add(a[p], b[q], a[(p + 1) % 3], a[(p + 2) % 3], primitive_word(references[i], p, false),
          primitive_word(references[other], q, !edge.same_way));
    }
  }
  while (quad % 4 != 0) add(unused, unused, unused, unused, kInvalidPrimitive, kInvalidPrimitive);
}

}  // namespace boxwood::layouts
