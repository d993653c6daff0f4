// Disjoint sets of 32-bit ids that several threads unite at once. Tarjan 1975 with path halving; links always go from
// the higher root to the lower one by compare-and-swap (in the manner of Anderson and Woll 1991), so the sets, their
// lowest members and the number of successful unions do not depend on the threads. Near-linear; no recursion.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "boxwood/base.h"

namespace boxwood::mesh {

class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) {
    for (std::size_t i = 0; i < size; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }

  std::uint32_t find(std::uint32_t id) {
    for (;;) {
      const std::uint32_t parent = load(id);
      if (parent == id) return id;
      const std::uint32_t grandparent = load(parent);
      if (parent != grandparent) store_if(id, parent, grandparent);
      id = parent;
    }
  }

  /// True if the two were in different sets until this call.
  bool unite(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = find(a), b = find(b);
      if (a == b) return false;
      if (a < b) std::swap(a, b);
      if (store_if(a, a, b)) return true;
    }
  }

 private:
  std::uint32_t load(std::uint32_t id) { return std::atomic_ref(parent_[id]).load(std::memory_order_relaxed); }
  bool store_if(std::uint32_t id, std::uint32_t expected, std::uint32_t desired) {
    return std::atomic_ref(parent_[id]).compare_exchange_strong(expected, desired, std::memory_order_relaxed);
  }

  AlignedBuffer<std::uint32_t> parent_;
};

}  // namespace boxwood::mesh
