// Geometric partitioner (GP-BVH): the boxes of two children are chosen directly, and each reference goes where it fits.
// Popov, Georgiev, Dimov and Slusallek 2009, "Object Partitioning Considered Harmful", section 3 (bib key popov2009).
// The sides of the boxes lie on a grid over the node, or, for nodes of few references, on sides of references; a
// reference inside both boxes goes to the smaller one. The cheapest such partition competes with the best split between
// centroids, both with tight boxes. With `cost` = recursive, the cheapest of each of the 32 ways to share the node's
// sides, and the centroid split, are priced by trees of spatial medians (section 3.4).
//
// Ours differs: references are counted by a table over all boxes of grid cells, one look-up a query, where the paper
// walks an auxiliary tree in about sqrt(n) (`counting` = tree does that); the recursive price is for the cheapest 33
// candidates, not for all; the grid stops getting finer when the table reaches 2^24 entries. A node of n references has
// about K_R n configurations to price, of which most are skipped together: O(K_R n log n) for a build. The same bits
// for every number of threads: each of the 32 ways is searched by itself and ties go to the first.
#include "builders/builder_list.h"
#include "builders/parts/configuration_search.h"
#include "builders/parts/counting_tree.h"
#include "builders/parts/median_price.h"
#include "builders/parts/option_specs.h"
#include "builders/parts/sweep.h"
#include "builders/parts/top_down.h"

namespace boxwood::builders {
namespace {

constexpr const char* kExactMax = "exact.max";
constexpr const char* kCost = "cost";
constexpr const char* kCosts[] = {"plain", "recursive"};
constexpr const char* kCounting = "counting";
constexpr const char* kCountings[] = {"table", "tree"};

constexpr OptionSpec kOptions[] = {
    leaf_max_option(16, "most references in a leaf; 0: no limit but the cost"),
    grid_factor_option(),
    grid_rule_option(),
    {.key = kExactMax,
     .description = "up to so many references of a node, their own sides are the planes (Popov et al. 2009, 3.1)",
     .default_value = 0,
     .lowest = 0,
     .highest = 8,
     .integer = true},
    {.key = kCost,
     .description = "what partitions are compared by: plain = area times count; recursive = trees of spatial medians",
     .choices = kCosts},
    {.key = kCounting,
     .description = "what counts references on a grid; both give the same tree",
     .choices = kCountings},
};

/// The references on both sides of a partition, and their boxes.
struct Sides {
  std::vector<refs::Reference> left, right;
  Box left_box, right_box;
};

bool goes_left(const refs::Reference& reference, const Configuration& boxes, bool left_is_smaller) {
  const Side side = side_of(reference.box(), boxes);
  return side == Side::both ? left_is_smaller : side == Side::left;
}

struct GeometricSplit {
  enum class Kind { leaf, sweep, boxes };
  Kind kind = Kind::leaf;
  SweepSplit sweep;
  Configuration boxes;

  bool is_leaf() const { return kind == Kind::leaf; }
};

class GeometricFinder {
 public:
  GeometricFinder(refs::ReferenceSet&& set, const OptionValues& options, Executor& executor)
      : leaf_rule_(options.cost(), options.integer(kLeafMax)),
        cost_(options.cost()),
        grid_(options),
        exact_max_(options.integer(kExactMax)),
        recursive_(options.choice(kCost) == 1),
        table_(options.choice(kCounting) == 0),
        sweep_(std::move(set), leaf_rule_, executor) {}

  BuildRange root(Executor& executor) const { return sweep_.root(executor); }
  GeometricSplit median(const BuildRange& range) const {
    return {GeometricSplit::Kind::sweep, sweep_.median(range), {}};
  }
  void write_leaf(const BuildRange& range, std::uint32_t* ids) const { sweep_.write_leaf(range, ids); }

  void apply(const GeometricSplit& split, const BuildRange& range, Executor& executor, BuildRange& left,
             BuildRange& right) {
    if (split.kind == GeometricSplit::Kind::sweep) return sweep_.apply(split.sweep, range, executor, left, right);
    const bool left_is_smaller = is_left_smaller(split.boxes);
    const auto to_left = [&](const refs::Reference& reference) {
      return goes_left(reference, split.boxes, left_is_smaller);
    };
    sweep_.apply(to_left, range, executor, left, right);
  }

