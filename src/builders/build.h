// What the entry of all builds checks first.
#pragma once

#include "boxwood/builders.h"

namespace boxwood::builders {

/// Refuses sets that are larger than the builder takes or than 32-bit numbers can count.
Status check_size(const BuilderInfo& info, const refs::ReferenceSet& set);

}  // namespace boxwood::builders
