// Picking a builder: every builder of the registry over the same scene, and what each takes and gives.
//
// A builder that works longer usually gives a tree that is cheaper to trace. Exp(T), the expected cost of a ray, says
// how much cheaper before a single ray is traced: a rough guide that measuring your own rays should confirm. Try other
// scenes
// (`boxwood scenes` lists them) and sizes: 02_pick_a_builder spaceship 500000
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "boxwood/boxwood.h"

namespace {

int fail(const boxwood::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const char* scene_id = argc > 1 ? argv[1] : "atrium";
  const std::size_t triangles = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 20000;
  const auto scene = boxwood::mesh::make_scene(scene_id, {.triangles = triangles});
  if (!scene) return fail(scene.error());
  std::printf("%s, %zu triangles\n", scene->mesh.name.c_str(), scene->mesh.triangles.size());
  std::printf("%-16s %10s %10s %8s %6s\n", "builder", "build ms", "Exp(T)", "nodes", "depth");

  boxwood::ThreadExecutor executor;
  for (const boxwood::builders::BuilderInfo& builder : boxwood::builders::registry()) {
    auto references = boxwood::refs::make_references(scene->mesh, executor);
    if (!references) return fail(references.error());
    if (references->references.size() > builder.largest_sensible) {
      std::printf("%-16s is not made for so many triangles\n", builder.id);
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    const auto tree = boxwood::builders::build(std::move(*references), {.builder = builder.id, .settings = {}},
                                               {.executor = executor});
    const std::chrono::duration<double, std::milli> build_time = std::chrono::steady_clock::now() - start;
    if (!tree) return fail(tree.error());
    const auto shape = boxwood::tree::statistics(*tree);
    std::printf("%-16s %10.2f %10.2f %8zu %6zu\n", builder.id, build_time.count(),
                boxwood::metrics::surface_area_cost(*tree), shape.nodes, shape.max_depth);
  }
  return 0;
}
