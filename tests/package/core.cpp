// What a user of the core links: a mesh, a tree, a ray, the registry, threads, and an error.
#include <boxwood/boxwood.h>

#include <cstdio>
#include <cstring>

namespace {

int fail(const char* what) {
  std::fprintf(stderr, "core: %s\n", what);
  return 1;
}

}  // namespace

int main() {
  if (std::strncmp(boxwood::version(), "0.1.", 4) != 0)
    return fail("the library tells another version than its package");
  if (boxwood::builders::registry().empty()) return fail("no builders");

  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -2, 1, 0, -2, 0, 1, -2};
  const auto accel = boxwood::Accel::build({.positions = positions, .vertex_count = 6, .triangle_count = 2});
  if (!accel) return fail(accel.error().message.c_str());
  const boxwood::Hit hit = accel->closest_hit({.origin = {0.25f, 0.25f, -5}, .direction = {0, 0, 1}});
  if (hit.primitive != 1 || hit.t != 3 || hit.u != 0.25f || hit.v != 0.25f) return fail("the ray hit something else");
  if (accel->any_hit({.origin = {2, 2, 5}, .direction = {0, 0, -1}})) return fail("the ray beside the triangles hit");

  boxwood::AccelOptions unknown;
  unknown.build.builder = "none-such";
  const auto refused = boxwood::Accel::build({.positions = positions, .vertex_count = 3, .triangle_count = 1}, unknown);
  if (refused || refused.error().code != boxwood::ErrorCode::unknown_name) return fail("an unknown builder was taken");
  std::printf("boxwood %s, %s: hit triangle %u\n", boxwood::version(), accel->isa().c_str(), hit.primitive);
  return 0;
}
