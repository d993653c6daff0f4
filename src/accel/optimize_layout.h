// What Accel::optimize does to an encoded tree.
#pragma once

#include "boxwood/accel.h"

namespace boxwood {

struct OptimizedLayout {
  layouts::Layout layout;
  OptimizeReport report;
};

/// `accel` answers where rays end; `id` is the layout to make. May throw std::bad_alloc.
Result<OptimizedLayout> optimize_layout(const Accel& accel, const RaySample& sample, const OptimizeOptions& options,
                                        layouts::LayoutId id);

}  // namespace boxwood
