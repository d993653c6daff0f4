// What a set of references would cost as a tree of spatial medians: the recursive cost of Popov et al. 2009 (bib key
// popov2009, section 3.4).
#pragma once

#include <vector>

#include "boxwood/refs.h"
#include "boxwood/tree.h"

namespace boxwood::builders {

/// Exp(T) of eq. (1) times the (scaled, half) area of the references' box: C_T * area over the inner nodes plus C_I *
/// area * count over the leaves, of a tree that halves the box of the centroids on its widest axis (pbrt's "Middle")
/// until a leaf is cheaper than such a split. O(n log n); reorders the references.
double median_tree_price(std::vector<refs::Reference>& references, const tree::CostModel& cost, float area_scale);

}  // namespace boxwood::builders
