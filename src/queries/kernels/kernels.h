// The kernels of each layout, by Highway target bit.
#pragma once

#include "base/simd_dispatch.h"
#include "boxwood/queries.h"

namespace boxwood::queries {

Kernels linear_kernels(Mode mode);
Kernels wide4_kernels(Mode mode, std::int64_t target);
Kernels wide8_kernels(Mode mode, std::int64_t target);
Kernels wide8_quads_kernels(Mode mode, std::int64_t target);
Kernels wide16_kernels(Mode mode, std::int64_t target);

/// The other ways through the linear layout. Single rays that hits do not end, and packets.
TraversalKernels unending_kernels(Mode mode);
TraversalKernels packet4_kernels(Mode mode);
TraversalKernels range_kernels(Mode mode);
TraversalKernels partition_kernels(Mode mode);

}  // namespace boxwood::queries
