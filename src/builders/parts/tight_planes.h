// Planes at the sides of references, as a KD tree would choose among them (Wald and Havran 2006, bib key wald2006),
// with bounds of what they cost when the boxes on both sides are tight.
#pragma once

#include <span>
#include <vector>

#include "boxwood/refs.h"
#include "builders/parts/configuration_search.h"

namespace boxwood::builders {

/// A plane with bounds of its cost: area * count of both sides, added.
struct TightPlane {
  int axis = 0;
  float position = 0;
  double least = 0;     ///< not above the cost: only on the plane's axis is the extent of split references known
  double estimate = 0;  ///< the cost when split references fill their boxes
};

struct TightPlanes {
  std::vector<TightPlane> planes;
  /// The least of those left out because they add too many references.
  double refused = std::numeric_limits<double>::infinity();
};

/// The planes of all axes at lower and upper sides of references, strictly inside the node, that part the references
/// and whose `least` is below `limit`, by rising estimate (ties: by axis, then by position). Those that split more than
/// `price.spare` references are refused. O(n log n).
TightPlanes tight_planes(std::span<const refs::Reference> references, const Box& node, const ConfigurationPrice& price,
                         double limit, Executor& executor);

}  // namespace boxwood::builders
