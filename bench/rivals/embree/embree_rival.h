// Embree 3 or 4 as a rival. `open` sets RTC_SCENE_FLAG_ROBUST where `robust` is asked for; ids: embree:low,
// embree:medium and embree:high, its build qualities, set for the scene and for its geometry.
#pragma once

#include "rival.h"

namespace boxwood::rivals {

Result<std::string> embree_version();
Result<std::unique_ptr<Rival>> open_embree(const MeshView& mesh, std::string_view id, bool robust);

}  // namespace boxwood::rivals
