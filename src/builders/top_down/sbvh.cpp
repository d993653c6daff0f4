// SBVH: at each node the cheaper of an object split and a spatial split that cuts triangles. Stich, Friedrich and
// Dietrich 2009 (bib key stich2009), the combination that Popov et al. 2009 suggest in 5.1. Object splits are binned
// (wald2007); spatial splits are looked for where the best object split's sides overlap by more than `alpha` of the
// root's area, between bins into which references are chopped. A reference that the plane cuts goes to one side whole
// where this is cheaper (reference unsplitting).
//
// Ours differs: the overlap must also be a part of the node's own area (`overlap`), since below that planes cost a
// build more than they gain; whether to unsplit is decided for each reference against the sides as the bins give them,
// not as they have become by earlier decisions, so that it does not depend on any order; the references of the tree are
// limited (`growth`), each range has a share by its area times its references. O(n log n) while references pass few
// bins; parallel over ranges and chunks; the same bits for every number of threads.
#include <algorithm>
#include <memory>

#include "builders/builder_list.h"
#include "builders/parts/area_scale.h"
#include "builders/parts/leaf_rule.h"
#include "builders/parts/object_split.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/spatial_bins.h"
#include "math/clip.h"

namespace boxwood::builders {
namespace {

/// A spatial split that may leave references whole.
class UnsplittingRule {
 public:
  UnsplittingRule(const SpatialBinSplit& split, float area_scale)
      : split_(split),
        scale_(area_scale),
        left_count_(static_cast<double>(split.plane.left)),
        right_count_(static_cast<double>(split.plane.right)),
        left_area_(scaled_half_area(split.left, area_scale)),
        right_area_(scaled_half_area(split.right, area_scale)) {}

  Sides sides(const refs::Reference& reference, const refs::Primitives& primitives) const {
    const Sides cut = split_.plane.sides(reference, primitives);
    if (cut.left.is_empty() || cut.right.is_empty()) return cut;
    const Box box = reference.box();
    const double both = left_area_ * left_count_ + right_area_ * right_count_;
    const double left = area(merge(split_.left, box)) * left_count_ + right_area_ * (right_count_ - 1);
    const double right = left_area_ * (left_count_ - 1) + area(merge(split_.right, box)) * right_count_;
    if (both < left && both < right) return cut;
    return left <= right ? Sides::only_left(reference) : Sides::only_right(reference);
  }

 private:
  double area(const Box& box) const { return scaled_half_area(box, scale_); }

  const SpatialBinSplit& split_;
  float scale_;
  double left_count_, right_count_, left_area_, right_area_;
};

struct SbvhSplit {
  enum class Kind { leaf, spatial, objects, halves };
  Kind kind = Kind::leaf;
  SpatialBinSplit spatial;
  ObjectSplit objects;

  bool is_leaf() const { return kind == Kind::leaf; }
};

class SbvhFinder {
 public:
  SbvhFinder(const refs::Primitives& primitives, const Box& bounds, const OptionValues& options)
      : primitives_(primitives),
        leaf_rule_(options.cost(), options.integer(kLeafMax)),
        area_scale_(area_scale(bounds)),
        least_overlap_(options.number("alpha") * scaled_half_area(bounds, area_scale_)),
        least_own_overlap_(options.number("overlap")),
        object_bins_(static_cast<int>(options.integer("bins"))),
        spatial_bins_(static_cast<int>(options.integer("spatial.bins"))) {}

  SbvhSplit find(const SplittingRange& range, Executor& executor) const {
    const double area = scaled_half_area(range.bounds, area_scale_);
    const auto count = static_cast<std::uint32_t>(range.size());
    SbvhSplit split;
    if (!(area > 0)) {
      if (!leaf_rule_.may_be_leaf(count)) split.kind = SbvhSplit::Kind::halves;
      return split;
    }
    split.objects = best_object_split(range.references, object_bins_, area_scale_, executor);
    split.kind = split.objects.exists() ? SbvhSplit::Kind::objects : SbvhSplit::Kind::halves;
    double cost = split.objects.bins.cost;
    if (range.spare > 0 && overlaps(split.objects, area)) {
      split.spatial = fill_bins(range, executor).best_split(range.size(), range.spare, area_scale_);
      const double spatial_cost = split.spatial.plane.cost;
      if (spatial_cost < cost && spatial_cost < area * count) {
        cost = spatial_cost;
        split.kind = SbvhSplit::Kind::spatial;
      }
    }
    if (leaf_rule_.prefers_leaf(count, area, cost)) split.kind = SbvhSplit::Kind::leaf;
    return split;
  }

