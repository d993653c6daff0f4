// What all bottom-up builders make: clusters, from single references up, and the tree read off them at the end. A
// cluster knows its box, its references and the price of the best tree over it, so that leaves are decided while
// clusters merge. Numbers of merges are given out by the builder; nothing here depends on the order of the threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "boxwood/refs.h"
#include "boxwood/tree.h"
#include "parallel/radix_sort.h"

namespace boxwood::builders {

class MergeForest {
 public:
  /// Clusters 0 to n - 1: the references as they stand, or in the given order. `largest_leaf` = 0: no limit.
  MergeForest(std::span<const refs::Reference> references, std::span<const KeyedIndex> order,
              const tree::CostModel& cost, std::uint32_t largest_leaf, Executor& executor);

  std::uint32_t reference_count() const { return reference_count_; }
  /// Of all references.
  const Box& bounds() const { return bounds_; }
  const Box& box(std::uint32_t cluster) const { return clusters_[cluster].box; }
  /// References in the cluster.
  std::uint32_t count(std::uint32_t cluster) const { return clusters_[cluster].count; }
  /// Left and right part of a cluster that is not a single reference.
  std::uint32_t left(std::uint32_t cluster) const { return parts_[cluster - reference_count_].left; }
  std::uint32_t right(std::uint32_t cluster) const { return parts_[cluster - reference_count_].right; }

  /// Makes cluster n + merge of two clusters and returns that number; 0 <= merge < n, each used once at most. Safe from
  /// several threads for different clusters. The cluster becomes a leaf where that is no dearer than its best subtree
  /// by the surface area heuristic.
  std::uint32_t merge(std::uint32_t merge, std::uint32_t left, std::uint32_t right);

  /// The tree below a cluster that holds all references, in canonical form. Parallel, any depth, O(n).
  tree::BinaryTree tree(std::uint32_t root, std::size_t primitive_count, Executor& executor) const;

 private:
  struct Cluster {
    Box box;
    std::uint32_t count;
    std::uint32_t inner;  ///< inner nodes of its tree; 0: a leaf
  };
  struct Parts {
    std::uint32_t left, right;
  };
  /// Where a cluster's tree goes: its node, the rank of that among inner nodes, its first reference.
  struct Place {
    std::uint32_t cluster, node, rank, first;
  };
  struct Places {
    Place left, right;
  };

  Places below(const Place& place) const;
  void write_leaf(const Place& place, std::vector<std::uint32_t>& waiting, tree::BinaryTree& tree) const;
  void write_subtree(const Place& root, tree::BinaryTree& tree) const;

  std::uint32_t reference_count_;
  std::uint32_t largest_leaf_;
  double traversal_, intersection_;
  Box bounds_;
  AlignedBuffer<Cluster> clusters_;
  AlignedBuffer<double> costs_;
  AlignedBuffer<Parts> parts_;
  AlignedBuffer<std::uint32_t> primitives_;
};

}  // namespace boxwood::builders
