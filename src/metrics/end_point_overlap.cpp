// End-point overlap (Aila, Karras and Laine 2013, bib key aila2013): the area of the surface inside boxes it does not
// belong to, weighted by what visiting the box costs. Each triangle goes down the tree on its own: where its subtree
// has it, to the children its box meets; elsewhere it is clipped by the node's box, in double precision and anew from
// its corners, so nothing accumulates. A part without area has no descendants with area, so the walk ends there. The
// sum is exact, or taken over triangles sampled in proportion to their areas, with the standard error of that.
// O(references * depth + pairs of a triangle and a foreign box it reaches into); one number per triangle, added up in
// order, so the bits do not depend on the threads.
#include <algorithm>
#include <cmath>
#include <vector>

#include "boxwood/metrics.h"
#include "math/clip.h"
#include "metrics/box_measures.h"

namespace boxwood::metrics {
namespace {

constexpr std::size_t kTrianglesPerChunk = 256;

/// Which references belong to which node, and where each primitive is among them.
class Ownership {
 public:
  explicit Ownership(const tree::BinaryTree& tree)
      : ends_(tree.nodes.size()), begins_(tree.nodes.size()), first_place_(tree.primitive_count + 1) {
    // Children stand behind their parents, so backwards they come first.
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
      const tree::Node& node = tree.nodes[i];
      begins_[i] = node.is_leaf() ? node.first : begins_[node.first];
      ends_[i] = node.is_leaf() ? node.first + node.count : ends_[node.first + 1];
    }
    for (const std::uint32_t id : tree.references) ++first_place_[id + 1];
    for (std::size_t i = 1; i < first_place_.size(); ++i) first_place_[i] += first_place_[i - 1];
    places_.resize(tree.references.size());
    std::vector<std::uint32_t> next(first_place_.begin(), first_place_.end() - 1);
    for (std::uint32_t place = 0; place < tree.references.size(); ++place)
      places_[next[tree.references[place]]++] = place;
  }
  bool is_in_tree(std::uint32_t primitive) const { return first_place_[primitive] != first_place_[primitive + 1]; }
  bool has(std::uint32_t node, std::uint32_t primitive) const {
    const auto begin = places_.begin() + first_place_[primitive], end = places_.begin() + first_place_[primitive + 1];
    const auto place = std::lower_bound(begin, end, begins_[node]);
    return place != end && *place < ends_[node];
  }

 private:
  std::vector<std::uint32_t> ends_, begins_, first_place_, places_;
};

/// The sum over nodes of cost * area of the triangle's part inside boxes of nodes that do not have it.
class TriangleWalk {
 public:
  TriangleWalk(const tree::BinaryTree& tree, const Ownership& ownership, const tree::CostModel& cost)
      : tree_(tree), ownership_(ownership), cost_(cost) {}

  double run(std::uint32_t primitive, const Triangle& triangle, double area) {
    const Box bounds = triangle.bounds();
    const ConvexPolygon whole(triangle);
    double sum = 0;
    stack_.assign(1, {0, true});
    while (!stack_.empty()) {
      Entry entry = stack_.back();
      stack_.pop_back();
      const tree::Node& node = tree_.nodes[entry.node];
      if (intersection(node.bounds, bounds).is_empty()) continue;
      entry.may_have = entry.may_have && ownership_.has(entry.node, primitive);
      if (!entry.may_have) {
        const double inside = node.bounds.contains(bounds) ? area : area_inside(whole, node.bounds);
        if (!(inside > 0)) continue;
        sum += visit_cost(node, cost_) * inside;
      }
      if (!node.is_leaf())
        for (const std::uint32_t child : {node.first, node.first + 1}) stack_.push_back({child, entry.may_have});
    }
    return sum;
  }

 private:
  struct Entry {
    std::uint32_t node;
    bool may_have;  // false: an ancestor has not got the triangle, so neither has this one
  };
  static double area_inside(ConvexPolygon polygon, const Box& box) {
    polygon.clip(box);
    return polygon.area();
  }

  const tree::BinaryTree& tree_;
  const Ownership& ownership_;
  const tree::CostModel& cost_;
  std::vector<Entry> stack_;
};

/// A number in (0, 1) for each index: the finalizer of SplitMix64 (Steele, Lea and Flood 2014).
double random_share(std::uint64_t index) {
  std::uint64_t x = (index + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  x ^= x >> 31;
  return (static_cast<double>(x >> 12) + 0.5) * 0x1p-52;
}

/// Indices into `up_to`, areas summed up: one at a random place of each of `samples` equal parts of the whole area.
std::vector<std::uint32_t> sample_by_area(const std::vector<double>& up_to, std::size_t samples) {
  std::vector<std::uint32_t> chosen(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double place = (static_cast<double>(i) + random_share(i)) / static_cast<double>(samples) * up_to.back();
    const auto found = std::upper_bound(up_to.begin(), up_to.end(), place);
    chosen[i] = static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(found - up_to.begin(), std::ssize(up_to) - 1));
  }
  return chosen;
}

}  // namespace

Estimate end_point_overlap(const tree::BinaryTree& tree, const MeshView& mesh, const tree::CostModel& cost,
                           std::size_t samples, Executor& executor) {
  if (tree.empty()) return {};
  const Ownership ownership(tree);
  const auto area_of = [&](std::uint32_t id) {
    return ownership.is_in_tree(id) ? ConvexPolygon(mesh.triangle(id)).area() : 0.0;
  };
  // Of each chosen triangle the overlap over its own area.
  std::vector<double> up_to(tree.primitive_count);
  double total = 0;
  for (std::uint32_t id = 0; id < tree.primitive_count; ++id) up_to[id] = total += area_of(id);
  if (!(total > 0)) return {};
  std::vector<std::uint32_t> chosen;
  if (samples) chosen = sample_by_area(up_to, samples);
  const std::size_t count = samples ? samples : tree.primitive_count;
  std::vector<double> ratios(count);
  executor.for_chunks(count, kTrianglesPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    TriangleWalk walk(tree, ownership, cost);
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t id = samples ? chosen[i] : static_cast<std::uint32_t>(i);
      const double area = area_of(id);
      ratios[i] = area > 0 ? walk.run(id, mesh.triangle(id), area) / area : 0;
    }
  });
  double sum = 0, squares = 0;
  if (!samples) {
    for (std::uint32_t id = 0; id < count; ++id) sum += ratios[id] * (area_of(id) / total);
    return {sum, 0};
  }
  const double n = static_cast<double>(samples);
  for (const double ratio : ratios) sum += ratio / n;
  for (const double ratio : ratios) squares += (ratio - sum) * (ratio - sum);
  return {sum, samples > 1 ? std::sqrt(squares / (n - 1) / n) : sum};
}

}  // namespace boxwood::metrics
