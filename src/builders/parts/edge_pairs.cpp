// Each reference in turn, when it is still alone, takes the lonely neighbour with which its box grows least. Turns are
// taken within chunks of a fixed number of references, which do not pair across their borders: chunks are independent.
// Meshes name neighbours soon after each other more often than not, so a look at the next few references finds about as
// many pairs as a table of all edges, in a tenth of the time.
#include "builders/parts/edge_pairs.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "builders/parts/area_scale.h"
#include "builders/parts/build_range.h"

namespace boxwood::builders {
namespace {

using refs::Reference;

/// References that pair among themselves. Smaller ones would leave more of them alone.
constexpr std::size_t kPairingChunk = std::size_t{1} << 14;
/// References that a search nearby looks at: two steps of three. One step finds up to a tenth less, four no more.
constexpr std::uint32_t kNear = 6;

class Pairing {
 public:
  Pairing(const refs::ReferenceSet& set, PairSearch search, mesh::Weld weld, double growth, Executor& executor)
      : references_(set.references.span()),
        primitives_(*set.primitives),
        near_(search == PairSearch::near),
        weld_(weld),
        growth_(growth > 0 ? float(growth) : std::numeric_limits<float>::max()),
        scale_(Float4::fill(area_scale(set.bounds)) & xyz_mask()),
        neighbours_(near_ ? AlignedBuffer<mesh::EdgeNeighbours>() : primitives_.edge_neighbours(weld, executor)),
        items_(references_.size()) {
    name_references(set.primitive_count);
  }

  bool numbered() const { return reference_of_.empty(); }

  /// Returns how many pairs and single references there are in the chunk.
  std::size_t run(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) items_[i].partner = kNoPartner;
    if (!near_ && neighbours_.empty()) return end - begin;
    measure(begin, end);
    std::size_t count = end - begin;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (items_[i].partner != kNoPartner) continue;
      const auto [best, parts_area] = near_ ? best_of_next(i, end) : best_neighbour(i, begin, end);
      if (best == kNoPartner) continue;
      items_[i].area = items_[best].area = parts_area;
      items_[i].partner = best;
      items_[best].partner = i;
      --count;
    }
    return count;
  }

