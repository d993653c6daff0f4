// The split finder of sweep builders: references in three sorted orders, swept from both sides.
#pragma once

#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/build_range.h"
#include "builders/parts/leaf_rule.h"

namespace boxwood::builders {

/// A split between two neighbours of one axis's order: the references before `mid` go left.
struct SweepSplit {
  int axis = -1;  ///< -1: make a leaf
  std::uint32_t mid = 0;
  float cost = kInfinity;  ///< area * count of both sides, added, in scaled areas

  bool is_leaf() const { return axis < 0; }
};

class SweepFinder {
 public:
  SweepFinder(refs::ReferenceSet&& set, const LeafRule& leaf_rule, Executor& executor);

  BuildRange root(Executor& executor) const;
  SweepSplit find(const BuildRange& range, Executor& executor);
  SweepSplit median(const BuildRange& range) const;
  void apply(const SweepSplit& split, const BuildRange& range, Executor& executor, BuildRange& left, BuildRange& right);
  void write_leaf(const BuildRange& range, std::uint32_t* ids) const;

  /// The cheapest split between two neighbours, whatever a leaf costs. Is none when a range has no area.
  SweepSplit sweep(const BuildRange& range, Executor& executor);
  /// Parts the range by another rule: those `goes_left` says yes to stand before the others, in each order.
  void apply(FunctionRef<bool(const refs::Reference&)> goes_left, const BuildRange& range, Executor& executor,
             BuildRange& left, BuildRange& right);
  /// Of a place in one axis's order.
  const refs::Reference& reference(int axis, std::size_t i) const { return references_[order_[axis][i]]; }
  float scale() const { return area_scale_; }

 private:
  /// The best split of each axis, found so far.
  struct Best {
    alignas(16) float cost[4] = {kInfinity, kInfinity, kInfinity, kInfinity};
    alignas(16) std::uint32_t mid[4] = {};
  };
  /// One chunk of a sweep: by axis, the boxes of its references and of all before and after it in the range.
  struct Part {
    Box4 box[3];
    Box4 before[3] = {Box4::empty(), Box4::empty(), Box4::empty()};
    Box4 after[3] = {Box4::empty(), Box4::empty(), Box4::empty()};
    Best best;
  };

  Box4 measure(int axis, std::size_t begin, std::size_t end) const;
  Box4 measure_in_chunks(int axis, std::size_t begin, std::size_t end, Executor& executor) const;
  Best sweep_chunk(const BuildRange& range, std::size_t begin, std::size_t end, const Part& part);
  Best sweep_in_chunks(const BuildRange& range, Executor& executor);
  void measure_children(int axis, BuildRange& left, BuildRange& right, Executor& executor) const;
  void partition(const BuildRange& range, std::uint32_t mid, int axis, Executor& executor);
  void measure_centroids(BuildRange& range) const;

  AlignedBuffer<refs::Reference> references_;
  AlignedBuffer<Float4> right_cost_;       ///< [i]: area * count of the references from i to the end, by axis
  AlignedBuffer<std::uint32_t> order_[3];  ///< reference numbers by centroid, per axis
  AlignedBuffer<std::uint32_t> other_;     ///< room for a partition
  AlignedBuffer<std::uint8_t> is_left_;    ///< by reference number: its side of the split at hand
  LeafRule leaf_rule_;
  float area_scale_ = 1;
};

}  // namespace boxwood::builders
