// Reinsertion: subtrees are taken out of a binary tree and put where they cost less, as Bittner, Hapala and Havran 2013
// (bib key bittner2013) do one after the other and Meister and Bittner 2018 (bib key meister2018) many at once.
//
// Ours differs from the latter: nothing depends on threads. Each pass searches the best place of all nodes in a tree
// that does not change meanwhile (reinsertion_search.h), sorts the moves by gain, then by node, and makes them in that
// order, leaving out those that touch nodes which an earlier one has touched and those that would put a node below
// itself. Then boxes are fitted again. A move's true gain may be less than was foreseen, since others were made beside
// it, so the best tree so far counts and passes end when they gain too little. O(passes * nodes * what a search
// visits): searches, fitting and sums are parallel, making the moves is not.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <new>
#include <string>

#include "boxwood/optimizers.h"
#include "optimizers/reinsertion_search.h"

namespace boxwood::optimizers {
namespace {

constexpr std::size_t kNodesPerChunk = 1 << 9;
constexpr std::size_t kPairsPerChunk = 1 << 13;

PairedTree pair_up(const tree::BinaryTree& tree, Executor& executor) {
  PairedTree paired;
  paired.nodes = AlignedBuffer<tree::Node>(tree.nodes.size() + 1);
  paired.parents.resize(paired.nodes.size() / 2);
  executor.for_chunks(tree.nodes.size(), kPairsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t place = i == 0 ? 0 : i + 1;
      tree::Node& node = paired.nodes[place] = tree.nodes[i];
      if (node.is_leaf()) continue;
      ++node.first;
      paired.parents[node.first / 2] = static_cast<std::uint32_t>(place);
    }
  });
  paired.nodes[1] = {};
  return paired;
}

/// Puts `node` beside `target`; boxes are left as they are.
void move(PairedTree& tree, std::uint32_t node, std::uint32_t target) {
  const std::uint32_t sibling = PairedTree::sibling(node), parent = tree.parent(node);
  const auto put = [&](const tree::Node& content, std::uint32_t place) {
    tree.nodes[place] = content;
    if (!content.is_leaf()) tree.parents[content.first / 2] = place;
  };
  put(tree.nodes[sibling], parent);
  put(tree.nodes[target], sibling);
  tree.nodes[target].first = node & ~1u;
  tree.nodes[target].count = 0;
  tree.parents[node / 2] = target;
}

/// Levels that are climbed to find out whether a node is below another; where that is not enough, it counts as below.
constexpr int kMostLevels = 1 << 12;

bool is_below(const PairedTree& tree, std::uint32_t node, std::uint32_t ancestor) {
  int level = 0;
  while (node != 0 && node != ancestor && level++ < kMostLevels) node = tree.parent(node);
  return node != 0;
}

class Moves {
 public:
  explicit Moves(std::size_t nodes) : touched_(nodes) {}

  /// Makes the moves, best first, that can be made side by side. Returns how many.
  std::size_t make(std::vector<Reinsertion>& moves, PairedTree& tree) {
    std::sort(moves.begin(), moves.end(), [](const Reinsertion& a, const Reinsertion& b) {
      return a.gain > b.gain || (a.gain == b.gain && a.node < b.node);
    });
    std::fill(touched_.begin(), touched_.end(), std::uint8_t{0});
    std::size_t made = 0;
    for (const Reinsertion& m : moves) {
      const std::uint32_t places[] = {m.node, PairedTree::sibling(m.node), tree.parent(m.node), m.target};
      if (std::any_of(std::begin(places), std::end(places), [&](std::uint32_t p) { return touched_[p] != 0; }))
        continue;
      // A move made before may have put the target below the node.
      if (is_below(tree, m.target, m.node)) continue;
      for (const std::uint32_t place : places) touched_[place] = 1;
      move(tree, m.node, m.target);
      ++made;
    }
    return made;
  }

 private:
  std::vector<std::uint8_t> touched_;
};

/// Fits all inner boxes to what is below: whoever comes second to a node from below goes on to its parent.
class Refit {
 public:
  explicit Refit(std::size_t pairs) : visits_(pairs) {}

  void run(PairedTree& tree, Executor& executor) {
    const std::size_t pairs = visits_.size();
    executor.for_chunks(pairs, kPairsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visits_[i].store(0, std::memory_order_relaxed);
    });
    executor.for_chunks(pairs - 1, kPairsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t node = 2 * (i + 1); node < 2 * (i + 1) + 2; ++node)
          if (tree.nodes[node].is_leaf()) climb(tree, static_cast<std::uint32_t>(node));
    });
  }

 private:
  void climb(PairedTree& tree, std::uint32_t node) {
    while (node != 0) {
      if (visits_[node / 2].fetch_add(1, std::memory_order_acq_rel) == 0) return;
      const std::uint32_t left = node & ~1u;
      node = tree.parent(node);
      tree.nodes[node].bounds = merge(tree.nodes[left].bounds, tree.nodes[left + 1].bounds);
    }
  }

  std::vector<std::atomic<std::uint8_t>> visits_;
};

