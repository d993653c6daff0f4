// Build time of every builder on the organic scene, one thread, in triangles per second.
#include <benchmark/benchmark.h>

#include "boxwood/builders.h"

namespace {

using namespace boxwood;

void build(benchmark::State& state, const char* builder, std::size_t triangles) {
  const auto scene = mesh::make_scene("organic", {.triangles = triangles});
  SequentialExecutor executor;
  for (auto _ : state) {
    state.PauseTiming();
    auto references = refs::make_references(scene->mesh, executor);
    state.ResumeTiming();
    auto tree = builders::build(std::move(*references), {.builder = builder}, {executor});
    benchmark::DoNotOptimize(tree);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * scene->mesh.triangles.size()));
}

const int registered = [] {
  for (const auto& row : builders::registry())
    for (std::size_t triangles : {10'000, 200'000})
      benchmark::RegisterBenchmark(("build/" + std::string(row.id) + "/" + std::to_string(triangles)).c_str(), build,
                                   row.id, triangles)
          ->Unit(benchmark::kMillisecond);
  return 0;
}();

}  // namespace
