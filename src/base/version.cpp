#include "boxwood/base.h"

namespace boxwood {

const char* version() noexcept {
  return BOXWOOD_VERSION;
}

}  // namespace boxwood
