// Shadows: a batch of primary rays, then a batch of shadow rays to a lamp, and a picture of the result.
//
// Batches run on all processors and give the same answers as single rays. `03_shadows picture.pgm` writes the picture
// as a grey map that most viewers open; without an argument it is drawn in characters.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "boxwood/boxwood.h"
#include "boxwood/render.h"

namespace {

using boxwood::Hit;
using boxwood::Ray;
using boxwood::Vec3;

int fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return 1;
}

// A ray from just above the hit point to the lamp. Its direction spans the whole way, so t = 1 is the lamp.
Ray shadow_ray(const Ray& primary, const Hit& hit, Vec3 normal, Vec3 lamp, float lift) {
  if (boxwood::dot(normal, primary.direction) > 0) normal = -normal;
  const Vec3 origin = primary.origin + hit.t * primary.direction + lift * boxwood::normalize(normal);
  return {.origin = origin, .direction = lamp - origin, .tmax = 1};
}

bool write_grey_map(const char* path, const std::vector<unsigned char>& grey, int width, int height) {
  std::FILE* file = std::fopen(path, "wb");
  if (!file) return false;
  bool is_written = std::fprintf(file, "P5\n%d %d\n255\n", width, height) > 0;
  is_written = is_written && std::fwrite(grey.data(), 1, grey.size(), file) == grey.size();
  return std::fclose(file) == 0 && is_written;
}

void draw_in_characters(const std::vector<unsigned char>& grey, int width, int height) {
  const std::string ramp = " .:-=+*#%@";
  for (int y = 0; y < height; ++y) {
    std::string line;
    for (int x = 0; x < width; ++x) line += ramp[grey[y * width + x] * (ramp.size() - 1) / 255];
    std::puts(line.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const char* path = argc > 1 ? argv[1] : nullptr;
  const int width = path ? 640 : 96, height = path ? 480 : 36;
  const auto scene = boxwood::mesh::make_scene("city", {.triangles = 20000});
  if (!scene) return fail(scene.error().message);
  const auto accel = boxwood::Accel::build(scene->mesh);
  if (!accel) return fail(accel.error().message);

  const auto primary = boxwood::render::primary_rays(scene->view, width, height);
  if (!primary) return fail(primary.error().message);
  std::vector<Hit> hits(primary->size());
  std::vector<Vec3> normals(primary->size());
  if (auto status = accel->closest_hits(*primary, hits, normals); !status) return fail(status.error().message);

  const boxwood::Box bounds = accel->bounds();
  const float diagonal = boxwood::length(bounds.extent());
  const Vec3 lamp = bounds.center() + diagonal * Vec3{0.5f, 1.0f, 0.3f};
  std::vector<Ray> shadow_rays;
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    shadow_rays.push_back(shadow_ray((*primary)[i], hits[i], normals[i], lamp, 1e-4f * diagonal));
    pixels.push_back(i);
  }
  std::vector<std::uint8_t> occluded(shadow_rays.size());
  if (auto status = accel->any_hits(shadow_rays, occluded); !status) return fail(status.error().message);

  std::vector<unsigned char> grey(hits.size(), 0);
  std::size_t in_shadow = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Vec3 normal = boxwood::normalize(normals[pixels[i]]);
    const float light = std::abs(boxwood::dot(normal, boxwood::normalize(shadow_rays[i].direction)));
    grey[pixels[i]] = static_cast<unsigned char>(occluded[i] ? 40 : 80 + 175 * light);
    in_shadow += occluded[i];
  }
  if (!path) draw_in_characters(grey, width, height);
  if (path && !write_grey_map(path, grey, width, height)) return fail(std::string("can't write ") + path);
  std::printf("%zu of %zu primary rays hit the city; %.1f %% of those points are in shadow.\n", pixels.size(),
              hits.size(), pixels.empty() ? 0.0 : 100.0 * in_shadow / pixels.size());
  return 0;
}
