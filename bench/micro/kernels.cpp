// Rays per second of every layout, instruction set and mode: random rays through the organic scene, one thread.
#include <benchmark/benchmark.h>

#include "boxwood/accel.h"
#include "boxwood/render.h"

namespace {

using namespace boxwood;

void closest(benchmark::State& state, const std::string& layout, const std::string& isa, queries::Mode mode) {
  const auto scene = mesh::make_scene("organic", {.triangles = 100'000});
  const auto accel =
      Accel::build(scene->mesh, {.layout = layout, .isa = isa, .executor = std::make_shared<SequentialExecutor>()});
  const auto rays = render::random_rays(accel->bounds(), 1 << 16, 1);
  std::vector<Hit> hits(rays.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(accel->closest_hits(rays, hits, {}, mode));
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rays.size()));
}

const int registered = [] {
  for (const auto& layout : layouts::registry())
    for (const std::string& isa : queries::supported_isas())
      for (auto mode : {queries::Mode::robust, queries::Mode::fast})
        benchmark::RegisterBenchmark(
            ("closest/" + std::string(layout.name) + "/" + isa + "/" + queries::name(mode)).c_str(), closest,
            layout.name, isa, mode)
            ->Unit(benchmark::kMillisecond);
  return 0;
}();

}  // namespace
