// The colour scale of a heat map: which numbers the colours stand for, and the panel that says so in the picture.
#pragma once

#include <cstdint>
#include <string_view>

#include "boxwood/base.h"
#include "render/value_plane.h"

namespace boxwood::render {

struct ColorScale {
  std::uint32_t upper = 1;  ///< the number of the lightest colour, a multiple of `step`; the darkest is zero
  std::uint32_t step = 1;   ///< between two labels: 1, 2 or 5 times a power of ten

  /// At most five steps that reach `value`.
  static ColorScale up_to(std::uint32_t value);
};

/// Draws a panel with the caption, the colours with their numbers, and the mean and the largest value into the lower
/// left corner. Leaves the picture as it is when it is too small for that, and then returns false.
bool draw_color_scale(Image& image, const ColorScale& scale, std::string_view caption,
                      const ValuePlane::Summary& summary);

}  // namespace boxwood::render
