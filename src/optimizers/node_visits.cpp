// Visits of a binary tree's nodes by a sample of rays cut at their hits: what a traversal that goes to the nearest
// child first would visit. The surface area cost has no such cut; this is where early termination comes in (Gu 2015,
// bib key gu2015, guides a collapse by visits so measured; Bittner and Havran 2009, bib key bittner2009, the build).
// Ours blends measured shares with the areas' node by node. O(segments * visits), parallel; sums of whole numbers, so
// the same for every executor.
#include <atomic>
#include <new>
#include <string>

#include "boxwood/optimizers.h"
#include "optimizers/node_visits.h"

namespace boxwood::optimizers {

std::vector<Segment> make_segments(std::span<const Ray> rays) {
  std::vector<Segment> segments;
  segments.reserve(rays.size());
  for (const Ray& ray : rays) {
    const bool has_direction = is_finite(ray.direction) && ray.direction != Vec3{};
    if (has_direction && is_finite(ray.origin) && ray.tmin <= ray.tmax) segments.emplace_back(ray);
  }
  return segments;
}

std::vector<std::uint32_t> count_visits(const tree::BinaryTree& tree, std::span<const Segment> segments,
                                        Executor& executor) {
  std::vector<std::atomic<std::uint32_t>> counts(tree.nodes.size());
  executor.for_chunks(segments.size(), 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> stack;
    for (std::size_t s = begin; s < end; ++s) {
      if (!segments[s].meets(tree.nodes[0].bounds)) continue;
      stack.assign(1, 0);
      while (!stack.empty()) {
        const std::uint32_t n = stack.back();
        stack.pop_back();
        counts[n].fetch_add(1, std::memory_order_relaxed);
        if (tree.nodes[n].is_leaf()) continue;
        for (const std::uint32_t child : {tree.nodes[n].first, tree.nodes[n].first + 1})
          if (segments[s].meets(tree.nodes[child].bounds)) stack.push_back(child);
      }
    }
  });
  return {counts.begin(), counts.end()};
}

Result<std::vector<float>> node_visits(const tree::BinaryTree& tree, std::span<const Ray> segments, float prior,
                                       Executor& executor) try {
  if (tree.empty()) return std::vector<float>{};
  const auto counts = count_visits(tree, make_segments(segments), executor);
  std::vector<float> weights(tree.nodes.size());
  weights[0] = 1;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const tree::Node& node = tree.nodes[n];
    if (node.is_leaf()) continue;
    const VisitShare share(counts[n], node.bounds.half_area(), prior);
    for (const std::uint32_t child : {node.first, node.first + 1})
      weights[child] = weights[n] * minimum(1.0f, share(counts[child], tree.nodes[child].bounds.half_area()));
  }
  return weights;
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::out_of_memory,
               "not enough memory to count the visits of " + std::to_string(tree.nodes.size()) + " nodes"};
}

}  // namespace boxwood::optimizers