template <class Price>
double price_of(const PairedTree& tree, const Price& price, Executor& executor) {
  const std::size_t nodes = tree.nodes.size();
  std::vector<double> sums((nodes + kPairsPerChunk - 1) / kPairsPerChunk);
  executor.for_chunks(nodes, kPairsPerChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      if (i != 1 && !tree.nodes[i].is_leaf()) sum += static_cast<double>(price(tree.nodes[i].bounds));
    sums[chunk] = sum;
  });
  double sum = 0;
  for (const double part : sums) sum += part;
  return sum;
}

/// The price that the dearest `share` of all nodes have at least.
template <class Price>
float least_price(const PairedTree& tree, const Price& price, float share, Executor& executor) {
  if (share >= 1) return 0;
  std::vector<float> prices(tree.nodes.size() - 2);
  executor.for_chunks(prices.size(), kPairsPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) prices[i] = price(tree.nodes[i + 2].bounds);
  });
  const auto dearest = static_cast<std::ptrdiff_t>(double(share) * double(prices.size() - 1));
  std::nth_element(prices.begin(), prices.begin() + dearest, prices.end(), std::greater<>());
  return prices[static_cast<std::size_t>(dearest)];
}

template <class Price>
std::vector<Reinsertion> find_moves(const PairedTree& tree, const Price& price, float share, Executor& executor) {
  const std::size_t nodes = tree.nodes.size();
  const float least = least_price(tree, price, share, executor);
  std::vector<std::vector<Reinsertion>> found((nodes + kNodesPerChunk - 1) / kNodesPerChunk);
  executor.for_chunks(nodes, kNodesPerChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    ReinsertionSearch<Price> search(tree, price);
    for (std::size_t i = std::max<std::size_t>(begin, 2); i < end; ++i) {
      if (price(tree.nodes[i].bounds) < least) continue;
      const Reinsertion move = search.best_place(static_cast<std::uint32_t>(i));
      if (move.gain > 0) found[chunk].push_back(move);
    }
  });
  std::vector<Reinsertion> moves;
  for (const auto& chunk : found) moves.insert(moves.end(), chunk.begin(), chunk.end());
  return moves;
}

template <class Price>
tree::BinaryTree optimize(tree::BinaryTree&& tree, const ReinsertionOptions& options, const Price& price,
                          Executor& executor, ReinsertionReport& report) {
  PairedTree paired = pair_up(tree, executor);
  tree.nodes = {};
  AlignedBuffer<tree::Node> best = paired.nodes.clone();
  Moves moves(paired.nodes.size());
  Refit refit(paired.parents.size());
  double cost = report.price_before = price_of(paired, price, executor);
  double least = cost;
  for (int pass = 0; pass < options.passes; ++pass) {
    std::vector<Reinsertion> found = find_moves(paired, price, options.share, executor);
    const std::size_t made = moves.make(found, paired);
    if (made == 0) break;
    refit.run(paired, executor);
    const double before = cost;
    cost = price_of(paired, price, executor);
    report.moves += made, ++report.passes;
    if (cost < least) least = cost, std::copy(paired.nodes.begin(), paired.nodes.end(), best.begin());
    if (!(before - cost > double(options.least_gain) * before)) break;
  }
  report.price_after = least;
  tree::BinaryTree result =
      tree::canonicalize(best.span(), tree.references.span(), tree.primitive_count, tree.splits_references, executor);
  result.notes = std::move(tree.notes);
  return result;
}

/// Surface area, of boxes that are never empty. Lengths are scaled by a power of two, as areas of very small or large
/// meshes would not fit a float.
class SurfaceArea {
 public:
  explicit SurfaceArea(const Box& scene) {
    const float longest = scene.extent()[scene.widest_axis()];
    int exponent = 0;
    if (longest > 0) std::frexp(longest, &exponent);
    scale_ = std::ldexp(1.0f, -std::max(exponent, -126));
  }
  float operator()(const Box& box) const {
    const Vec3 e = (box.upper - box.lower) * scale_;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }

 private:
  float scale_;
};

Status check_options(const ReinsertionOptions& options) {
  if (options.passes < 0 || options.passes > kMostReinsertionPasses)
    return {ErrorCode::out_of_range, "reinsertion option passes is " + std::to_string(options.passes) +
                                         ", valid are 0 to " + std::to_string(kMostReinsertionPasses)};
  if (!(options.least_gain >= 0 && options.least_gain <= 1))
    return {ErrorCode::out_of_range,
            "reinsertion option gain is " + std::to_string(options.least_gain) + ", valid are 0 to 1"};
  if (!(options.share > 0 && options.share <= 1))
    return {ErrorCode::out_of_range,
            "reinsertion option share is " + std::to_string(options.share) + ", valid are numbers above 0 up to 1"};
  return {};
}

}  // namespace

Result<tree::BinaryTree> reinsert(tree::BinaryTree&& tree, const ReinsertionOptions& options, Executor& executor,
                                  ReinsertionReport* report) try {
  if (auto status = check_options(options); !status) return status.error();
  ReinsertionReport own;
  ReinsertionReport& filled = report ? *report : own;
  filled = {};
  tree::BinaryTree taken = std::move(tree);
  if (taken.nodes.size() < 2) return taken;
  if (options.price) return optimize(std::move(taken), options, options.price, executor, filled);
  return optimize(std::move(taken), options, SurfaceArea(taken.bounds()), executor, filled);
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::out_of_memory, "not enough memory to optimize a binary tree"};
}

}  // namespace boxwood::optimizers
