// Double to single precision in a chosen direction, for boxes that must hold what they are made of.
#pragma once

#include "boxwood/math.h"

namespace boxwood {

/// The largest float that is not above x.
inline float round_down(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -kInfinity) : f;
}
/// The smallest float that is not below x.
inline float round_up(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, kInfinity) : f;
}

}  // namespace boxwood
