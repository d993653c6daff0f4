// What is seen where nothing is hit: a soft vertical gradient.
#pragma once

#include "render/camera.h"
#include "render/color.h"

namespace boxwood::render {

/// The same for all pixels of a row, from pale blue at the top to a warm white at the bottom.
Color backdrop(const Camera& camera, std::size_t pixel);

}  // namespace boxwood::render
