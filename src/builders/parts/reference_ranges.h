// References in two buffers, sorted from one into the other as ranges are split: what the top-down builders that look
// at one split plane share.
#pragma once

#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/build_range.h"

namespace boxwood::builders {

/// How to take a range of references apart.
struct RangeSplit {
  enum class Kind { leaf, plane, median, index_halves };

  Kind kind = Kind::leaf;
  int axis = 0;
  /// Plane: references with (centroid2 - origin) * scale < threshold go left; `mid` is where the right ones begin.
  float origin = 0, scale = 1, threshold = 0;
  std::uint32_t mid = 0;
  /// Plane: boxes of both sides, when whoever found it has them.
  bool has_boxes = false;
  Box4 left, right;
  /// Plane in a large range: references of each chunk that go left.
  std::vector<std::uint32_t> left_per_chunk;

  bool is_leaf() const { return kind == Kind::leaf; }
};

/// Boxes of references and of their (doubled) centroids.
struct ReferenceBoxes {
  Box4 bounds = Box4::empty(), centroids2 = Box4::empty();

  void add(const refs::Reference& reference, Float4 mask) {
    const Box4 box = Box4::of(reference);
    bounds.grow(box);
    centroids2.grow(centroid2(box, mask));
  }
  void add(const ReferenceBoxes& other) {
    bounds.grow(other.bounds);
    centroids2.grow(other.centroids2);
  }
};

/// Both sides of a partition.
struct ReferenceSides {
  ReferenceBoxes left, right;
};

class ReferenceRanges {
 public:
  /// Takes the references; needs as much memory again.
  explicit ReferenceRanges(refs::ReferenceSet&& set);

  std::uint32_t size() const { return static_cast<std::uint32_t>(buffers_[0].size()); }
  const refs::Reference* references(const BuildRange& range) const {
    return buffers_[range.buffer].data() + range.first;
  }

  /// The range of all references.
  BuildRange root(Executor& executor) const;
  /// A split by the median centroid on the axis on which the centroids spread widest, by index where they coincide.
  RangeSplit median(const BuildRange& range) const;
  /// Fills in `mid` and `left_per_chunk` of a plane by counting.
  void count(const BuildRange& range, RangeSplit& split, Executor& executor) const;
  /// Sorts the references to the sides of the split and gives both ranges. Stable but for `median`. O(n).
  void apply(const RangeSplit& split, const BuildRange& range, Executor& executor, BuildRange& left, BuildRange& right);
  void write_leaf(const BuildRange& range, std::uint32_t* ids) const;

 private:
  void partition(const RangeSplit& split, const BuildRange& range, Executor& executor, BuildRange& left,
                 BuildRange& right);
  void measure(BuildRange& range, Executor& executor) const;

  AlignedBuffer<refs::Reference> buffers_[2];
};

}  // namespace boxwood::builders
