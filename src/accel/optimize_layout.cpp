// A tree rebuilt for the rays that are traced through it. The encoded tree is decoded, made binary again, its treelets
// rebuilt and collapsed with measured visits in place of areas (optimizers/restructure.cpp, node_visits.cpp), and
// encoded; then the children of each node are put in the order that is best for any-hit queries (likely to succeed and
// cheap to search first: Ogaki and Derouet-Jourdan 2016, bib key ogaki2016) and the nodes in the order in which they
// are visited. A quarter of the sample is held out: on it the work before and after is compared, and a tree that is no
// better is not taken. Deterministic: every decision is made from whole numbers counted by scalar code.
#include "accel/optimize_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "accel/encode_tree.h"
#include "boxwood/optimizers.h"
#include "math/clip.h"

namespace boxwood {
namespace {

/// Of so many rays one is held out.
constexpr std::size_t kHeldOutEvery = 4;

/// Rays of one half of the sample, ready for counting.
struct Rays {
  std::vector<Ray> cut;  ///< closest and any hit, cut at their closest hits
  std::vector<Ray> any;  ///< any hit, as they are
  std::size_t closest_count = 0;

  std::span<const Ray> cut_closest() const { return std::span(cut).first(closest_count); }
  std::size_t size() const { return cut.size(); }
};

/// Evenly spaced rays of the sample, at most `most`, into the two halves.
Status add_rays(const Accel& accel, std::span<const Ray> rays, bool any, std::size_t most, Rays& trained,
                Rays& tested) {
  const std::size_t count = std::min(rays.size(), most);
  std::vector<Ray> chosen(count);
  for (std::size_t i = 0; i < count; ++i)
    chosen[i] = rays[std::size_t(double(i) * double(rays.size()) / double(count))];
  std::vector<Hit> hits(count);
  if (auto status = accel.closest_hits(chosen, hits); !status) return status;
  for (std::size_t i = 0; i < count; ++i) {
    Rays& half = i % kHeldOutEvery == kHeldOutEvery - 1 ? tested : trained;
    if (any) half.any.push_back(chosen[i]);
    half.cut.push_back(chosen[i]);
    if (hits[i]) half.cut.back().tmax = hits[i].t;
  }
  if (!any) trained.closest_count = trained.cut.size(), tested.closest_count = tested.cut.size();
  return {};
}

/// Boxes of references: of the triangle, or of its part inside the leaf where it reaches out.
std::vector<Box> reference_boxes(const layouts::Decoded& decoded, Executor& executor) {
  const tree::WideTree& tree = decoded.tree;
  std::vector<Box> boxes(tree.references.size());
  executor.for_chunks(tree.children.size(), 1024, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const auto& leaf = tree.children[c];
      for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const Triangle& triangle = decoded.triangles[tree.references[i]];
        boxes[i] = triangle.bounds();
        if (leaf.bounds.contains(boxes[i])) continue;
        ConvexPolygon part(triangle);
        part.clip(leaf.bounds);
        boxes[i] = intersection(part.bounds(), leaf.bounds);
        if (boxes[i].is_empty()) boxes[i] = leaf.bounds;  // it only touches the leaf's box
      }
    }
  });
  return boxes;
}

template <int W>
constexpr std::size_t kNodeFloats = sizeof(layouts::WideNode<W>) / sizeof(float);
std::size_t node_floats(int width) {
  return width == 4 ? kNodeFloats<4> : width == 8 ? kNodeFloats<8> : kNodeFloats<16>;
}

bool is_used(const layouts::Layout& layout, int width, std::size_t node, std::size_t lane) {
  const std::size_t floats = node_floats(width);
  const auto* planes = reinterpret_cast<const float*>(layout.nodes.data()) + node * floats;
  return planes[lane] <= planes[std::size_t(width) + lane];
}
std::uint32_t child_word(const layouts::Layout& layout, int width, std::size_t node, std::size_t lane) {
  const auto* planes = reinterpret_cast<const std::uint32_t*>(layout.nodes.data()) + node * node_floats(width);
  return planes[6 * std::size_t(width) + lane];
}

