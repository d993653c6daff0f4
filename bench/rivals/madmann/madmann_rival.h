// madmann91/bvh, version 2 (Pérard-Gayot; headers, https://github.com/madmann91/bvh) as a rival, when CMake gets
// -DBOXWOOD_MADMANN_BVH_DIR=.
#pragma once

#include "rival.h"

namespace boxwood::rivals {

Result<std::string> madmann_version();
Result<std::unique_ptr<Rival>> open_madmann(const MeshView& mesh, std::string_view id, bool robust);

}  // namespace boxwood::rivals
