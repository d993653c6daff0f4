// The frame of builders whose split finder works on ReferenceRanges: they only have to write `find`.
#pragma once

#include "boxwood/builders.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/reference_ranges.h"
#include "builders/parts/top_down.h"

namespace boxwood::builders {

/// Base of the split finders: everything but `find`.
class PlaneFinder {
 public:
  PlaneFinder(ReferenceRanges& ranges, std::uint32_t leaf_max) : ranges_(ranges), leaf_max_(leaf_max) {}
  PlaneFinder(ReferenceRanges& ranges, const BuildRange&, const OptionValues& options)
      : PlaneFinder(ranges, options.integer(kLeafMax)) {}

  RangeSplit median(const BuildRange& range) const { return ranges_.median(range); }
  void apply(const RangeSplit& split, const BuildRange& range, Executor& executor, BuildRange& left,
             BuildRange& right) {
    ranges_.apply(split, range, executor, left, right);
  }
  void write_leaf(const BuildRange& range, std::uint32_t* ids) const { ranges_.write_leaf(range, ids); }

 protected:
  const ReferenceRanges& ranges() const { return ranges_; }

  /// pbrt's rule for builders without a cost: split until the leaf is small, or the centroids coincide and may stay.
  bool stops(const BuildRange& range) const {
    if (leaf_max_ != 0) return range.size() <= leaf_max_;
    return range.centroids2.box().extent() == Vec3{};
  }

 private:
  ReferenceRanges& ranges_;
  std::uint32_t leaf_max_;
};

/// The `build` function of a builder, from its finder. The finder is made with the ranges, the root and the options.
template <class Finder>
Result<tree::BinaryTree> build_with_planes(refs::ReferenceSet&& set, const OptionValues& options,
                                           const BuildContext& context) {
  const std::size_t primitive_count = set.primitive_count;
  TreePieces pieces;
  {
    ReferenceRanges ranges(std::move(set));
    const BuildRange root = ranges.root(context.executor);
    Finder finder(ranges, root, options);
    TopDownDriver<Finder> driver(finder, ranges.size(), context);
    if (!driver.run(root)) return cancelled_error();
    pieces = std::move(driver.pieces());
  }  // the references are no longer needed: their memory goes before the tree is put together
  return pieces.join(primitive_count, context.executor);
}

}  // namespace boxwood::builders
