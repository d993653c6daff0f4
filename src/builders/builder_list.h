// The list of builders. Adding one takes a row here, a source file that defines `const BuilderInfo ROW_builder` (that
// file includes this header, which gives the definition its linkage) and a page in docs/builders.
#pragma once

#include "boxwood/builders.h"

// In the order they are listed to people. A row is the id with '_' for '-'.
#define BOXWOOD_BUILDER_LIST(row)                                                                              \
  row(binned_sah) row(sweep_sah) row(middle) row(equal_counts) row(area_median) row(lbvh) row(hlbvh) row(ploc) \
      row(aac) row(ebbvh) row(ebbvh_gated) row(spatial_split) row(sbvh) row(geometric) row(generic) row(kd)

namespace boxwood::builders {

#define BOXWOOD_DECLARE_BUILDER(name) extern const BuilderInfo name##_builder;
BOXWOOD_BUILDER_LIST(BOXWOOD_DECLARE_BUILDER)
#undef BOXWOOD_DECLARE_BUILDER

}  // namespace boxwood::builders
