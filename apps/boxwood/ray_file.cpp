#include "ray_file.h"

#include <fmt/format.h>

#include <span>

#include "boxwood/io.h"
#include "text.h"

namespace boxwood::program {
namespace {

std::string fault_of(const Ray& ray) {
  if (!is_finite(ray.origin)) return fmt::format("the origin {} is not finite", vector_text(ray.origin));
  if (!is_finite(ray.direction)) return fmt::format("the direction {} is not finite", vector_text(ray.direction));
  if (ray.direction == Vec3{}) return "the direction is zero";
  if (!(ray.tmin >= 0)) return fmt::format("tmin is {}, which is not 0 or more", ray.tmin);
  if (!(ray.tmax >= ray.tmin)) return fmt::format("tmax {} is below tmin {}", ray.tmax, ray.tmin);
  return {};
}

Status check_rays(const std::string& path, std::span<const Ray> rays) {
  for (std::size_t row = 0; row < rays.size(); ++row)
    if (const std::string fault = fault_of(rays[row]); !fault.empty())
      return {ErrorCode::malformed, fmt::format("{}, row {} (counting from 0): {}", path, row, fault)};
  return {};
}

}  // namespace

Result<std::vector<Ray>> read_ray_file(const std::string& path) {
  auto rays = io::read_rays(path);
  if (rays)
    if (Status status = check_rays(path, *rays); !status) return status.error();
  return rays;
}

}  // namespace boxwood::program
