// The dynamic programme behind collapse_to_wide: for each subtree, the cheapest way to hand it to its parent as a
// forest of so many trees.
#pragma once

#include <cstdint>

#include "boxwood/optimizers.h"

namespace boxwood::optimizers {

inline constexpr int kLargestWidth = 16;

/// What the programme chose for one inner node of the binary tree, in 61 bits: the smallest forest for which it is
/// opened (0: never), whether it is a leaf when it is not opened, and for each size of forest from 3 on how many trees
/// its left child gives.
class Choice {
 public:
  void set_left_trees(int trees, int left) { bits_ |= std::uint64_t(left) << (4 * (trees - 3)); }
  /// The same for all forests from `first` trees (3 at least) on.
  void set_left_trees_from(int first, int left) {
    constexpr std::uint64_t all = 0x11111111111111;
    bits_ |= (all << (4 * (first - 3)) & all) * std::uint64_t(left);
  }
  void set_opened_from(int trees) { bits_ |= std::uint64_t(trees - 1) << 56; }
  void set_leaf() { bits_ |= std::uint64_t{1} << 60; }

  int left_trees(int trees) const { return trees == 2 ? 1 : int(bits_ >> (4 * (trees - 3)) & 15); }
  bool is_opened(int trees) const {
    const int from = int(bits_ >> 56 & 15);
    return from != 0 && trees > from;
  }
  bool is_leaf() const { return (bits_ >> 60 & 1) != 0; }

 private:
  std::uint64_t bits_ = 0;
};

/// Choices of all inner nodes, by half the index of their children (canonical trees keep children in pairs).
struct ForestCosts {
  AlignedBuffer<Choice> choices;
  AlignedBuffer<std::uint32_t> counts;  ///< references below the node
  double root_cost = 0;                 ///< of the whole tree as one wide node or leaf, in units of area

  static std::uint32_t pair_of(const tree::Node& node) { return (node.first - 1) / 2; }
};

/// References a wide leaf may hold.
inline std::uint32_t largest_leaf(const CollapseOptions& options) {
  return std::uint32_t(options.block) * std::uint32_t(options.max_leaf_blocks);
}

/// Runs the programme. Error: the tree is not in canonical form.
Result<ForestCosts> price_forests(const tree::BinaryTree& tree, const CollapseOptions& options, Executor& executor);

}  // namespace boxwood::optimizers
