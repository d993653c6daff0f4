// The generic builder (G-BVH and its special cases GK-BVH and C-BVH) of Popov, Georgiev, Dimov and Slusallek 2009,
// "Object Partitioning Considered Harmful", section 4 (bib key popov2009). Oracles propose pairs of child boxes: the
// splits between centroids, planes at sides of references, boxes on a grid. References that both children hold only
// together are split, and the price of a pair grows with the volume that the children share, by eq. (5).
//
// Ours differs: the boxes of a pair are made tight before it is priced, parts of triangles clipped exactly, for those
// pairs that a coarse price says are worth it; pairs on the grid are counted by a table; the number of references has a
// limit (`growth`), and where it forbids the pair that looks best, the centroid splits compete at their plain price. A
// node of n references costs O(n log n) for centroids and planes and O(K_R n) for the grid. The same bits for every
// number of threads: candidates are priced in a fixed order, in fixed batches.
#include "builders/builder_list.h"
#include "builders/parts/centroid_sweep.h"
#include "builders/parts/configuration_search.h"
#include "builders/parts/configuration_sift.h"
#include "builders/parts/leaf_rule.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/reference_budget.h"
#include "builders/parts/splitting_driver.h"
#include "builders/parts/tight_planes.h"

namespace boxwood::builders {
namespace {

constexpr const char* kCentroidOracle = "oracle.centroid";
constexpr const char* kKdOracle = "oracle.kd";
constexpr const char* kGridOracle = "oracle.grid";
constexpr const char* kOverlap = "overlap";

constexpr OptionSpec oracle_option(const char* key, const char* description) {
  return {.key = key, .description = description, .default_value = 1, .lowest = 0, .highest = 1, .integer = true};
}

constexpr OptionSpec kOptions[] = {
    oracle_option(kCentroidOracle, "1: consider splits between centroids (CentroidGen of Popov et al. 2009)"),
    oracle_option(kKdOracle, "1: consider planes at sides of references (KDNodeGen)"),
    oracle_option(kGridOracle, "1: consider boxes with sides on a grid (GridGen)"),
    {.key = kOverlap,
     .description = "C_O, the price of volume that two children share (Popov et al. 2009, eq. 5)",
     .default_value = 1e16,
     .lowest = 0,
     .highest = 1e30},
    grid_factor_option(),
    grid_rule_option(),
    growth_option(2),
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost"),
};

struct GenericSplit {
  enum class Kind { leaf, halves, centroid, boxes };
  Kind kind = Kind::leaf;
  CentroidSplit centroid;
  Configuration boxes;
  double cost = std::numeric_limits<double>::infinity();

  bool is_leaf() const { return kind == Kind::leaf; }
};

class GenericFinder {
 public:
  GenericFinder(const refs::ReferenceSet& set, const OptionValues& options)
      : primitives_(*set.primitives),
        leaf_rule_(options.cost(), options.integer(kLeafMax)),
        leaf_bonus_(options.cost().traversal / options.cost().intersection),
        grid_(options),
        use_centroids_(options.integer(kCentroidOracle) == 1),
        use_planes_(options.integer(kKdOracle) == 1),
        use_grid_(options.integer(kGridOracle) == 1) {
    Box bounds;
    for (const refs::Reference& reference : set.references) bounds.grow(reference.box());
    price_.area_scale = area_scale(bounds);
    price_.overlap = options.number(kOverlap);
    price_.may_split = true;
  }

