// For a build without tinybvh: everything that could start it is an error with one sentence.
#include "tinybvh/tinybvh_rival.h"

namespace boxwood::rivals {
namespace {

Error missing() {
  return {ErrorCode::unsupported,
          "tinybvh was not there when this program was built; give CMake -DBOXWOOD_TINYBVH_DIR=, the folder of "
          "tiny_bvh.h, and build again"};
}

}  // namespace

Result<std::string> tinybvh_version() {
  return missing();
}
Result<std::unique_ptr<Rival>> open_tinybvh(const MeshView&, std::string_view, bool) {
  return missing();
}

}  // namespace boxwood::rivals
