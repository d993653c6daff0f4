// Trees for tests, made by hand.
#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "boxwood/tree.h"

namespace boxwood::testing {

/// Nodes in any order, as builders leave them, with the boxes of the primitives.
struct LooseTree {
  std::vector<tree::Node> nodes;  ///< [0] is the root
  std::vector<std::uint32_t> references;
  std::vector<Box> boxes;
};

/// A random binary tree over `leaves` leaves of 1 to 4 references. Node slots and references are scattered.
inline LooseTree random_tree(std::size_t leaves, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  // Shape first: split a random open leaf until there are enough.
  struct Shape {
    std::size_t left = 0, right = 0;
  };
  std::vector<Shape> shape(1);
  std::vector<std::size_t> open{0};
  while (open.size() < leaves) {
    const std::size_t pick = below(open.size());
    const std::size_t node = open[pick];
    shape[node] = {shape.size(), shape.size() + 1};
    open[pick] = shape.size();
    open.push_back(shape.size() + 1);
    shape.resize(shape.size() + 2);
  }
  // Pairs of siblings go into shuffled pairs of slots, twice as many as needed.
  std::vector<std::uint32_t> pairs(shape.size() + 2);
  std::iota(pairs.begin(), pairs.end(), 0);
  std::shuffle(pairs.begin(), pairs.end(), random);
  LooseTree tree;
  tree.nodes.resize(2 * pairs.size() + 1);
  for (tree::Node& unused : tree.nodes) unused = {Box{}, 0xdeadbeef, 0xdeadbeef};
  std::vector<std::uint32_t> slot(shape.size());
  std::size_t next_pair = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i].left == 0) continue;
    slot[shape[i].left] = 2 * pairs[next_pair] + 1;
    slot[shape[i].right] = 2 * pairs[next_pair++] + 2;
  }
  std::vector<std::uint32_t> ids;
  const auto coordinate = [&] { return static_cast<float>(below(1000)); };
  for (std::size_t i = shape.size(); i-- > 0;) {
    tree::Node& node = tree.nodes[slot[i]];
    if (shape[i].left != 0) {
      node = {merge(tree.nodes[slot[shape[i].left]].bounds, tree.nodes[slot[shape[i].right]].bounds),
              slot[shape[i].left], 0};
      continue;
    }
    node = {Box{}, static_cast<std::uint32_t>(tree.references.size()), static_cast<std::uint32_t>(1 + below(4))};
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const Vec3 lower{coordinate(), coordinate(), coordinate()};
      const Box box{lower, lower + Vec3{1, 2, 3}};
      node.bounds.grow(box);
      tree.references.push_back(static_cast<std::uint32_t>(tree.boxes.size()));
      tree.boxes.push_back(box);
    }
  }
  return tree;
}

/// Every inner node has one leaf of one reference, on the left when `leaf_first`; `levels` inner nodes.
inline LooseTree chain(std::size_t levels, bool leaf_first) {
  LooseTree tree;
  tree.nodes.resize(2 * levels + 1);
  const std::uint32_t leaf_offset = leaf_first ? 1 : 2, inner_offset = leaf_first ? 2 : 1;
  std::size_t node = 0;
  for (std::size_t i = 0; i <= levels; ++i) {
    const float x = static_cast<float>(i);
    tree.boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
    tree.references.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = 0; i < levels; ++i) {
    Box rest = tree.boxes[i];
    rest.grow(tree.boxes[levels]);
    const auto pair = static_cast<std::uint32_t>(2 * i);
    tree.nodes[node] = {rest, pair + 1, 0};
    tree.nodes[pair + leaf_offset] = {tree.boxes[i], static_cast<std::uint32_t>(i), 1};
    node = pair + inner_offset;
  }
  tree.nodes[node] = {tree.boxes[levels], static_cast<std::uint32_t>(levels), 1};
  return tree;
}

inline tree::BinaryTree canonical(const LooseTree& loose) {
  SequentialExecutor executor;
  return tree::canonicalize(loose.nodes, loose.references, loose.boxes.size(), false, executor);
}

inline tree::BinaryTree copy(const tree::BinaryTree& tree) {
  tree::BinaryTree result;
  result.nodes = tree.nodes.clone();
  result.references = tree.references.clone();
  result.primitive_count = tree.primitive_count;
  result.splits_references = tree.splits_references;
  return result;
}

}  // namespace boxwood::testing
