// KD-BVH: a KD tree made into a bounding volume hierarchy. Space is parted by the plane that is cheapest for the cell
// of the node, among all sides of the boxes of the clipped triangles ("perfect splits"; Wald and Havran 2006, bib key
// wald2006); then empty leaves go, nodes that keep one child only are replaced by it, and boxes are fitted around the
// clipped triangles (Popov, Georgiev, Dimov and Slusallek 2009, 4.5, popov2009).
//
// Ours differs: empty leaves are never made: cutting off empty space just makes the cell smaller, which leads to the
// same tree. The references of the tree are limited (`growth`), each range may use its share; where the limit forbids
// every plane that pays, and below the depth limit, whole references are halved. Events of a range are sorted by digits
// instead of being kept sorted: O(n log n) as in wald2006. Parallel over ranges, axes and chunks; the same bits for
// every number of threads, as nothing depends on their order.
#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/leaf_rule.h"
#include "builders/parts/object_split.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/plane_sweep.h"

namespace boxwood::builders {
namespace {

constexpr int kObjectBins = 64;

struct KdSplit {
  enum class Kind { leaf, plane, objects, halves };
  Kind kind = Kind::leaf;
  PlaneSplit plane;
  ObjectSplit objects;
  Box cell;  ///< of the node, without the empty space that was cut off

  bool is_leaf() const { return kind == Kind::leaf; }
};

class KdFinder {
 public:
  KdFinder(const refs::Primitives& primitives, const Box& bounds, const OptionValues& options)
      : primitives_(primitives),
        leaf_rule_(options.cost(), options.integer(kLeafMax)),
        area_scale_(area_scale(bounds)),
        empty_factor_(1 - options.number("empty.bonus")) {}

  KdSplit find(const SplittingRange& range, Executor& executor) const {
    const auto count = static_cast<std::uint32_t>(range.size());
    KdSplit split;
    split.cell = range.cell;
    while (true) {
      const double area = scaled_half_area(split.cell, area_scale_);
      if (!(area > 0)) {
        if (!leaf_rule_.may_be_leaf(count)) split.kind = KdSplit::Kind::halves;
        return split;
      }
      const SweepResult planes = sweep_planes({.references = range.references,
                                               .primitives = primitives_,
                                               .region = split.cell,
                                               .area_scale = area_scale_,
                                               .spare = range.spare,
                                               .empty_factor = empty_factor_},
                                              executor);
      split.plane = planes.best;
      split.kind = KdSplit::Kind::leaf;
      if (leaf_rule_.prefers_leaf(count, area, planes.best.cost)) return split;
      const bool pays = planes.best.cost < area * count;
      if (!pays) return whole(split, range, executor);
      split.kind = KdSplit::Kind::plane;
      if (planes.best.left != 0 && planes.best.right != 0) return split;
      // Empty space: each side of the cell is cut to its references once at most.
      float& side = (planes.best.left == 0 ? split.cell.lower : split.cell.upper)[planes.best.axis];
      side = planes.best.position;
    }
  }

  void apply(const KdSplit& split, SplittingRange&& range, Executor& executor, SplittingRange& left,
             SplittingRange& right) const {
    left.cell = right.cell = range.cell = split.cell;
    if (split.kind == KdSplit::Kind::plane) {
      left.cell.upper[split.plane.axis] = right.cell.lower[split.plane.axis] = split.plane.position;
      const auto sides = [&](const refs::Reference& reference) { return split.plane.sides(reference, primitives_); };
      sift(range, split.plane.left, split.plane.right, executor, sides, left, right);
    } else if (split.kind == KdSplit::Kind::objects) {
      sift_objects(range, split.objects, executor, left, right);
    } else {
      right.references = std::move(range.references);  // all on one side: the driver halves them
    }
  }

 private:
  /// Over the leaf limit, and no plane pays.
  KdSplit whole(KdSplit split, const SplittingRange& range, Executor& executor) const {
    split.objects = best_object_split(range.references, kObjectBins, area_scale_, executor);
    split.kind = split.objects.exists() ? KdSplit::Kind::objects : KdSplit::Kind::halves;
    return split;
  }

  const refs::Primitives& primitives_;
  LeafRule leaf_rule_;
  float area_scale_;
  double empty_factor_;
};

constexpr OptionSpec kOptions[] = {
    {.key = "empty.bonus",
     .description = "by which share planes that cut off empty space are taken for cheaper (wald2006)",
     .default_value = 0.2,
     .lowest = 0.001,
     .highest = 0.999},
    growth_option(8),
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost")};

}  // namespace

constinit const BuilderInfo kd_builder = {
    .id = "kd",
    .name = "KD tree",
    .summary = "parts space by perfect splits as KD trees do, then boxes what is left; best to compare others with",
    .paper = "wald2006, popov2009",
    .cost_class = "O(n log n)",
    .splits_references = true,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_splits<KdFinder>,
};

}  // namespace boxwood::builders
