#include "render/backdrop.h"

namespace boxwood::render {

Color backdrop(const Camera& camera, std::size_t pixel) {
  static const Color top = from_oklch(0.80, 0.035, 250), bottom = from_oklch(0.97, 0.008, 90);
  const std::size_t row = pixel / static_cast<std::size_t>(camera.width());
  const float share = (static_cast<float>(row) + 0.5f) / static_cast<float>(camera.height());
  return mix(top, bottom, share);
}

}  // namespace boxwood::render