  void apply(const SbvhSplit& split, SplittingRange&& range, Executor& executor, SplittingRange& left,
             SplittingRange& right) const {
    if (split.kind == SbvhSplit::Kind::spatial) {
      const UnsplittingRule rule(split.spatial, area_scale_);
      const auto sides = [&](const refs::Reference& reference) { return rule.sides(reference, primitives_); };
      sift(range, split.spatial.plane.left, split.spatial.plane.right, executor, sides, left, right);
    } else if (split.kind == SbvhSplit::Kind::objects) {
      sift_objects(range, split.objects, executor, left, right);
    } else {
      right.references = std::move(range.references);  // all on one side: the driver halves them
      return;
    }
    share_by_area(left, right, area_scale_);
  }

 private:
  /// Do the sides of the object split overlap by enough? Without one, references coincide: they do.
  bool overlaps(const ObjectSplit& split, double area) const {
    if (!split.exists()) return true;
    const Box both = intersection(split.bins.left.box(), split.bins.right.box());
    return !both.is_empty() &&
           scaled_half_area(both, area_scale_) >= std::max(least_overlap_, least_own_overlap_ * area);
  }

  SpatialBins fill_bins(const SplittingRange& range, Executor& executor) const {
    const auto count =
        static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(spatial_bins_), 4 + 2 * range.size()));
    SpatialBins bins(range.bounds, count);
    if (range.size() <= kLargeRange) {
      for (const refs::Reference& reference : range.references) bins.add(reference, primitives_);
      return bins;
    }
    std::vector<std::unique_ptr<SpatialBins>> chunks((range.size() + kChunk - 1) / kChunk);
    executor.for_chunks(range.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      chunks[chunk] = std::make_unique<SpatialBins>(range.bounds, count);
      for (std::size_t i = begin; i < end; ++i) chunks[chunk]->add(range.references[i], primitives_);
    });
    for (const auto& chunk : chunks) bins.add(*chunk);
    return bins;
  }

  const refs::Primitives& primitives_;
  LeafRule leaf_rule_;
  float area_scale_;
  double least_overlap_, least_own_overlap_;
  int object_bins_, spatial_bins_;
};

constexpr OptionSpec kOptions[] = {
    {.key = "bins",
     .description = "bins of centroids per axis for object splits; fewer are used for few references",
     .default_value = 64,
     .lowest = 2,
     .highest = kMostBins,
     .integer = true},
    {.key = "spatial.bins",
     .description = "bins of space per axis for spatial splits (stich2009)",
     .default_value = 16,
     .lowest = 2,
     .highest = kMostSpatialBins,
     .integer = true},
    {.key = "alpha",
     .description = "overlap of the sides, by the root's area, from which on spatial splits are tried (stich2009)",
     .default_value = 1e-5,
     .lowest = 0,
     .highest = 1},
    {.key = "overlap",
     .description = "overlap of the sides, by the node's own area, from which on spatial splits are tried",
     .default_value = 0.1,
     .lowest = 0,
     .highest = 1},
    growth_option(2),
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost")};

}  // namespace

constinit const BuilderInfo sbvh_builder = {
    .id = "sbvh",
    .name = "SBVH",
    .summary = "splits objects or, where these overlap, space; best for the fastest rays through architecture",
    .paper = "stich2009",
    .cost_class = "O(n log n)",
    .splits_references = true,
    .largest_sensible = kMostReferences,
    .options = kOptions,
    .build = &build_with_splits<SbvhFinder>,
};

}  // namespace boxwood::builders
