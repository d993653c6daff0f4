// The rows of the registry of pre-splits; each stands in the file of its algorithm.
#pragma once

#include "boxwood/refs.h"

namespace boxwood::refs {

extern const PresplitInfo edge_volume_presplit, automatic_edge_volume_presplit, volume_clipping_presplit,
    early_split_clipping_presplit, priority_presplit;

}  // namespace boxwood::refs
