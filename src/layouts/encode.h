// Pieces that all encoders share.
#pragma once

#include <algorithm>
#include <string>

#include "boxwood/layouts.h"

namespace boxwood::layouts {

/// Runs `f` and turns a failed allocation into an error.
template <class F>
auto guard_memory(F&& f) -> decltype(f()) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "not enough memory to encode the tree"};
  }
}

/// Every reference must be a triangle of the mesh with corners inside its vertices.
Status check_references(std::span<const std::uint32_t> references, const MeshView& mesh, Executor& executor);

}  // namespace boxwood::layouts
