// Traces the same rays with every builder, layout and instruction set and with Embree, and counts disagreements.
//
//     check_agreement [--rays N] [--builders a,b] MESH [CAMERA]...
//
// Per mesh: N random rays and 1024 x 1024 primary rays (CAMERA: eye,look_at,up,fov as ten numbers x,y,z,...; default: a
// view from the bounds). The first combination's hits are held against Embree's in ROBUST mode: agreed when the
// primitive is the same, t is within 1e-5 (relative) or both miss. Where they differ a double-precision brute force
// over the whole mesh decides. All other combinations must give the same bits as the first in robust mode. Exits with 1
// when they do not, or when brute force finds a clear hit (1e-6 inside a triangle) that ours does not have.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "agreement.h"
#include "boxwood/accel.h"
#include "boxwood/io.h"
#include "boxwood/render.h"
#include "rival.h"

using namespace boxwood;

namespace {

[[noreturn]] void fail(const std::string& sentence) {
  fmt::print(stderr, "check_agreement: {}\n", sentence);
  std::exit(1);
}

template <class T>
T take(Result<T> result) {
  if (!result) fail(result.error().message);
  return std::move(*result);
}

View parse_camera(const std::string& text) {
  float n[10];
  std::istringstream in(text);
  char comma;
  for (int i = 0; i < 10; ++i) {
    if (!(in >> n[i])) fail("camera '" + text + "' is not ten numbers");
    in >> comma;
  }
  return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9]};
}

struct Options {
  std::size_t rays = 1'000'000;
  std::vector<std::string> builders;
};

// Gives the number of failures.
std::size_t check(const std::string& path, const Options& options, const std::string* camera) {
  const TriangleMesh mesh = std::move(take(io::read_mesh(path)).mesh);
  auto executor = std::make_shared<ThreadExecutor>();
  const Box bounds = mesh::bounds(mesh, *executor);
  const View view = camera ? parse_camera(*camera) : mesh::view_from_bounds(bounds);
  struct Set {
    const char* name;
    std::vector<Ray> rays;
    std::vector<Hit> first;
  } sets[] = {{"random", render::random_rays(bounds, options.rays, 1), {}},
              {"primary", take(render::primary_rays(view, 1024, 1024)), {}}};
  std::size_t failures = 0, combinations = 0, same = 0;
  for (const std::string& builder : options.builders) {
    auto references = take(refs::make_references(mesh, *executor));
    const auto tree = take(builders::build(std::move(references), {.builder = builder}, {*executor}));
    for (const auto& layout : layouts::registry())
      for (const std::string& isa : queries::supported_isas()) {
        // One scalar source serves `linear` on every instruction set.
        if (layout.id == layouts::LayoutId::linear && isa != queries::supported_isas().front()) continue;
        const auto accel =
            take(Accel::from_tree(mesh, tree, {.layout = layout.name, .isa = isa, .executor = executor}));
        ++combinations;
        for (Set& set : sets) {
          std::vector<Hit> hits(set.rays.size());
          if (auto s = accel.closest_hits(set.rays, hits); !s) fail(s.error().message);
          if (set.first.empty()) set.first = hits;
          std::size_t different = 0;
          for (std::size_t i = 0; i < hits.size(); ++i)
            different += std::memcmp(&hits[i], &set.first[i], sizeof(Hit)) != 0;
          same += different == 0;
          failures += different;
          if (different)
            fmt::print("  {} {} {}: {} {} rays differ from the first combination\n", builder, layout.name, isa,
                       different, set.name);
        }
      }
  }
  fmt::print("{}: {} triangles, {} combinations, {} of {} ray sets bit-identical\n", mesh.name, mesh.triangles.size(),
             combinations, same, 2 * combinations);
  for (const bool robust : {true, false}) {
    auto embree = take(rivals::open(mesh, "embree:medium", robust));
    (void)take(embree->build(executor->threads()));
    for (const Set& set : sets) {
      std::vector<Hit> theirs(set.rays.size());
      embree->closest_hits(set.rays, theirs, rivals::Calls::single, *executor);
      const rivals::Verdicts v = rivals::compare_closest(mesh, set.rays, set.first, theirs, *executor);
      fmt::print(
          "  {:<8} against Embree {:<8} {:>8} rays, {:>8} hits, {:>3} differ: brute force sides with ours {}, with "
          "both {}, a border decides {}, ours wrong {}\n",
          set.name, robust ? "ROBUST:" : "default:", v.rays, v.hits, v.differences, v.ours_right, v.both, v.border,
          v.wrong);
      if (v.wrong) fmt::print("  clear disagreement: {}\n", v.first_wrong);
      failures += v.wrong;
    }
  }
  std::fflush(stdout);
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::vector<std::string> inputs;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if ((argument == "--rays" || argument == "--builders") && i + 1 < argc) {
      std::istringstream value(argv[++i]);
      if (argument == "--rays") value >> options.rays;
      for (std::string id; argument == "--builders" && std::getline(value, id, ',');) options.builders.push_back(id);
    } else {
      inputs.push_back(argument);
    }
  }
  if (options.builders.empty())
    for (const auto& row : builders::registry()) options.builders.emplace_back(row.id);
  if (inputs.empty()) fail("name at least one mesh");
  std::size_t failures = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const bool has_camera = i + 1 < inputs.size() && inputs[i + 1].find(',') != std::string::npos;
    failures += check(inputs[i], options, has_camera ? &inputs[i + 1] : nullptr);
    i += has_camera;
  }
  fmt::print("{} failures\n", failures);
  return failures == 0 ? 0 : 1;
}
