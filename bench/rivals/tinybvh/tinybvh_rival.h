// tinybvh (Bikker; one header, https://github.com/jbikker/tinybvh) as a rival, when CMake gets -DBOXWOOD_TINYBVH_DIR=.
#pragma once

#include "rival.h"

namespace boxwood::rivals {

Result<std::string> tinybvh_version();
Result<std::unique_ptr<Rival>> open_tinybvh(const MeshView& mesh, std::string_view id, bool robust);

}  // namespace boxwood::rivals
