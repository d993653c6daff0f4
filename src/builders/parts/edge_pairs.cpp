// Each reference in turn, when it is still alone, takes the lonely neighbour with which its box grows least. Turns are
// taken within chunks of a fixed number of references, which do not pair across their borders: chunks are independent.
#include "builders/parts/edge_pairs.h"

#include <algorithm>
#include <vector>

#include "builders/parts/area_scale.h"
#include "builders/parts/build_range.h"

namespace boxwood::builders {
namespace {

using refs::Reference;

/// References that pair among themselves. Smaller ones would leave more of them alone.
constexpr std::size_t kPairingChunk = std::size_t{1} << 14;

class Pairing {
 public:
  Pairing(const refs::ReferenceSet& set, mesh::Weld weld, double growth, Executor& executor)
      : references_(set.references.span()),
        growth_(growth > 0 ? float(growth) : kInfinity),
        scale_(Float4::fill(area_scale(set.bounds)) & xyz_mask()),
        neighbours_(set.primitives->edge_neighbours(weld, executor)),
        items_(references_.size()) {
    name_references(set.primitive_count);
  }

  bool numbered() const { return reference_of_.empty(); }

  /// Returns how many pairs and single references there are in the chunk.
  std::size_t run(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) items_[i].partner = kNoPartner;
    if (neighbours_.empty()) return end - begin;
    measure(begin, end);
    std::size_t count = end - begin;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (items_[i].partner != kNoPartner) continue;
      const auto [best, parts_area] = best_neighbour(i, begin, end);
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
    std::uint32_t rank = begin - next;  // each pair of two has made the numbers fall back by one
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
      out.pairs[next++] = {i, other, rank};
      rank += other != kNoPartner;
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
      const float both = items_[i].area + items_[others[k]].area;
      const float growth = both > 0 ? area[k] / both : 0;
      if (growth > best_growth || (growth == best_growth && others[k] >= best.reference)) continue;
      best = {others[k], growth > 0 ? 1 / growth : 2};
      best_growth = growth;
    }
    return best;
  }

  std::span<const Reference> references_;
  float growth_;
  Float4 scale_;
  AlignedBuffer<mesh::EdgeNeighbours> neighbours_;
  std::vector<std::uint32_t> reference_of_;  ///< empty: each primitive is the reference of its number
  AlignedBuffer<Item> items_;
};

}  // namespace

EdgePairs pair_references(const refs::ReferenceSet& set, mesh::Weld weld, double growth, Executor& executor) {
  const std::size_t count = set.references.size();
  Pairing pairing(set, weld, growth, executor);
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
