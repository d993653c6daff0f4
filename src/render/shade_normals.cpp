// The shade `normals`: a lamp at the eye, softened, on a clay that is tinted by the normal's direction in the mesh's
// axes. The shade `subdivided` is the same with the marked triangles in red.
#include "render/backdrop.h"
#include "render/color.h"
#include "render/frame.h"
#include "render/surface_point.h"

namespace boxwood::render {
namespace {

Color surface_color(const Ray& ray, Vec3 normal, bool marked) {
  const Vector n = facing_normal(ray, normal);
  // Opposite normals get opposite tints of about the same lightness, so that no side of a building is murky.
  const Color clay = marked ? from_oklab(0.62, 0.21, 0.11)
                            : from_oklab(0.80 + 0.05 * n.y, 0.06 * n.x - 0.02 * n.y, 0.02 + 0.06 * n.z - 0.02 * n.y);
  const auto cosine = static_cast<float>(-dot(n, normalize(Vector(ray.direction))));
  // Part linear, part squared: grazing surfaces stay readable and those that face the eye stand out.
  return clay * (0.14f + 0.56f * cosine + 0.40f * cosine * cosine);
}

}  // namespace

Status shade_normals(const Frame& frame, Image& image) {
  return for_batches(frame, Detail::normals, [&](const PixelBatch& batch) -> Status {
    for_each_index(frame.accel.executor(), batch.size(), [&](std::size_t i) {
      const std::size_t pixel = batch.first_pixel + i;
      set_pixel(image, pixel,
                to_srgb(batch.hits[i]
                            ? surface_color(batch.rays[i], batch.normals[i], frame.is_marked(batch.hits[i].primitive))
                            : backdrop(frame.camera, pixel)));
    });
    return {};
  });
}

}  // namespace boxwood::render