  GeometricSplit find(const BuildRange& range, Executor& executor) {
    const Box node = range.bounds.box();
    const double area = area_of(node);
    const auto leaf_or_median = [&] { return leaf_rule_.may_be_leaf(range.size()) ? GeometricSplit() : median(range); };
    if (!(area > 0)) return leaf_or_median();
    std::vector<refs::Reference> references;
    references.reserve(range.size());
    for (std::uint32_t i = range.first; i < range.last; ++i) references.push_back(sweep_.reference(0, i));

    double best_cost = std::numeric_limits<double>::infinity();
    GeometricSplit best;
    const auto consider = [&](double cost, const GeometricSplit& split) {
      if (cost < best_cost) best_cost = cost, best = split;
    };
    if (range.centroids2.box().extent() != Vec3{}) {
      const SweepSplit split = sweep_.sweep(range, executor);
      if (!split.is_leaf()) consider(price(split, range), {GeometricSplit::Kind::sweep, split, {}});
    }
    const auto found = search(node, references, area * range.size(), executor);
    std::array<double, kPatterns> costs;
    costs.fill(std::numeric_limits<double>::infinity());
    std::size_t cheapest = 0;
    for (std::size_t i = 1; i < kPatterns; ++i)
      if (found[i].cost < found[cheapest].cost) cheapest = i;
    executor.for_chunks(kPatterns, 1, [&](std::size_t i, std::size_t, std::size_t) {
      if (found[i].cost < area * range.size() && (recursive_ || i == cheapest))
        costs[i] = price(found[i].boxes, references);
    });
    for (std::size_t i = 0; i < kPatterns; ++i) consider(costs[i], {GeometricSplit::Kind::boxes, {}, found[i].boxes});
    if (leaf_rule_.prefers_leaf(range.size(), area, best_cost)) return {};
    return best.is_leaf() ? leaf_or_median() : best;
  }

 private:
  static constexpr std::size_t kPatterns = ConfigurationSearch<CountingTable>::kPatterns;

  double area_of(const Box& box) const { return scaled_half_area(box, sweep_.scale()); }
  bool is_left_smaller(const Configuration& boxes) const { return area_of(boxes.left) <= area_of(boxes.right); }

  std::array<PricedConfiguration, kPatterns> search(const Box& node, std::span<const refs::Reference> references,
                                                    double limit, Executor& executor) const {
    const bool exact = references.size() <= exact_max_;
    const CandidatePlanes planes = exact ? side_planes(references) : grid_planes(node, grid_.cells(references.size()));
    const ConfigurationPrice price{.area_scale = sweep_.scale()};
    const auto run = [&](const auto& counter) {
      const auto count = static_cast<std::uint32_t>(references.size());
      return ConfigurationSearch(node, count, planes, counter, price).run(limit, executor);
    };
    return exact || !table_ ? run(CountingTree(references, planes)) : run(CountingTable(references, planes));
  }

  /// Area times count of both sides, added, or what stands for it: the price of median trees, in units of C_I.
  double price(Sides& sides) const {
    if (!recursive_)
      return area_of(sides.left_box) * static_cast<double>(sides.left.size()) +
             area_of(sides.right_box) * static_cast<double>(sides.right.size());
    return (median_tree_price(sides.left, cost_, sweep_.scale()) +
            median_tree_price(sides.right, cost_, sweep_.scale())) /
           cost_.intersection;
  }

  double price(const Configuration& boxes, std::span<const refs::Reference> references) const {
    const bool left_is_smaller = is_left_smaller(boxes);
    Sides sides;
    for (const refs::Reference& reference : references) {
      const bool left = goes_left(reference, boxes, left_is_smaller);
      (left ? sides.left : sides.right).push_back(reference);
      (left ? sides.left_box : sides.right_box).grow(reference.box());
    }
    return price(sides);
  }

  double price(const SweepSplit& split, const BuildRange& range) const {
    if (!recursive_) return split.cost;
    Sides sides;
    for (std::uint32_t i = range.first; i < range.last; ++i) {
      const refs::Reference& reference = sweep_.reference(split.axis, i);
      (i < split.mid ? sides.left : sides.right).push_back(reference);
    }
    return price(sides);
  }

  LeafRule leaf_rule_;
  tree::CostModel cost_;
  GridRule grid_;
  std::uint32_t exact_max_;
  bool recursive_, table_;
  SweepFinder sweep_;
};

Result<tree::BinaryTree> build_geometric(refs::ReferenceSet&& set, const OptionValues& options,
                                         const BuildContext& context) {
  const auto make_finder = [&](refs::ReferenceSet&& references) {
    return GeometricFinder(std::move(references), options, context.executor);
  };
  return build_top_down(std::move(set), context, make_finder, kLargeSearch);
}

}  // namespace

constinit const BuilderInfo geometric_builder = {
    .id = "geometric",
    .name = "Geometric partitioner",
    .summary = "prices pairs of child boxes on a grid; best for studying nested and overlapping children",
    .paper = "popov2009",
    .cost_class = "O(K_R n log n)",
    .splits_references = false,
    .largest_sensible = 1 << 24,
    .options = kOptions,
    .build = &build_geometric,
};

}  // namespace boxwood::builders
