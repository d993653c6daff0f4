// How a binary leaf that is larger than a wide leaf may be becomes several: chunks of the limit's size, the last one
// smaller, below as few inner nodes as their number allows.
#pragma once

#include <algorithm>
#include <cstdint>

namespace boxwood::optimizers {

constexpr std::uint64_t divide_up(std::uint64_t a, std::uint64_t b) {
  return (a + b - 1) / b;
}

/// Inner nodes of at most `width` children that it takes to hold `chunks` leaves in a forest of `roots` trees: each
/// inner node stands for `width` things where there was one before.
constexpr std::uint64_t chunk_nodes(std::uint64_t chunks, std::uint64_t roots, std::uint64_t width) {
  return chunks <= roots ? 0 : divide_up(chunks - roots, width - 1);
}

/// Chunks below each of the `roots` trees of a forest that needs only `chunk_nodes` inner nodes: full trees of the
/// larger depth first, one partly filled, then full trees of the smaller depth. Needs chunks >= roots.
class ChunkForest {
 public:
  ChunkForest(std::uint64_t chunks, std::uint64_t roots, std::uint64_t width) : width_(width) {
    while (roots * smallest_ * width < chunks) smallest_ *= width;
    rest_ = chunks - roots * smallest_;
  }
  /// Chunks of the next tree, from left to right.
  std::uint64_t next() {
    const std::uint64_t more = std::min(rest_, smallest_ * (width_ - 1));
    rest_ -= more;
    return smallest_ + more;
  }

 private:
  std::uint64_t width_, smallest_ = 1, rest_ = 0;
};

}  // namespace boxwood::optimizers
