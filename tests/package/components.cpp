// What a user of boxwood::io and boxwood::render links: a scene, its picture, and the picture's file.
#include <boxwood/boxwood.h>
#include <boxwood/io.h>
#include <boxwood/render.h>

#include <cstdio>
#include <filesystem>

namespace {

int fail(const std::string& what) {
  std::fprintf(stderr, "components: %s\n", what.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return fail("usage: components PICTURE.png");
  const auto scene = boxwood::mesh::make_scene("atrium", {.triangles = 2000});
  if (!scene) return fail(scene.error().message);
  const auto accel = boxwood::Accel::build(scene->mesh);
  if (!accel) return fail(accel.error().message);
  const auto image = boxwood::render::render(*accel, scene->view, 64, 48, boxwood::render::Shade::normals);
  if (!image) return fail(image.error().message);
  if (image->width != 64 || image->height != 48 || image->rgb.size() != 3u * 64 * 48) return fail("the size is wrong");
  const auto written = boxwood::io::write_png(argv[1], *image);
  if (!written) return fail(written.error().message);
  if (std::filesystem::file_size(argv[1]) < 100) return fail("the file is nearly empty");
  if (boxwood::io::read_mesh("none-such.ply")) return fail("a file that does not exist was read");
  return 0;
}
