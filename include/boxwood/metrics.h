// Measures of a tree that need no layout and trace nothing.
#pragma once

#include <cstddef>
#include <span>

#include "boxwood/math.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"
#include "boxwood/tree.h"

namespace boxwood::metrics {

/// Exp(T): the expected cost of a ray that meets the root's box and never ends (MacDonald and Booth 1990; Goldsmith and
/// Salmon 1987): the sum over inner nodes of area(node) / area(root) * traversal plus the sum over leaves of
/// area(leaf) / area(root) * references * intersection, in double precision. A root without area counts its own nodes
/// as if all areas were equal. Zero for an empty tree.
double surface_area_cost(const tree::BinaryTree& tree, const tree::CostModel& cost = {});

/// A number and how far off it may be: one standard error of the sampling, zero where nothing was sampled.
struct Estimate {
  double value = 0, error = 0;
};

/// End-point overlap, EPO (Aila, Karras and Laine 2013): the sum over nodes of cost(node) * area of the surface that
/// lies inside the node's box and belongs to none of its primitives, over the area of the whole surface; cost(node) is
/// as in surface_area_cost. What rays pay that end on a surface, for boxes that reach over it. Boxes are closed: a
/// triangle that lies in a side counts as inside. `samples` = 0 clips every triangle against every such box and is
/// exact (up to double precision); its time grows with the overlap itself, at worst with triangles times nodes. Else
/// it takes that many triangles at random, in proportion to their areas, the same ones in every run. Zero for an empty
/// tree or a surface without area. `mesh` is the one the tree was built over. The same bits for every number of
/// threads.
Estimate end_point_overlap(const tree::BinaryTree& tree, const MeshView& mesh, const tree::CostModel& cost,
                           std::size_t samples, Executor& executor);

/// Leaf count variability, LCV (Aila, Karras and Laine 2013): the standard deviation of how many leaves' boxes a ray
/// meets, over the given rays (taken without hits: each goes from tmin to tmax). What makes the lanes of a SIMD group
/// wait for each other. The error is that of the rays being a sample. The same bits for every number of threads.
Estimate leaf_count_variability(const tree::BinaryTree& tree, std::span<const Ray> rays, Executor& executor);

/// How much sibling boxes overlap: means over inner nodes, weighted by the nodes' areas.
struct SiblingOverlap {
  double area = 0;    ///< area of the intersection of the children's boxes over the area of the node's box
  double volume = 0;  ///< the same with volumes, the overlap that POPOV's builders penalise (zero in a flat node)
};
SiblingOverlap sibling_overlap(const tree::BinaryTree& tree);

/// References over primitives that are in the tree: 1 where none is split. Zero for an empty tree.
double references_per_primitive(const tree::BinaryTree& tree);

}  // namespace boxwood::metrics