  /// Writes what `run` counted: pairs in the order of their first references.
  void write(std::uint32_t begin, std::uint32_t end, std::uint32_t next, EdgePairs& out) const {
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t other = items_[i].partner;
      if (other < i) continue;
      Reference& pair = out.set.references[next];
      pair = references_[i];
      pair.primitive = next;
      pair.reserved = 0;
      if (other != kNoPartner) {
        const Box box = merge(pair.box(), references_[other].box());
        pair = {box.lower, next, box.upper, std::bit_cast<std::uint32_t>(items_[i].area)};
      }
      out.pairs[next++] = {i, other};
    }
  }

 private:
  struct Item {
    std::uint32_t partner;
    float area;  ///< half the area of its box, scaled; once paired, the parts_area of the pair
  };
  struct Neighbour {
    std::uint32_t reference;
    float parts_area;  ///< area of both, over that of the box around both
  };

  /// Neighbours are primitives; where references are not numbered like them, the first reference of one stands for it.
  void name_references(std::size_t primitive_count) {
    bool same = references_.size() == primitive_count;
    for (std::size_t i = 0; same && i < references_.size(); ++i) same = references_[i].primitive == i;
    if (same) return;
    reference_of_.assign(primitive_count, kNoPartner);
    for (std::size_t i = references_.size(); i-- > 0;) reference_of_[references_[i].primitive] = std::uint32_t(i);
  }

  /// Lanes 0 to 2: half areas of three boxes, in scaled lengths. What stands in the boxes' fourth lanes is left out.
  Float4 areas(const Box4& a, const Box4& b, const Box4& c) const {
    const Float4 mask = xyz_mask();
    const auto extent = [&](const Box4& box) { return (box.upper - (box.lower & mask)) * scale_; };
    return half_areas(extent(a), extent(b), extent(c));
  }

  void measure(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t last = end - 1;
    const auto box = [&](std::uint32_t i) { return Box4::of(references_[std::min(i, last)]); };
    for (std::uint32_t i = begin; i < end; i += 3) {
      alignas(16) float three[4];
      areas(box(i), box(i + 1), box(i + 2)).store(three);
      for (std::uint32_t k = 0; k < 3 && i + k < end; ++k) items_[i + k].area = three[k];
    }
  }

  /// Of the next references that may pair, without a branch until it comes to their edges: nothing here can be
  /// foretold.
  Neighbour best_of_next(std::uint32_t i, std::uint32_t end) const {
    const Box4 box = Box4::of(references_[i]);
    const auto next = [&](std::uint32_t k) { return std::min(i + 1 + k, end - 1); };
    const auto joined = [&](std::uint32_t k) {
      Box4 both = box;
      both.grow(Box4::of(references_[next(k)]));
      return both;
    };
    alignas(16) float area[kNear + 2];
    for (std::uint32_t k = 0; k < kNear; k += 3)
      areas(joined(k), joined(k + 1), joined(k + 2)).store_anywhere(area + k);
    std::uint64_t order[kNear];  // growth, which is not negative, then k
    for (std::uint32_t k = 0; k < kNear; ++k) {
      const Item& item = items_[next(k)];
      const bool alone = (i + 1 + k < end) & (item.partner == kNoPartner);
      const float growth = growth_of(area[k], items_[i].area + item.area);
      order[k] = std::uint64_t(std::bit_cast<std::uint32_t>(alone ? growth : kNever)) << 3 | k;
    }
    while (true) {
      const std::uint64_t least = *std::min_element(order, order + kNear);
      const auto k = std::uint32_t(least & 7);
      const float growth = std::bit_cast<float>(std::uint32_t(least >> 3));
      if (!(growth <= growth_)) return {kNoPartner, 0};
      if (primitives_.share_edge(references_[i].primitive, references_[next(k)].primitive, weld_))
        return {next(k), parts_area(growth)};
      order[k] = std::uint64_t(std::bit_cast<std::uint32_t>(kNever)) << 3 | k;
    }
  }

  Neighbour best_neighbour(std::uint32_t i, std::uint32_t begin, std::uint32_t end) const {
    const Box4 box = Box4::of(references_[i]);
    Box4 joined[3] = {box, box, box};
    std::uint32_t others[3];
    int count = 0;
    for (const std::uint32_t primitive : neighbours_[references_[i].primitive]) {
      if (primitive == mesh::kNoNeighbour) continue;
      const std::uint32_t other = reference_of_.empty() ? primitive : reference_of_[primitive];
      if (other < begin || other >= end || other == i || items_[other].partner != kNoPartner) continue;
      joined[count].grow(Box4::of(references_[other]));
      others[count++] = other;
    }
    if (count == 0) return {kNoPartner, 0};
    alignas(16) float area[4];
    areas(joined[0], joined[1], joined[2]).store(area);
    Neighbour best{kNoPartner, 0};
    float best_growth = growth_;
    for (int k = 0; k < count; ++k) {
      const float growth = growth_of(area[k], items_[i].area + items_[others[k]].area);
      if (growth > best_growth || (growth == best_growth && others[k] >= best.reference)) continue;
      best = {others[k], parts_area(growth)};
      best_growth = growth;
    }
    return best;
  }

  static constexpr float kNever = std::numeric_limits<float>::infinity();  ///< more than any limit
  static float growth_of(float joined, float both) { return both > 0 ? joined / both : 0; }
  static float parts_area(float growth) { return growth > 0 ? 1 / growth : 2; }

  std::span<const Reference> references_;
  const refs::Primitives& primitives_;
  bool near_;
  mesh::Weld weld_;
  float growth_;
  Float4 scale_;
  AlignedBuffer<mesh::EdgeNeighbours> neighbours_;
  std::vector<std::uint32_t> reference_of_;  ///< empty: each primitive is the reference of its number
  AlignedBuffer<Item> items_;
};

}  // namespace

EdgePairs pair_references(const refs::ReferenceSet& set, PairSearch search, mesh::Weld weld, double growth,
                          Executor& executor) {
  const std::size_t count = set.references.size();
  Pairing pairing(set, search, weld, growth, executor);
  std::vector<std::size_t> first((count + kPairingChunk - 1) / kPairingChunk + 1);
  executor.for_chunks(count, kPairingChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    first[chunk + 1] = pairing.run(std::uint32_t(begin), std::uint32_t(end));
  });
  for (std::size_t chunk = 1; chunk < first.size(); ++chunk) first[chunk] += first[chunk - 1];
  EdgePairs out;
  out.set.references = AlignedBuffer<Reference>(first.back());
  out.set.primitive_count = first.back();
  out.set.bounds = set.bounds;
  out.numbered = pairing.numbered();
  out.pairs = AlignedBuffer<ReferencePair>(first.back());
  executor.for_chunks(count, kPairingChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    pairing.write(std::uint32_t(begin), std::uint32_t(end), std::uint32_t(first[chunk]), out);
  });
  return out;
}

}  // namespace boxwood::builders
