// Each reference in turn, when it is still alone, takes the lonely neighbour with which its box grows least. Turns are
// taken within chunks of a fixed number of references, which do not pair across their borders: chunks are independent.
#include "builders/parts/edge_pairs.h"

#include <array>
#include <vector>

#include "builders/parts/build_range.h"

namespace boxwood::builders {
namespace {

using refs::Reference;

/// In double: areas of boxes of any float size neither overflow nor vanish.
double half_area(const Box& box) {
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

class Pairing {
 public:
  Pairing(const refs::ReferenceSet& set, mesh::Weld weld, double growth, Executor& executor)
      : references_(set.references.span()),
        growth_(growth > 0 ? growth : double(kInfinity)),
        neighbours_(set.primitives->edge_neighbours(weld, executor)),
        partner_(references_.size()),
        parts_area_(references_.size()) {
    name_references(set.primitive_count);
  }

  /// Returns how many pairs and single references there are in the chunk.
  std::size_t run(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) partner_[i] = kNoPartner;
    if (neighbours_.empty()) return end - begin;
    std::size_t count = end - begin;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (partner_[i] != kNoPartner) continue;
      const auto [best, growth] = best_neighbour(i, begin, end);
      if (best == kNoPartner) continue;
      parts_area_[best] = growth > 0 ? float(1 / growth) : 2;
      partner_[i] = best;
      partner_[best] = i;
      --count;
    }
    return count;
  }

  /// Writes what `run` counted: pairs in the order of their first references.
  void write(std::uint32_t begin, std::uint32_t end, std::uint32_t next, EdgePairs& out) const {
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t other = partner_[i];
      if (other < i) continue;
      const Reference& reference = references_[i];
      const Box box = other == kNoPartner ? reference.box() : merge(reference.box(), references_[other].box());
      out.set.references[next] = {box.lower, next, box.upper, 0};
      out.pairs[next++] = {i, other, other == kNoPartner ? 1 : parts_area_[other]};
    }
  }

 private:
  /// Neighbours are primitives; where references are not numbered like them, the first reference of one stands for it.
  void name_references(std::size_t primitive_count) {
    bool same = references_.size() == primitive_count;
    for (std::size_t i = 0; same && i < references_.size(); ++i) same = references_[i].primitive == i;
    if (same) return;
    reference_of_.assign(primitive_count, kNoPartner);
    for (std::size_t i = references_.size(); i-- > 0;) reference_of_[references_[i].primitive] = std::uint32_t(i);
  }

  struct Neighbour {
    std::uint32_t reference;
    double growth;
  };

  Neighbour best_neighbour(std::uint32_t i, std::uint32_t begin, std::uint32_t end) const {
    const Box box = references_[i].box();
    const double area = half_area(box);
    std::uint32_t best = kNoPartner;
    double best_growth = growth_;
    for (const std::uint32_t primitive : neighbours_[references_[i].primitive]) {
      if (primitive == mesh::kNoNeighbour) continue;
      const std::uint32_t other = reference_of_.empty() ? primitive : reference_of_[primitive];
      if (other < begin || other >= end || other == i || partner_[other] != kNoPartner) continue;
      const Box& other_box = references_[other].box();
      const double both = area + half_area(other_box);
      const double growth = both > 0 ? half_area(merge(box, other_box)) / both : 0;
      if (growth > best_growth || (growth == best_growth && other >= best)) continue;
      best = other;
      best_growth = growth;
    }
    return {best, best_growth};
  }

  std::span<const Reference> references_;
  double growth_;
  AlignedBuffer<mesh::EdgeNeighbours> neighbours_;
  std::vector<std::uint32_t> reference_of_;  ///< empty: each primitive is the reference of its number
  AlignedBuffer<std::uint32_t> partner_;
  AlignedBuffer<float> parts_area_;  ///< of the pair, at its second reference
};

}  // namespace

EdgePairs pair_references(const refs::ReferenceSet& set, mesh::Weld weld, double growth, Executor& executor) {
  const std::size_t count = set.references.size();
  Pairing pairing(set, weld, growth, executor);
  std::vector<std::size_t> first((count + kChunk - 1) / kChunk + 1);
  executor.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    first[chunk + 1] = pairing.run(std::uint32_t(begin), std::uint32_t(end));
  });
  for (std::size_t chunk = 1; chunk < first.size(); ++chunk) first[chunk] += first[chunk - 1];
  EdgePairs out;
  out.set.references = AlignedBuffer<Reference>(first.back());
  out.set.primitive_count = first.back();
  out.set.bounds = set.bounds;
  out.pairs = AlignedBuffer<ReferencePair>(first.back());
  executor.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    pairing.write(std::uint32_t(begin), std::uint32_t(end), std::uint32_t(first[chunk]), out);
  });
  return out;
}

}  // namespace boxwood::builders
