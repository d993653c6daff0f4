// The centroid sweep over a plain array, for builders whose references come and go: the splits of sweep.h, at n log n a
// node, with the overlap of the two sides in the price.
#pragma once

#include <span>

#include "builders/parts/configuration_search.h"

namespace boxwood::builders {

/// Left are the references before this one in the order by doubled centroid, primitive, place in the array.
struct CentroidSplit {
  int axis = -1;  ///< -1: none
  float centroid2 = 0;
  std::uint32_t primitive = 0, place = 0;
  double cost = std::numeric_limits<double>::infinity();

  bool goes_left(const refs::Reference& reference, std::uint32_t at) const {
    const float here = reference.centroid2(axis);
    if (here != centroid2) return here < centroid2;
    return reference.primitive != primitive ? reference.primitive < primitive : at < place;
  }
};

/// The cheapest of all splits between two neighbours on an axis on which centroids differ. Ties: the lowest axis, then
/// the leftmost.
CentroidSplit sweep_centroids(std::span<const refs::Reference> references, const Box& node,
                              const ConfigurationPrice& price, Executor& executor);

}  // namespace boxwood::builders
