// Binary trees made by hand, in canonical form, for tests of the optimizers.
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "boxwood/tree.h"

namespace boxwood::test {

/// A node of a tree under construction. Leaves: count > 0 and a box of their own.
struct ShapeNode {
  Box bounds;
  std::uint32_t count = 0;
  std::size_t left = 0, right = 0;
};

/// Numbers the nodes canonically, gives inner nodes the box of their children and references the ids 0, 1, 2, ...
inline tree::BinaryTree canonical_tree(const std::vector<ShapeNode>& shape, std::size_t root) {
  std::vector<tree::Node> nodes(1);
  std::uint32_t references = 0;
  std::vector<std::pair<std::size_t, std::size_t>> open{{root, 0}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    const ShapeNode& node = shape[from];
    if (node.count > 0) {
      nodes[to] = {node.bounds, references, node.count};
      references += node.count;
      continue;
    }
    nodes[to].first = std::uint32_t(nodes.size());
    open.push_back({node.right, nodes.size() + 1});
    open.push_back({node.left, nodes.size()});
    nodes.resize(nodes.size() + 2);
  }
  for (std::size_t n = nodes.size(); n-- > 0;)
    if (!nodes[n].is_leaf()) nodes[n].bounds = merge(nodes[nodes[n].first].bounds, nodes[nodes[n].first + 1].bounds);

  tree::BinaryTree tree;
  tree.nodes = AlignedBuffer<tree::Node>(nodes.size());
  std::copy(nodes.begin(), nodes.end(), tree.nodes.begin());
  tree.references = AlignedBuffer<std::uint32_t>(references);
  for (std::uint32_t r = 0; r < references; ++r) tree.references[r] = r;
  tree.primitive_count = references;
  return tree;
}

inline Box random_box(std::mt19937& random, float size) {
  std::uniform_real_distribution<float> position(0, 10), extent(0, size);
  const Vec3 lower{position(random), position(random), position(random)};
  return {lower, lower + Vec3{extent(random), extent(random), extent(random)}};
}

/// Joins random pairs of random leaves until one tree is left.
inline tree::BinaryTree random_tree(std::uint32_t seed, std::size_t leaves, std::uint32_t largest_leaf,
                                    float size = 3) {
  std::mt19937 random(seed);
  std::vector<ShapeNode> shape;
  std::vector<std::size_t> roots;
  for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
    shape.push_back({random_box(random, size), 1 + std::uint32_t(random() % largest_leaf)});
    roots.push_back(leaf);
  }
  while (roots.size() > 1) {
    const std::size_t a = random() % roots.size();
    std::swap(roots[a], roots.back());
    const std::size_t right = roots.back();
    roots.pop_back();
    const std::size_t b = random() % roots.size();
    shape.push_back({Box{}, 0, roots[b], right});
    roots[b] = shape.size() - 1;
  }
  return canonical_tree(shape, roots[0]);
}

/// A chain: each inner node has a leaf of one reference on one side and the rest of the tree on the other. Boxes shrink
/// by a factor so near to one that none of them vanishes. `side`: 0 leaves left, 1 leaves right, 2 in turns.
inline tree::BinaryTree chain_tree(std::size_t levels, int side) {
  std::vector<ShapeNode> shape;
  const auto box = [&](std::size_t level) {
    const float size = 1 + float(levels - level);
    return Box{{0, 0, 0}, {size, size, 1}};
  };
  shape.push_back({box(levels), 1});
  std::size_t rest = 0;
  for (std::size_t level = levels; level-- > 0;) {
    shape.push_back({box(level), 1});
    const std::size_t leaf = shape.size() - 1;
    const bool leaf_left = side == 0 || (side == 2 && level % 2 == 0);
    shape.push_back({Box{}, 0, leaf_left ? leaf : rest, leaf_left ? rest : leaf});
    rest = shape.size() - 1;
  }
  return canonical_tree(shape, rest);
}

}  // namespace boxwood::test