  GenericSplit find(const SplittingRange& range, Executor& executor) const {
    const auto count = static_cast<std::uint32_t>(range.size());
    const bool may_be_leaf = leaf_rule_.may_be_leaf(count);
    const GenericSplit halves{.kind = GenericSplit::Kind::halves, .centroid = {}, .boxes = {}};
    const double area = scaled_half_area(range.bounds, price_.area_scale);
    if (!(area > 0)) return may_be_leaf ? GenericSplit() : halves;
    ConfigurationPrice price = price_;
    price.spare = range.spare;
    // What costs more than this is no better than a leaf.
    const double limit = area * (may_be_leaf ? count - leaf_bonus_ : count);
    GenericSplit best;
    double refused = std::numeric_limits<double>::infinity();
    if (use_centroids_) consider_centroids(range, price, executor, best);
    if (use_planes_) refused = consider_planes(range, price, limit, executor, best);
    if (use_grid_) refused = std::min(refused, consider_grid(range, price, limit, executor, best));
    if (refused < std::min(best.cost, limit)) {
      price.overlap = 0;
      consider_centroids(range, price, executor, best);
    }
    if (leaf_rule_.prefers_leaf(count, area, best.cost)) return {};
    if (!best.is_leaf()) return best;
    return may_be_leaf ? GenericSplit() : halves;
  }

  void apply(const GenericSplit& split, SplittingRange&& range, Executor& executor, SplittingRange& left,
             SplittingRange& right) const {
    if (split.kind == GenericSplit::Kind::halves) {
      left.references = std::move(range.references);  // the driver halves what ends up on one side
      return;
    }
    const std::span<const refs::Reference> all = range.references;
    const std::size_t chunk = all.size() > kLargeSearch ? kLargeSearch : all.size();
    struct Parts {
      std::vector<refs::Reference> left, right;
    };
    std::vector<Parts> parts((all.size() + chunk - 1) / chunk);
    executor.for_chunks(all.size(), chunk, [&](std::size_t i, std::size_t begin, std::size_t end) {
      if (split.kind == GenericSplit::Kind::boxes) {
        Sifter(primitives_, split.boxes, price_.area_scale)
            .sift(all.subspan(begin, end - begin), parts[i].left, parts[i].right);
        return;
      }
      for (std::size_t k = begin; k < end; ++k)
        (split.centroid.goes_left(all[k], static_cast<std::uint32_t>(k)) ? parts[i].left : parts[i].right)
            .push_back(all[k]);
    });
    left.references = std::move(parts[0].left), right.references = std::move(parts[0].right);
    for (std::size_t i = 1; i < parts.size(); ++i) {
      left.references.insert(left.references.end(), parts[i].left.begin(), parts[i].left.end());
      right.references.insert(right.references.end(), parts[i].right.begin(), parts[i].right.end());
    }
    left.measure(), right.measure();
    const SpareShares shares = share_rest(range.spare, all.size(), left.size(), right.size());
    left.spare = shares.left, right.spare = shares.right;
  }

 private:
  /// So many pairs of boxes are measured exactly at a node, at most.
  static constexpr std::size_t kMostMeasured = 64;
  /// So many at once where a range is large enough for several threads.
  static constexpr std::size_t kBatch = 8;

  struct Candidate {
    Configuration boxes;
    double least;  ///< the cost is not below
  };

  static void consider_centroids(const SplittingRange& range, const ConfigurationPrice& price, Executor& executor,
                                 GenericSplit& best) {
    const CentroidSplit split = sweep_centroids(range.references, range.bounds, price, executor);
    if (split.cost < best.cost)
      best = {.kind = GenericSplit::Kind::centroid, .centroid = split, .boxes = {}, .cost = split.cost};
  }

  /// Returns the least that a plane may cost that is not allowed for its number of split references.
  double consider_planes(const SplittingRange& range, const ConfigurationPrice& price, double limit, Executor& executor,
                         GenericSplit& best) const {
    const TightPlanes found = tight_planes(range.references, range.bounds, price, std::min(limit, best.cost), executor);
    std::vector<Candidate> candidates;
    for (const TightPlane& plane : found.planes) {
      Configuration boxes{range.bounds, range.bounds};
      boxes.left.upper[plane.axis] = boxes.right.lower[plane.axis] = plane.position;
      candidates.push_back({boxes, plane.least});
    }
    consider(candidates, range, price, executor, best);
    return found.refused;
  }

