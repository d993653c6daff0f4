// For a build without madmann91/bvh: everything that could start it is an error with one sentence.
#include "madmann/madmann_rival.h"

namespace boxwood::rivals {
namespace {

Error missing() {
  return {ErrorCode::unsupported,
          "madmann91/bvh was not there when this program was built; give CMake -DBOXWOOD_MADMANN_BVH_DIR=, the folder "
          "above bvh/v2/bvh.h, and build again"};
}

}  // namespace

Result<std::string> madmann_version() {
  return missing();
}
Result<std::unique_ptr<Rival>> open_madmann(const MeshView&, std::string_view, bool) {
  return missing();
}

}  // namespace boxwood::rivals
