// A range of references that will become one subtree.
#pragma once

#include <cstdint>

#include "builders/parts/box4.h"

namespace boxwood::builders {

/// References [first, last), with the boxes of the references and of their (doubled) centroids.
struct BuildRange {
  Box4 bounds;
  Box4 centroids2;
  std::uint32_t first = 0, last = 0;
  std::uint32_t slot = 0;    ///< where its node goes, see top_down.h
  std::uint32_t depth = 0;   ///< of its node; the root's is 0
  std::uint32_t buffer = 0;  ///< which of the two buffers holds its references, for finders that have two

  std::uint32_t size() const { return last - first; }
};

/// Ranges of more references than this are worked on in parallel chunks, smaller ones by one thread. Fixed, so that
/// what is calculated does not depend on the number of threads.
inline constexpr std::size_t kLargeRange = 1 << 14;
inline constexpr std::size_t kChunk = 1 << 12;
/// Smaller ranges are not worth a task of their own.
inline constexpr std::size_t kTaskRange = 1 << 12;

}  // namespace boxwood::builders