/// Children by successes / cost, descending. What was seen of a child counts beside a few rays that do as the average
/// child does, a little better the earlier it stands now. Nodes that no ray has come to stay as they are.
std::vector<std::uint8_t> order_children(const layouts::Layout& layout, const queries::VisitCounts& seen) {
  const auto width = std::size_t(seen.width);
  double successes = 0, cost = 0, met = 0;
  for (const auto& child : seen.children) successes += child.successes, cost += double(child.cost), met += child.met;
  constexpr double kPriorRays = 2;
  const double average_success = kPriorRays * successes / std::max(met, 1.0);
  const double average_cost = kPriorRays * cost / std::max(met, 1.0);
  std::vector<std::uint8_t> lanes(layout.node_count * width);
  std::vector<std::pair<double, std::uint8_t>> order;
  for (std::size_t n = 0; n < layout.node_count; ++n) {
    const auto children = std::span(seen.children).subspan(n * width, width);
    const auto out = std::span(lanes).subspan(n * width, width);
    std::iota(out.begin(), out.end(), std::uint8_t{0});
    if (std::all_of(children.begin(), children.end(), [](const auto& c) { return c.met == 0; })) continue;
    order.clear();
    for (std::size_t i = 0; i < width && is_used(layout, seen.width, n, i); ++i) {
      const double place = 1.5 - double(i) / double(width);
      order.push_back({(children[i].successes + average_success * place) / (double(children[i].cost) + average_cost),
                       std::uint8_t(i)});
    }
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; i < order.size(); ++i) out[i] = order[i].second;
  }
  return lanes;
}

/// Depth first, the most visited child first; nodes that no ray has come to stand behind all others.
std::vector<std::uint32_t> order_nodes(const layouts::Layout& layout, const queries::VisitCounts& seen) {
  std::vector<std::uint32_t> order, stack{0};
  std::vector<std::uint8_t> placed(layout.node_count);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> children;  // visits, node
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    order.push_back(node);
    placed[node] = 1;
    children.clear();
    for (std::size_t i = 0; i < std::size_t(seen.width) && is_used(layout, seen.width, node, i); ++i) {
      const std::uint32_t word = child_word(layout, seen.width, node, i);
      const std::uint32_t met = seen.children[node * std::size_t(seen.width) + i].met;
      if (!(word & layouts::kLeafBit) && met > 0) children.push_back({met, word});
    }
    std::sort(children.begin(), children.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    });
    for (const auto& child : children) stack.push_back(child.second);
  }
  for (std::uint32_t n = 0; n < layout.node_count; ++n)
    if (!placed[n]) order.push_back(n);
  return order;
}

Result<layouts::Layout> arrange(layouts::Layout&& layout, const Rays& rays, Executor& executor) {
  if (layout.node_count == 0 || layout.id == layouts::LayoutId::linear) return std::move(layout);
  const auto visits = queries::count_visits(layout, rays.cut, executor);
  if (!visits) return visits.error();
  const auto any = queries::count_visits(layout, rays.any, executor);
  if (!any) return any.error();
  return layouts::arrange(layout, {order_nodes(layout, *visits), order_children(layout, *any)});
}

/// Price per ray, in block tests.
Result<double> work_of(const layouts::Layout& layout, const Rays& rays, Executor& executor) {
  const auto closest = queries::count_visits(layout, rays.cut_closest(), executor);
  if (!closest) return closest.error();
  const auto any = queries::count_visits(layout, rays.any, executor);
  if (!any) return any.error();
  const double count = std::max(1.0, double(rays.size()));
  return double(closest->total_cost + any->any_hit_cost) / double(queries::kBlockPrice) / count;
}

