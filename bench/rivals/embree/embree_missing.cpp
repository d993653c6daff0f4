// For a build without Embree: everything that could start it is an error with one sentence.
#include "embree/embree_rival.h"

namespace boxwood::rivals {
namespace {

Error missing() {
  return {ErrorCode::unsupported,
          "Embree was not found when this program was built; install it (on Debian: libembree-dev) or give CMake "
          "-Dembree_DIR=, and build again"};
}

}  // namespace

Result<std::string> embree_version() {
  return missing();
}
Result<std::unique_ptr<Rival>> open_embree(const MeshView&, std::string_view, bool) {
  return missing();
}

}  // namespace boxwood::rivals
