// Clusters and their tree. In canonical order the inner node of rank k has its children at 2 * k + 1 and 2 * k + 2, and
// each cluster knows how many inner nodes and references its tree has: so the place of every subtree follows from the
// root down, and subtrees are written in parallel. Explicit stacks only: clusters may be as deep as they are large.
#include "builders/parts/merge_forest.h"

#include <vector>

namespace boxwood::builders {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 14;
constexpr std::uint32_t kTaskSize = 4096;

/// In double: areas of boxes of any float size neither overflow nor vanish.
double half_area(const Box& box) {
  const double x = double(box.upper.x) - box.lower.x;
  const double y = double(box.upper.y) - box.lower.y;
  const double z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

}  // namespace

MergeForest::MergeForest(std::span<const refs::Reference> references, std::span<const KeyedIndex> order,
                         const tree::CostModel& cost, std::uint32_t largest_leaf, Executor& executor)
    : reference_count_(std::uint32_t(references.size())),
      largest_leaf_(largest_leaf),
      traversal_(cost.traversal),
      intersection_(cost.intersection),
      clusters_(2 * references.size()),
      costs_(2 * references.size()),
      parts_(references.size()),
      primitives_(references.size()) {
  std::vector<Box> boxes((references.size() + kChunk - 1) / kChunk);
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const refs::Reference& reference = references[order.empty() ? i : order[i].index];
      clusters_[i] = {reference.box(), 1, 0};
      costs_[i] = intersection_ * half_area(reference.box());
      primitives_[i] = reference.primitive;
      boxes[chunk].grow(reference.box());
    }
  });
  for (const Box& box : boxes) bounds_.grow(box);
}

std::uint32_t MergeForest::merge(std::uint32_t merge, std::uint32_t left, std::uint32_t right) {
  const std::uint32_t made = reference_count_ + merge;
  const Cluster &a = clusters_[left], &b = clusters_[right];
  const Box box = boxwood::merge(a.box, b.box);
  const std::uint32_t count = a.count + b.count;
  const double area = half_area(box);
  const double as_leaf = intersection_ * count * area;
  const double as_inner = traversal_ * area + costs_[left] + costs_[right];
  const bool leaf = (largest_leaf_ == 0 || count <= largest_leaf_) && as_leaf <= as_inner;
  clusters_[made] = {box, count, leaf ? 0 : a.inner + b.inner + 1};
  costs_[made] = leaf ? as_leaf : as_inner;
  parts_[merge] = {left, right};
  return made;
}

MergeForest::Places MergeForest::below(const Place& place) const {
  const Parts parts = parts_[place.cluster - reference_count_];
  const Cluster& left = clusters_[parts.left];
  const std::uint32_t node = 2 * place.rank + 1;
  return {{parts.left, node, place.rank + 1, place.first},
          {parts.right, node + 1, place.rank + 1 + left.inner, place.first + left.count}};
}

void MergeForest::write_leaf(const Place& place, std::vector<std::uint32_t>& waiting, tree::BinaryTree& tree) const {
  const Cluster& cluster = clusters_[place.cluster];
  tree.nodes[place.node] = {cluster.box, place.first, cluster.count};
  std::uint32_t next = place.first;
  std::uint32_t current = place.cluster;
  while (true) {
    if (current >= reference_count_) {
      waiting.push_back(right(current));
      current = left(current);
      continue;
    }
    tree.references[next++] = primitives_[current];
    if (waiting.empty()) return;
    current = waiting.back();
    waiting.pop_back();
  }
}

void MergeForest::write_subtree(const Place& root, tree::BinaryTree& tree) const {
  std::vector<Place> waiting;
  std::vector<std::uint32_t> waiting_in_leaf;  // empty between leaves
  Place current = root;
  while (true) {
    if (clusters_[current.cluster].inner != 0) {
      tree.nodes[current.node] = {clusters_[current.cluster].box, 2 * current.rank + 1, 0};
      const Places parts = below(current);
      waiting.push_back(parts.right);
      current = parts.left;
      continue;
    }
    write_leaf(current, waiting_in_leaf, tree);
    if (waiting.empty()) return;
    current = waiting.back();
    waiting.pop_back();
  }
}

tree::BinaryTree MergeForest::tree(std::uint32_t root, std::size_t primitive_count, Executor& executor) const {
  tree::BinaryTree tree;
  tree.primitive_count = primitive_count;
  tree.nodes = AlignedBuffer<tree::Node>(2 * std::size_t(clusters_[root].inner) + 1);
  tree.references = AlignedBuffer<std::uint32_t>(reference_count_);
  std::vector<Place> tasks, open{{root, 0, 0, 0}};
  while (!open.empty()) {
    const Place place = open.back();
    open.pop_back();
    const Cluster& cluster = clusters_[place.cluster];
    if (cluster.inner == 0 || cluster.count <= kTaskSize) {
      tasks.push_back(place);
      continue;
    }
    tree.nodes[place.node] = {cluster.box, 2 * place.rank + 1, 0};
    const Places parts = below(place);
    open.push_back(parts.right);
    open.push_back(parts.left);
  }
  executor.for_chunks(tasks.size(), 1,
                      [&](std::size_t task, std::size_t, std::size_t) { write_subtree(tasks[task], tree); });
  return tree;
}

}  // namespace boxwood::builders
