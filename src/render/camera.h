// A pinhole camera: from a View and a picture size to one ray per pixel.
#pragma once

#include "boxwood/accel.h"
#include "boxwood/math.h"
#include "render/vector.h"

namespace boxwood::render {

inline constexpr int kLargestSide = 16384;

class Camera {
 public:
  /// Checks view and size as primary_rays documents it; the sentences name the value.
  static Result<Camera> make(const View& view, int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t pixel_count() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  /// Unit vector of the view direction.
  Vector forward() const { return forward_; }
  Vec3 eye() const { return eye_; }

  /// The ray through the centre of a pixel; pixels are numbered row by row from the top left.
  Ray ray(std::size_t pixel) const;

 private:
  Vec3 eye_;
  Vector forward_, right_, up_;  ///< unit vectors
  double half_height_ = 0;       ///< of the picture, at distance one
  int width_ = 0, height_ = 0;
};

}  // namespace boxwood::render
