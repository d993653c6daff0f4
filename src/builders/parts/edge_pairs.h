// References paired over the edges of their triangles: one round of what EBBVH does (Houghton and Spoerer, bib key
// ebbvh), by least growth of the box instead of by largest edge.
#pragma once

#include <bit>
#include <cstdint>

#include "boxwood/builders.h"
#include "boxwood/refs.h"

namespace boxwood::builders {

inline constexpr std::uint32_t kNoPartner = 0xffffffffu;

/// Two references, or one.
struct ReferencePair {
  std::uint32_t first, second;  ///< second = kNoPartner: one only
};

struct EdgePairs {
  refs::ReferenceSet set;  ///< box of each pair; `primitive` is its number, `reserved` holds the bits of parts_area
  AlignedBuffer<ReferencePair> pairs;
  bool numbered = false;  ///< each reference stands at the number of its primitive

  /// The area of both references' boxes, over that of the box around both; 0: a single reference.
  static float parts_area(const refs::Reference& pair) { return std::bit_cast<float>(pair.reserved); }
};

/// Where partners are looked for: among the few references that follow, asking of each whether it shares an edge; or
/// over all edges, by a table of them.
enum class PairSearch { near, all };

/// Two references become a pair when their primitives share an edge and the box around both has at most `growth` times
/// the area of their boxes, added (0: whatever it has). O(n), parallel, the same pairs for every number of threads.
EdgePairs pair_references(const refs::ReferenceSet& set, PairSearch search, mesh::Weld weld, double growth,
                          Executor& executor);

}  // namespace boxwood::builders