  /// The same for the grid.
  double consider_grid(const SplittingRange& range, const ConfigurationPrice& price, double limit, Executor& executor,
                       GenericSplit& best) const {
    const CandidatePlanes planes = grid_planes(range.bounds, grid_.cells(range.size()));
    const CountingTable table(range.references, planes);
    const ConfigurationSearch search(range.bounds, static_cast<std::uint32_t>(range.size()), planes, table, price);
    std::vector<Candidate> candidates;
    double refused = std::numeric_limits<double>::infinity();
    for (const PricedConfiguration& found : search.run(limit, executor)) {
      if (found.cost < limit) candidates.push_back({found.boxes, 0});
      refused = std::min(refused, found.refused);
    }
    consider(candidates, range, price, executor, best);
    return refused;
  }

  void consider(const std::vector<Candidate>& candidates, const SplittingRange& range, const ConfigurationPrice& price,
                Executor& executor, GenericSplit& best) const {
    const std::size_t batch = range.size() > kLargeSearch ? kBatch : 1;
    std::vector<std::size_t> chosen;
    std::vector<double> costs(batch);
    for (std::size_t next = 0, measured = 0; next < candidates.size() && measured < kMostMeasured;) {
      chosen.clear();
      for (; next < candidates.size() && chosen.size() < batch; ++next)
        if (candidates[next].least < best.cost) chosen.push_back(next);
      executor.for_chunks(chosen.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
        costs[i] = measure(candidates[chosen[i]].boxes, range, price);
      });
      for (std::size_t i = 0; i < chosen.size(); ++i)
        if (costs[i] < best.cost)
          best = {.kind = GenericSplit::Kind::boxes,
                  .centroid = {},
                  .boxes = candidates[chosen[i]].boxes,
                  .cost = costs[i]};
      measured += chosen.size();
    }
  }

  double measure(const Configuration& boxes, const SplittingRange& range, const ConfigurationPrice& price) const {
    SiftedSide left, right;
    Sifter(primitives_, boxes, price.area_scale).measure(range.references, left, right);
    if (left.count == 0 || right.count == 0) return std::numeric_limits<double>::infinity();
    return price.penalty(left.bounds, right.bounds, range.bounds) *
           (static_cast<double>(scaled_half_area(left.bounds, price.area_scale)) * static_cast<double>(left.count) +
            static_cast<double>(scaled_half_area(right.bounds, price.area_scale)) * static_cast<double>(right.count));
  }

  const refs::Primitives& primitives_;
  LeafRule leaf_rule_;
  double leaf_bonus_;
  GridRule grid_;
  bool use_centroids_, use_planes_, use_grid_;
  ConfigurationPrice price_;
};

Result<tree::BinaryTree> build_generic(refs::ReferenceSet&& set, const OptionValues& options,
                                       const BuildContext& context) {
  if (options.integer(kCentroidOracle) + options.integer(kKdOracle) + options.integer(kGridOracle) == 0)
    return {ErrorCode::invalid_argument,
            "builder 'generic' needs at least one of oracle.centroid, oracle.kd and oracle.grid to be 1"};
  const std::shared_ptr<const refs::Primitives> primitives = set.primitives;
  const std::uint64_t spare = spare_references(set.references.size(), options.number(kGrowth));
  GenericFinder finder(set, options);
  SplittingDriver<GenericFinder> driver(finder, context, kLargeSearch);
  return driver.run(std::move(set), spare);
}

}  // namespace

constinit const BuilderInfo generic_builder = {
    .id = "generic",
    .name = "Generic builder",
    .summary =
        "cheapest pair of child boxes from several oracles, splitting references; best for trees without overlap",
    .paper = "popov2009",
    .cost_class = "O(K_R n log n)",
    .splits_references = true,
    .largest_sensible = 1 << 24,
    .options = kOptions,
    .build = &build_generic,
};

}  // namespace boxwood::builders
