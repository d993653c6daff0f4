// Counts rays that escape from inside a closed surface. Every miss is a leak.
//
//     check_leaks [--levels 6] [--rays 4000000]
//
// A closed icosphere of 20 * 4^levels triangles at the origin, 100 radii away, and scaled by 1e-4; rays from inside it
// at its vertices, at points on its edges and at random; every layout, instruction set and mode of ours, and Embree's
// two. Exits with 1 when robust mode loses a ray.
#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "boxwood/accel.h"
#include "rival.h"
#include "support/meshes.h"

using namespace boxwood;

namespace {

struct Placement {
  const char* name;
  float radius;
  Vec3 center;
};

std::size_t count_misses(std::span<const Hit> hits) {
  std::size_t misses = 0;
  for (const Hit& hit : hits) misses += !hit;
  return misses;
}

void print_row(const Placement& placement, const char* aim, std::string_view who, std::size_t rays, std::size_t lost) {
  fmt::print("{:<18} {:<9} {:<28} {:>9} {:>9}  {:.4f} %\n", placement.name, aim, who, rays, lost, 100.0 * lost / rays);
}

// Gives how many rays robust mode lost.
std::size_t check(const Placement& placement, const TriangleMesh& mesh, test::Aim aim, const char* aim_name,
                  std::size_t count) {
  const auto rays = test::rays_from_inside(mesh, placement.center, placement.radius, aim, count, 1);
  std::vector<Hit> hits(rays.size());
  std::size_t lost_by_robust = 0;
  for (const auto& layout : layouts::registry())
    for (const std::string& isa : queries::supported_isas()) {
      if (layout.id == layouts::LayoutId::linear && isa != queries::supported_isas().front()) continue;
      const auto accel = Accel::build(mesh, {.layout = layout.name, .isa = isa});
      if (!accel) {
        fmt::print(stderr, "check_leaks: {}\n", accel.error().message);
        std::exit(1);
      }
      for (auto mode : {queries::Mode::robust, queries::Mode::fast}) {
        (void)accel->closest_hits(rays, hits, {}, mode);
        const std::size_t lost = count_misses(hits);
        if (mode == queries::Mode::robust) lost_by_robust += lost;
        const char* isa_name = layout.id == layouts::LayoutId::linear ? "any ISA" : isa.c_str();
        print_row(placement, aim_name, fmt::format("{} {} {}", layout.name, isa_name, queries::name(mode)), count,
                  lost);
      }
    }
  ThreadExecutor executor;
  for (const bool robust : {false, true}) {
    auto embree = rivals::open(mesh, "embree:medium", robust);
    if (!embree || !(*embree)->build(executor.threads())) continue;
    (*embree)->closest_hits(rays, hits, rivals::Calls::single, executor);
    print_row(placement, aim_name, robust ? "Embree ROBUST" : "Embree default", count, count_misses(hits));
  }
  return lost_by_robust;
}

}  // namespace

int main(int argc, char** argv) {
  int levels = 6;
  std::size_t count = 4'000'000;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view option = argv[i];
    const long value = i + 1 < argc ? std::atol(argv[i + 1]) : 0;
    if (option == "--levels" && value >= 0 && value <= 9)
      levels = static_cast<int>(value);
    else if (option == "--rays" && value > 0)
      count = static_cast<std::size_t>(value);
    else {
      fmt::print(stderr, "usage: check_leaks [--levels 0..9] [--rays N]\n");
      return 2;
    }
  }
  const auto version = rivals::libraries()[0].version();
  fmt::print("boxwood {}, {}\n", boxwood::version(), version ? *version : version.error().message);
  const Placement placements[] = {
      {"at the origin", 1, {}}, {"100 radii away", 1, {100, 0, 0}}, {"scaled by 1e-4", 1e-4f, {}}};
  fmt::print("{:<18} {:<9} {:<28} {:>9} {:>9}\n", "placement", "aimed at", "who", "rays", "lost");
  std::size_t lost = 0;
  for (const Placement& placement : placements) {
    const TriangleMesh mesh = test::icosphere(levels, placement.radius, placement.center);
    lost += check(placement, mesh, test::Aim::vertices, "vertices", count);
    lost += check(placement, mesh, test::Aim::edges, "edges", count);
    lost += check(placement, mesh, test::Aim::random, "random", count);
  }
  fmt::print("robust mode lost {} rays\n", lost);
  return lost == 0 ? 0 : 1;
}
