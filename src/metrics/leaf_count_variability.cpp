// Leaf count variability (Aila, Karras and Laine 2013, bib key aila2013): the standard deviation over rays of the
// number of leaves whose boxes a ray meets. Ours differs: rays are whatever the caller gives, and hits end none, so
// that the number depends on the tree and the rays alone. Box tests in double precision. O(rays * nodes met); sums by
// chunks of rays, joined in order, so the bits do not depend on the threads.
#include <cmath>
#include <vector>

#include "boxwood/metrics.h"

namespace boxwood::metrics {
namespace {

constexpr std::size_t kRaysPerChunk = 1024;

bool meets(const Box& box, const Ray& ray) {
  double near = ray.tmin, far = ray.tmax;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis], direction = ray.direction[axis];
    if (direction == 0) {
      if (!(origin >= box.lower[axis] && origin <= box.upper[axis])) return false;
      continue;
    }
    const double a = (box.lower[axis] - origin) / direction, b = (box.upper[axis] - origin) / direction;
    near = std::fmax(near, std::fmin(a, b));
    far = std::fmin(far, std::fmax(a, b));
  }
  return near <= far;
}

std::size_t count_leaves(const tree::BinaryTree& tree, const Ray& ray, std::vector<std::uint32_t>& stack) {
  std::size_t leaves = 0;
  stack.assign(1, 0);
  while (!stack.empty()) {
    const tree::Node& node = tree.nodes[stack.back()];
    stack.pop_back();
    if (!meets(node.bounds, ray)) continue;
    leaves += node.is_leaf();
    if (!node.is_leaf()) stack.push_back(node.first), stack.push_back(node.first + 1);
  }
  return leaves;
}

}  // namespace

Estimate leaf_count_variability(const tree::BinaryTree& tree, std::span<const Ray> rays, Executor& executor) {
  if (tree.empty() || rays.empty()) return {};
  std::vector<std::uint32_t> leaves(rays.size());
  executor.for_chunks(rays.size(), kRaysPerChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> stack;
    for (std::size_t i = begin; i < end; ++i)
      leaves[i] = static_cast<std::uint32_t>(count_leaves(tree, rays[i], stack));
  });
  const double n = static_cast<double>(rays.size());
  double sum = 0, second = 0, fourth = 0;
  for (const std::uint32_t count : leaves) sum += count;
  for (const std::uint32_t count : leaves) {
    const double square = (count - sum / n) * (count - sum / n);
    second += square / n, fourth += square * square / n;
  }
  if (!(second > 0)) return {};
  // The variance of a sample's variance is (fourth moment - variance^2) / n; the root halves and divides by itself.
  const double error = std::sqrt(std::fmax(fourth - second * second, 0) / n) / (2 * std::sqrt(second));
  return {std::sqrt(second), error};
}

}  // namespace boxwood::metrics
