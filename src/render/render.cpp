// The entry point of pictures, and the list of shades.
#include "boxwood/render.h"

#include "render/camera.h"
#include "render/frame.h"

namespace boxwood::render {
namespace {

struct ShadeName {
  Shade shade;
  std::string_view name;
};
constexpr ShadeName kShades[] = {
    {Shade::normals, "normals"},       {Shade::ao, "ao"},   {Shade::depth, "depth"},          {Shade::nodes, "nodes"},
    {Shade::primitives, "primitives"}, {Shade::ids, "ids"}, {Shade::subdivided, "subdivided"}};

Status draw(const Frame& frame, Shade shade, Image& image) {
  switch (shade) {
    case Shade::normals:
    case Shade::subdivided:
      return shade_normals(frame, image);
    case Shade::ao:
      return shade_occlusion(frame, image);
    case Shade::depth:
      return shade_depth(frame, image);
    case Shade::nodes:
    case Shade::primitives:
      return shade_heat(frame, shade, image);
    case Shade::ids:
      return shade_ids(frame, image);
  }
  return {ErrorCode::invalid_argument, "there is no shade number " + std::to_string(static_cast<int>(shade))};
}

}  // namespace

Result<Shade> find_shade(std::string_view name) {
  std::string names;
  for (const ShadeName& row : kShades) {
    if (row.name == name) return row.shade;
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  return {ErrorCode::unknown_name, "unknown shade \"" + std::string(name) + "\"; there are " + names};
}

Result<Image> render(const Accel& accel, const View& view, int width, int height, Shade shade,
                     std::span<const std::uint8_t> marked) try {
  auto camera = Camera::make(view, width, height);
  if (!camera) return camera.error();
  const Frame frame{accel, *camera, shade == Shade::subdivided ? marked : std::span<const std::uint8_t>{}};
  Image image{.width = width, .height = height, .rgb = std::vector<std::uint8_t>(3 * camera->pixel_count())};
  if (auto drawn = draw(frame, shade, image); !drawn) return drawn.error();
  return image;
} catch (const std::bad_alloc&) {
  return {ErrorCode::out_of_memory,
          "not enough memory for a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels"};
}

}  // namespace boxwood::render
