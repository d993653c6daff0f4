// Boxes as six columns, and the areas of one box joined with each of a row of others: the inner loop of the builders
// that look for nearest neighbours. Compilers make SIMD code of it.
#pragma once

#include <cstddef>
#include <vector>

#include "boxwood/math.h"

namespace boxwood::builders {

class BoxColumns {
 public:
  void resize(std::size_t size) {
    for (std::vector<float>& column : columns_) column.resize(size);
  }
  void set(std::size_t i, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      columns_[std::size_t(axis)][i] = box.lower[axis];
      columns_[std::size_t(axis) + 3][i] = box.upper[axis];
    }
  }
  Box get(std::size_t i) const {
    return {{columns_[0][i], columns_[1][i], columns_[2][i]}, {columns_[3][i], columns_[4][i], columns_[5][i]}};
  }

  /// areas[k] = half the area of the box around box i and box first + k.
  void joined_half_areas(std::size_t i, std::size_t first, std::size_t count, float* __restrict areas) const {
    const Box box = get(i);
    const float* __restrict lower_x = columns_[0].data() + first;
    const float* __restrict lower_y = columns_[1].data() + first;
    const float* __restrict lower_z = columns_[2].data() + first;
    const float* __restrict upper_x = columns_[3].data() + first;
    const float* __restrict upper_y = columns_[4].data() + first;
    const float* __restrict upper_z = columns_[5].data() + first;
    for (std::size_t k = 0; k < count; ++k) {
      const float x = maximum(upper_x[k], box.upper.x) - minimum(lower_x[k], box.lower.x);
      const float y = maximum(upper_y[k], box.upper.y) - minimum(lower_y[k], box.lower.y);
      const float z = maximum(upper_z[k], box.upper.z) - minimum(lower_z[k], box.lower.z);
      areas[k] = x * y + y * z + z * x;
    }
  }

 private:
  std::vector<float> columns_[6];
};

/// The smallest of some areas, infinity if there are none. In eight lanes, which compilers turn into SIMD registers.
inline float smallest(const float* areas, std::size_t count) {
  constexpr std::size_t kLanes = 8;
  float lanes[kLanes];
  for (float& lane : lanes) lane = kInfinity;
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = minimum(areas[k + lane], lanes[lane]);
  for (; k < count; ++k) lanes[0] = minimum(areas[k], lanes[0]);
  for (const float lane : lanes) lanes[0] = minimum(lane, lanes[0]);
  return lanes[0];
}

/// A box in units of the scene (see area_scale): exact but for what is far below the scene's size.
inline Box scaled(const Box& box, float scale) {
  return {box.lower * scale, box.upper * scale};
}

}  // namespace boxwood::builders
