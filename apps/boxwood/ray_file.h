// Rays from a NumPy file, as boxwood trace and boxwood tune take them.
#pragma once

#include <string>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/math.h"

namespace boxwood::program {

/// What io::read_rays reads, refusing rays that can't hit anything by the number of their row: an origin or direction
/// that is not finite, a zero direction, limits in the wrong order.
Result<std::vector<Ray>> read_ray_file(const std::string& path);

}  // namespace boxwood::program