Status check(const RaySample& sample, const OptimizeOptions& options) {
  if (sample.closest_hit.empty() && sample.any_hit.empty())
    return {ErrorCode::invalid_argument, "there are no sample rays to optimize for"};
  if (options.passes < 0 || options.passes > 100)
    return {ErrorCode::out_of_range,
            "the number of passes is " + std::to_string(options.passes) + ", valid are 0 to 100"};
  if (!(options.prior > 0) || options.prior > 1e6f)
    return {ErrorCode::out_of_range,
            "the number of prior rays is " + std::to_string(options.prior) + ", valid are above 0 to 1e6"};
  if (options.most_rays < kHeldOutEvery)
    return {ErrorCode::out_of_range, "at most " + std::to_string(options.most_rays) +
                                         " rays are to be looked at; it takes at least " +
                                         std::to_string(kHeldOutEvery)};
  return {};
}

layouts::Layout copy(const layouts::Layout& from) {
  layouts::Layout to;
  to.id = from.id, to.root = from.root, to.bounds = from.bounds, to.max_stack = from.max_stack;
  to.node_count = from.node_count, to.leaf_count = from.leaf_count, to.reference_count = from.reference_count;
  to.nodes = from.nodes.clone(), to.triangles = from.triangles.clone();
  return to;
}

}  // namespace

Result<OptimizedLayout> optimize_layout(const Accel& accel, const RaySample& sample, const OptimizeOptions& options,
                                        layouts::LayoutId id) {
  if (auto status = check(sample, options); !status) return status.error();
  Executor& executor = accel.executor();
  const layouts::Layout& before = accel.layout();
  Rays trained, tested;
  if (auto s = add_rays(accel, sample.closest_hit, false, options.most_rays, trained, tested); !s) return s.error();
  if (auto s = add_rays(accel, sample.any_hit, true, options.most_rays, trained, tested); !s) return s.error();
  OptimizeReport report;
  report.trained_rays = trained.size();
  report.tested_rays = tested.size();

  const auto decoded = layouts::decode(before);
  if (!decoded) return decoded.error();
  const auto boxes = reference_boxes(*decoded, executor);
  // The layout linear has no collapse that would decide on leaves, so there they stay.
  auto tree = optimizers::expand_to_binary(decoded->tree, boxes, decoded->triangles.size(), true, executor,
                                           id != layouts::LayoutId::linear);
  if (!tree) return tree.error();
  tree = optimizers::restructure(*tree, trained.cut, {options.passes, options.prior}, executor);
  if (!tree) return tree.error();
  const auto weights = optimizers::node_visits(*tree, trained.cut, options.prior, executor);
  if (!weights) return weights.error();
  optimizers::CollapseOptions collapse;
  collapse.node_cost = options.node_cost == 0 ? layouts::node_cost(id) : options.node_cost;
  collapse.max_leaf_blocks = options.max_leaf_blocks;
  collapse.node_weights = *weights;
  auto after = encode_tree(id, *tree, decoded->mesh(), std::move(collapse), executor);
  if (!after) return after.error();
  after = arrange(std::move(*after), trained, executor);
  if (!after) return after.error();

  // Visits of the layout linear are not counted.
  if (before.id == layouts::LayoutId::linear || id == layouts::LayoutId::linear)
    return OptimizedLayout{std::move(*after), report};
  const auto before_work = work_of(before, tested, executor), after_work = work_of(*after, tested, executor);
  if (!before_work) return before_work.error();
  if (!after_work) return after_work.error();
  report.work_before = *before_work;
  report.work_after = *after_work;
  // With another width the work is not comparable; the layout was asked for.
  report.improved = id != before.id || (tested.size() > 0 && report.work_after < report.work_before);
  if (report.improved) return OptimizedLayout{std::move(*after), report};
  report.work_after = report.work_before;
  return OptimizedLayout{copy(before), report};
}

}  // namespace boxwood
