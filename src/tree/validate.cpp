// The validator: walks a tree in canonical order, so the node that is met next tells what its numbers must be.
#include <algorithm>
#include <vector>

#include "boxwood/tree.h"

namespace boxwood::tree {
namespace {

std::string node_name(std::size_t node) {
  return "node " + std::to_string(node);
}

std::string leaf_name(std::size_t node) {
  return "leaf " + node_name(node);
}

Error malformed(std::string sentence) {
  return {ErrorCode::malformed, std::move(sentence)};
}

bool touches(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(a.lower[axis] <= b.upper[axis] && b.lower[axis] <= a.upper[axis])) return false;
  return true;
}

Box overlap(const Box& a, const Box& b) {
  return {maximum(a.lower, b.lower), minimum(a.upper, b.upper)};
}

/// A primitive in a leaf.
struct Piece {
  std::uint32_t primitive, leaf;
};

class Validator {
 public:
  Validator(const BinaryTree& tree, const Expectation& expectation) : tree_(tree), expectation_(expectation) {}

  Status run() {
    const std::size_t boxes = expectation_.primitive_boxes.size();
    if (boxes != tree_.primitive_count)
      return malformed("the tree is over " + std::to_string(tree_.primitive_count) + " primitives, not over the " +
                       std::to_string(boxes) + " expected");
    if (tree_.splits_references)
      pieces_.reserve(tree_.references.size());
    else
      seen_.resize(boxes);
    if (Status status = walk(); !status) return status;
    if (next_reference_ != tree_.references.size())
      return malformed("the leaves hold " + std::to_string(next_reference_) + " references, but the tree has " +
                       std::to_string(tree_.references.size()));
    return tree_.splits_references ? check_pieces() : check_all_seen();
  }

 private:
  Status walk() {
    std::vector<std::uint32_t> stack;
    if (!tree_.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const std::uint32_t index = stack.back();
      stack.pop_back();
      const Node& node = tree_.nodes[index];
      if (Status status = node.is_leaf() ? check_leaf(index, node) : check_inner(index, node); !status) return status;
      if (node.is_leaf()) continue;
      stack.push_back(node.first + 1);
      stack.push_back(node.first);
    }
    const std::size_t reached = tree_.empty() ? 0 : 2 * rank_ + 1;
    if (reached != tree_.nodes.size())
      return malformed("only " + std::to_string(reached) + " of " + std::to_string(tree_.nodes.size()) +
                       " nodes can be reached from the root");
    return {};
  }

  Status check_inner(std::uint32_t index, const Node& node) {
    const std::size_t first = 2 * rank_++ + 1;
    if (node.first != first)
      return malformed(node_name(index) + " has its children at " + std::to_string(node.first) +
                       ", but canonical numbering puts them at " + std::to_string(first));
    if (first + 1 >= tree_.nodes.size())
      return malformed(node_name(index) + " has its children at " + std::to_string(first) + ", past the last of " +
                       std::to_string(tree_.nodes.size()) + " nodes");
    const Box &left = tree_.nodes[first].bounds, &right = tree_.nodes[first + 1].bounds;
    for (const std::size_t child : {first, first + 1})
      if (!node.bounds.contains(tree_.nodes[child].bounds))
        return malformed(node_name(child) + " reaches out of the box of its parent, " + node_name(index));
    if (!(node.bounds == merge(left, right)))
      return malformed(node_name(index) + " has a larger box than its children together");
    return {};
  }

  Status check_leaf(std::uint32_t index, const Node& node) {
    if (node.first != next_reference_)
      return malformed(leaf_name(index) + " begins at reference " + std::to_string(node.first) +
                       ", but depth-first order puts it at " + std::to_string(next_reference_));
    if (node.count > tree_.references.size() - next_reference_)
      return malformed(leaf_name(index) + " ends past the last of " + std::to_string(tree_.references.size()) +
                       " references");
    if (expectation_.max_leaf != 0 && node.count > expectation_.max_leaf)
      return malformed(leaf_name(index) + " holds " + std::to_string(node.count) + " references, more than " +
                       std::to_string(expectation_.max_leaf));
    for (std::uint32_t i = 0; i < node.count; ++i)
      if (Status status = check_reference(index, node.bounds, tree_.references[node.first + i]); !status) return status;
    next_reference_ += node.count;
    return {};
  }

  Status check_reference(std::uint32_t leaf, const Box& bounds, std::uint32_t primitive) {
    const auto wrong = [&](const std::string& why) {
      return malformed(leaf_name(leaf) + " holds primitive " + std::to_string(primitive) + why);
    };
    if (primitive >= expectation_.primitive_boxes.size())
      return wrong(" of only " + std::to_string(expectation_.primitive_boxes.size()));
    const Box& box = expectation_.primitive_boxes[primitive];
    if (box.is_empty()) return wrong(", which must not be in the tree");
    if (tree_.splits_references) {
      if (!touches(bounds, box)) return wrong(", whose box does not touch the leaf's");
      pieces_.push_back({primitive, leaf});
      return {};
    }
    if (!bounds.contains(box)) return wrong(", whose box reaches out of the leaf's");
    if (seen_[primitive]) return wrong(", which an earlier leaf holds too");
    seen_[primitive] = true;
    return {};
  }

  Status missing(std::size_t primitive) const {
    return malformed("primitive " + std::to_string(primitive) + " is in no leaf");
  }

  Status check_all_seen() const {
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (!seen_[i] && !expectation_.primitive_boxes[i].is_empty()) return missing(i);
    return {};
  }

  /// Split references: the parts of a primitive's box that its leaves cover must leave no gap on any axis.
  Status check_pieces() {
    std::stable_sort(pieces_.begin(), pieces_.end(),
                     [](const Piece& a, const Piece& b) { return a.primitive < b.primitive; });
    std::size_t begin = 0;
    for (std::size_t primitive = 0; primitive < expectation_.primitive_boxes.size(); ++primitive) {
      std::size_t end = begin;
      while (end < pieces_.size() && pieces_[end].primitive == primitive) ++end;
      const Box& box = expectation_.primitive_boxes[primitive];
      if (begin == end && !box.is_empty()) return missing(primitive);
      for (int axis = 0; axis < 3 && begin != end; ++axis)
        if (!covers(std::span(pieces_).subspan(begin, end - begin), box, axis))
          return malformed("the leaves of primitive " + std::to_string(primitive) +
                           " together do not cover its box on axis " + "xyz"[axis]);
      begin = end;
    }
    return {};
  }

  bool covers(std::span<const Piece> pieces, const Box& box, int axis) const {
    std::vector<std::pair<float, float>> intervals;
    for (const Piece& piece : pieces) {
      const Box part = overlap(tree_.nodes[piece.leaf].bounds, box);
      intervals.emplace_back(part.lower[axis], part.upper[axis]);
    }
    std::sort(intervals.begin(), intervals.end());
    float reached = box.lower[axis];
    for (const auto& [lower, upper] : intervals) {
      if (lower > reached) return false;
      reached = maximum(reached, upper);
    }
    return reached >= box.upper[axis];
  }

  const BinaryTree& tree_;
  const Expectation& expectation_;
  std::size_t rank_ = 0;            ///< inner nodes met so far
  std::size_t next_reference_ = 0;  ///< references met so far
  std::vector<bool> seen_;
  std::vector<Piece> pieces_;
};

}  // namespace

Status validate(const BinaryTree& tree, const Expectation& expectation) {
  try {
    return Validator(tree, expectation).run();
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "out of memory while validating a tree of " + std::to_string(tree.nodes.size()) + " nodes"};
  }
}

}  // namespace boxwood::tree
