// Where a subtree is better off: the search of Bittner, Hapala and Havran 2013 (bib key bittner2013) in the form of
// Meister and Bittner 2018 (bib key meister2018), over a tree that does not change meanwhile.
//
// Taking node A out and putting it beside node C changes the sum of the prices of inner nodes: A's parent P goes, the
// nodes above P shrink, those on the way down to C grow, and a new parent of A and C comes. The search climbs from A to
// the root and looks, from each ancestor, down into its other child's subtree; what is gained so far, less the price of
// A itself, bounds what is possible below. The other child of the root is looked into as well.
#pragma once

#include <cstdint>
#include <vector>

#include "boxwood/tree.h"

namespace boxwood::optimizers {

/// A binary tree that can be rearranged: the root is nodes[0], nodes[1] is not used, and the children of a node stand
/// at an even place and the one after it, so that a pair is one cache line.
struct PairedTree {
  AlignedBuffer<tree::Node> nodes;
  std::vector<std::uint32_t> parents;  ///< by half the place of a node

  std::uint32_t parent(std::uint32_t node) const { return parents[node / 2]; }
  static std::uint32_t sibling(std::uint32_t node) { return node ^ 1; }
};

/// Where to put a node to advantage: beside `target`. No gain: nowhere.
struct Reinsertion {
  float gain = 0;
  std::uint32_t node = 0, target = 0;
};

/// `Price` is called as price(box) and says what an inner node with that box costs; a larger box must not cost less.
template <class Price>
class ReinsertionSearch {
 public:
  ReinsertionSearch(const PairedTree& tree, const Price& price) : tree_(tree), price_(price) {}

  /// The best place for a node other than the root and its children's own: ties go to the place found first.
  Reinsertion best_place(std::uint32_t node) {
    visits_left_ = kMostVisits;
    moved_ = tree_.nodes[node].bounds;
    own_price_ = price_(moved_);
    best_ = {0, node, 0};
    std::uint32_t pivot = tree_.parent(node);
    Box rest = tree_.nodes[PairedTree::sibling(node)].bounds;  // of the pivot without the node
    float gain = price_(tree_.nodes[pivot].bounds);
    look_into_children(PairedTree::sibling(node), gain);
    while (pivot != 0 && visits_left_ > 0) {
      --visits_left_;
      const std::uint32_t other = PairedTree::sibling(pivot);
      pivot = tree_.parent(pivot);
      consider(other, gain);
      look_into(other, gain);
      rest.grow(tree_.nodes[other].bounds);
      const Box& whole = tree_.nodes[pivot].bounds;
      const float whole_price = price_(whole);
      // Beside the pivot itself, one level or more up.
      keep(gain - price_(rest), pivot);
      if (rest == whole) {
        // Nothing above shrinks any more, so the gain can't rise.
        if (gain - own_price_ <= best_.gain) break;
      } else {
        gain += whole_price - price_(rest);
      }
    }
    return best_;
  }

 private:
  struct Waiting {
    std::uint32_t node;
    float gain;  ///< before the node has grown
  };

  void keep(float gain, std::uint32_t target) {
    if (gain > best_.gain) best_.gain = gain, best_.target = target;
  }

  Box grown(std::uint32_t node) const { return merge(tree_.nodes[node].bounds, moved_); }

  /// Beside `node`, when `gain` has been gained on the way there.
  void consider(std::uint32_t node, float gain) {
    if (gain - own_price_ > best_.gain) keep(gain - price_(grown(node)), node);
  }

  void look_into(std::uint32_t node, float gain) {
    if (gain - own_price_ > best_.gain) look_into_children(node, gain);
  }

  void look_into_children(std::uint32_t node, float gain) {
    stack_.clear();
    push(node, gain);
    while (!stack_.empty() && visits_left_ > 0) {
      --visits_left_;
      const Waiting waiting = stack_.back();
      stack_.pop_back();
      if (waiting.gain - own_price_ <= best_.gain) continue;
      const std::uint32_t left = tree_.nodes[waiting.node].first, right = left + 1;
      const float left_price = price_(grown(left)), right_price = price_(grown(right));
      keep(waiting.gain - left_price, left);
      keep(waiting.gain - right_price, right);
      // The one that grows less is looked into first.
      const float left_gain = waiting.gain - (left_price - price_(tree_.nodes[left].bounds));
      const float right_gain = waiting.gain - (right_price - price_(tree_.nodes[right].bounds));
      const bool left_first = left_gain >= right_gain;
      push_grown(left_first ? right : left, left_first ? right_gain : left_gain);
      push_grown(left_first ? left : right, left_first ? left_gain : right_gain);
    }
  }

  void push(std::uint32_t node, float gain) {
    if (tree_.nodes[node].is_leaf()) return;
    push_grown(node, gain - (price_(grown(node)) - price_(tree_.nodes[node].bounds)));
  }
  void push_grown(std::uint32_t node, float gain) {
    if (!tree_.nodes[node].is_leaf() && gain - own_price_ > best_.gain) stack_.push_back({node, gain});
  }

  /// A search ends here with what it has found. No tree that a builder makes comes near; one that is a chain does.
  static constexpr std::uint32_t kMostVisits = 1 << 12;

  const PairedTree& tree_;
  const Price& price_;
  Box moved_;
  float own_price_ = 0;
  Reinsertion best_;
  std::uint32_t visits_left_ = 0;
  std::vector<Waiting> stack_;
};

}  // namespace boxwood::optimizers
