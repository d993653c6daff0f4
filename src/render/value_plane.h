// One number per pixel, kept in the three bytes of the pixel itself until it is known how to colour it.
//
// Heat maps and depth need the numbers of the whole picture before the first colour is certain. Three bytes hold 24
// bits, which is enough, so that even the largest picture costs no memory beside itself.
#pragma once

#include <cstdint>

#include "boxwood/base.h"

namespace boxwood::render {

class ValuePlane {
 public:
  static constexpr std::uint32_t kNothing = 0xffffff;  ///< the value of a pixel that has none
  static constexpr std::uint32_t kLargest = kNothing - 1;

  explicit ValuePlane(Image& image) : image_(image) {}

  std::size_t size() const { return image_.rgb.size() / 3; }
  /// Larger values than kLargest are stored as kLargest.
  void set(std::size_t pixel, std::uint64_t value);
  void set_nothing(std::size_t pixel);
  std::uint32_t operator[](std::size_t pixel) const;

  struct Summary {
    std::size_t count = 0;  ///< pixels that have a value
    std::uint32_t smallest = 0, largest = 0;
    double mean = 0;
  };
  Summary summarize() const;
  /// The smallest value that is not exceeded by at least `share` (0 to 1) of the pixels that have one; 0 if none has.
  /// Exact, by two histograms of 12 bits each.
  std::uint32_t quantile(double share) const;

 private:
  Image& image_;
};

}  // namespace boxwood::render
