// How this folder cuts its work: by item count only, so that results do not depend on threads.
#pragma once

#include <cstddef>

namespace boxwood::mesh {

inline constexpr std::size_t kChunk = 1 << 14;

constexpr std::size_t chunk_count(std::size_t items) {
  return (items + kChunk - 1) / kChunk;
}

}  // namespace boxwood::mesh
