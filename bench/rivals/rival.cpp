#include "rival.h"

#include <algorithm>
#include <array>

#include "embree/embree_rival.h"
#include "madmann/madmann_rival.h"
#include "tinybvh/tinybvh_rival.h"

namespace boxwood::rivals {
namespace {

constexpr RivalInfo kEmbree[] = {
    {"embree:medium", "RTC_BUILD_QUALITY_MEDIUM: binned SAH", true, true},
    {"embree:high", "RTC_BUILD_QUALITY_HIGH: spatial splits, which its ROBUST mode leaves out", true, true},
    {"embree:low", "RTC_BUILD_QUALITY_LOW: Morton codes", true, true},
};
constexpr RivalInfo kTinybvh[] = {
    {"tinybvh:bvh8-hq", "BVH8_CPU, BuildHQ: spatial splits", false, false},
    {"tinybvh:bvh8", "BVH8_CPU, Build: binned SAH", false, false},
    {"tinybvh:bvh4-hq", "BVH4_CPU, BuildHQ: spatial splits", false, false},
    {"tinybvh:bvh4", "BVH4_CPU, Build: binned SAH", false, false},
};
constexpr RivalInfo kMadmann[] = {
    {"madmann:high", "DefaultBuilder, Quality::High", true, false},
    {"madmann:medium", "DefaultBuilder, Quality::Medium", true, false},
    {"madmann:low", "DefaultBuilder, Quality::Low", true, false},
};

}  // namespace

std::span<const Library> libraries() {
  static const std::array<Library, 3> list{{
      {"embree", kEmbree, embree_version, open_embree},
      {"tinybvh", kTinybvh, tinybvh_version, open_tinybvh},
      {"madmann", kMadmann, madmann_version, open_madmann},
  }};
  return list;
}

Result<std::unique_ptr<Rival>> open(const MeshView& mesh, std::string_view id, bool robust) {
  for (const Library& library : libraries())
    for (const RivalInfo& rival : library.rivals)
      if (id == rival.id) return library.open(mesh, id, robust);
  return Error{ErrorCode::unknown_name, "there is no rival '" + std::string(id) + "'"};
}

}  // namespace boxwood::rivals
