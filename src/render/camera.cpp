#include "render/camera.h"

#include <charconv>
#include <numbers>

namespace boxwood::render {
namespace {

/// The shortest form that reads back as the same number.
std::string text(float value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string text(Vec3 v) {
  return "(" + text(v.x) + ", " + text(v.y) + ", " + text(v.z) + ")";
}

Status check_vector(const char* name, Vec3 v) {
  if (is_finite(v)) return {};
  return {ErrorCode::invalid_argument, "the view's " + std::string(name) + " " + text(v) + " is not finite"};
}

Status check_side(const char* name, int pixels) {
  if (pixels >= 1 && pixels <= kLargestSide) return {};
  return {ErrorCode::out_of_range, "the picture's " + std::string(name) + " of " + std::to_string(pixels) +
                                       " pixels is outside 1 to " + std::to_string(kLargestSide)};
}

Status check(const View& view, int width, int height) {
  for (const auto& [name, pixels] : {std::pair{"width", width}, std::pair{"height", height}})
    if (auto status = check_side(name, pixels); !status) return status;
  for (const auto& [name, v] :
       {std::pair{"eye", view.eye}, std::pair{"look_at", view.look_at}, std::pair{"up", view.up}})
    if (auto status = check_vector(name, v); !status) return status;
  if (view.eye == view.look_at)
    return {ErrorCode::invalid_argument, "the view's eye and look_at are the same point " + text(view.eye)};
  if (!(view.fov > 0 && view.fov < 180))
    return {ErrorCode::out_of_range,
            "the view's fov of " + text(view.fov) + " degrees is not between 0 and 180 (both excluded)"};
  return {};
}

/// An `up` this close to the view direction (sine of the angle) leaves nothing reliable to stand upright by.
constexpr double kParallel = 1e-6;

}  // namespace

Result<Camera> Camera::make(const View& view, int width, int height) {
  if (auto status = check(view, width, height); !status) return status.error();
  Camera camera;
  camera.eye_ = view.eye;
  camera.width_ = width, camera.height_ = height;
  camera.forward_ = normalize(Vector(view.look_at) - Vector(view.eye));
  const Vector wanted_up(view.up);
  Vector right = cross(camera.forward_, wanted_up);
  if (!(length(right) > kParallel * length(wanted_up)))
    right = cross(camera.forward_, least_aligned_axis(camera.forward_));
  camera.right_ = normalize(right);
  camera.up_ = cross(camera.right_, camera.forward_);
  // Rounded to single precision so that a last-bit difference between C libraries does not reach the rays.
  camera.half_height_ = static_cast<float>(std::tan(static_cast<double>(view.fov) * (std::numbers::pi / 360)));
  return camera;
}

Ray Camera::ray(std::size_t pixel) const {
  const auto column = static_cast<double>(pixel % static_cast<std::size_t>(width_));
  const auto row = static_cast<double>(pixel / static_cast<std::size_t>(width_));
  // Both in units of half the picture's height, so that pixels are square.
  const double x = (2 * column + 1 - width_) / height_ * half_height_;
  const double y = (height_ - 2 * row - 1) / height_ * half_height_;
  return {.origin = eye_, .direction = normalize(forward_ + right_ * x + up_ * y).rounded()};
}

}  // namespace boxwood::render
