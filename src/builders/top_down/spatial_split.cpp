// SS-BVH: space is parted by the cheapest plane through a side of a box; triangles on both sides of it are cut. Popov,
// Georgiev, Dimov and Slusallek 2009, section 5 (bib key popov2009), with the tight boxes and the planes between events
// of their 5.2 as options. Ours differs where the paper says nothing: the references of the tree are limited (`growth`;
// each range may use its share), and where that forbids the cheapest plane, whole references are split between bins of
// centroids if this is cheaper than the best plane that is left. Ranges over `leaf.max` that no plane pays for are
// parted whole as well, so that parts are never made for nothing. Events of a range are sorted by digits: O(n log n),
// parallel over ranges, axes and chunks; the same bits for every number of threads, as nothing depends on their order.
#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/leaf_rule.h"
#include "builders/parts/object_split.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/plane_sweep.h"

namespace boxwood::builders {
namespace {

constexpr const char* kAreas[] = {"box", "tight", "between"};  // in the order of SideAreas
constexpr int kObjectBins = 64;

struct SpatialSplit {
  enum class Kind { leaf, plane, objects, halves };
  Kind kind = Kind::leaf;
  PlaneSplit plane;
  ObjectSplit objects;

  bool is_leaf() const { return kind == Kind::leaf; }
};

class SpatialSplitFinder {
 public:
  SpatialSplitFinder(const refs::Primitives& primitives, const Box& bounds, const OptionValues& options)
      : primitives_(primitives),
        leaf_rule_(options.cost(), options.integer(kLeafMax)),
        area_scale_(area_scale(bounds)),
        areas_(static_cast<SideAreas>(options.choice("areas"))) {}

  SpatialSplit find(const SplittingRange& range, Executor& executor) const {
    const double area = scaled_half_area(range.bounds, area_scale_);
    SpatialSplit split;
    if (!(area > 0)) {
      if (!leaf_rule_.may_be_leaf(count(range))) split.kind = SpatialSplit::Kind::halves;
      return split;
    }
    const SweepResult planes =
        sweep_planes({range.references, primitives_, range.bounds, area_scale_, range.spare, areas_}, executor);
    split.plane = planes.best;
    split.kind = SpatialSplit::Kind::plane;
    double cost = planes.best.cost;
    const bool pays = cost < area * static_cast<double>(range.size());
    if (planes.overrun || !pays) {
      split.objects = best_object_split(range.references, kObjectBins, area_scale_, executor);
      if (!pays || split.objects.bins.cost < cost) {
        cost = split.objects.bins.cost;
        split.kind = split.objects.exists() ? SpatialSplit::Kind::objects : SpatialSplit::Kind::halves;
      }
    }
    if (leaf_rule_.prefers_leaf(count(range), area, cost)) split.kind = SpatialSplit::Kind::leaf;
    return split;
  }

  void apply(const SpatialSplit& split, SplittingRange&& range, Executor& executor, SplittingRange& left,
             SplittingRange& right) const {
    if (split.kind == SpatialSplit::Kind::plane) {
      const auto sides = [&](const refs::Reference& reference) { return split.plane.sides(reference, primitives_); };
      sift(range, split.plane.left, split.plane.right, executor, sides, left, right);
    } else if (split.kind == SpatialSplit::Kind::objects) {
      sift_objects(range, split.objects, executor, left, right);
    } else {
      right.references = std::move(range.references);  // all on one side: the driver halves them
    }
  }

 private:
  static std::uint32_t count(const SplittingRange& range) { return static_cast<std::uint32_t>(range.size()); }

  const refs::Primitives& primitives_;
  LeafRule leaf_rule_;
  float area_scale_;
  SideAreas areas_;
};

constexpr OptionSpec kOptions[] = {
    growth_option(1.5),
    {.key = "areas",
     .description = "what planes are priced by: parts of the node's box, tight boxes, tight also between events",
     .choices = kAreas},
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost")};

}  // namespace

constinit const BuilderInfo spatial_split_builder = {
    .id = "spatial-split",
    .name = "Spatial split",
    .summary =
        "cheapest plane through a side of a box, cutting triangles; best for long-lived scenes of walls and beams",
    .paper = "popov2009",
    .cost_class = "O(n log n)",
    .splits_references = true,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_splits<SpatialSplitFinder>,
};

}  // namespace boxwood::builders
