// How many references are inside a box of grid cells, in O(1): what the auxiliary tree of Popov et al. 2009 (bib key
// popov2009, section 3.2) counts in about sqrt(n), for planes of a grid.
//
// A reference is inside a box of grid planes when the smallest such box around it is. The table has one entry for each
// box of planes, filled with the references that have it as their smallest, and summed up over smaller boxes one side
// at a time. With R cells on each axis it has about R^6 / 8 entries: no more than the configurations that ask it.
#pragma once

#include <cstdint>
#include <vector>

#include "builders/parts/configuration.h"
#include "builders/parts/grid_planes.h"

namespace boxwood::builders {

/// A box whose sides are planes, by their numbers in CandidatePlanes.
struct PlaneBox {
  std::int32_t lower[3], upper[3];
};

/// What a configuration makes of a set of references. When `covered` is false the other numbers mean nothing.
struct SideCounts {
  bool covered = false;
  std::uint32_t left = 0, right = 0;  ///< inside this child only
  std::uint32_t both = 0;             ///< inside each of the two
  std::uint32_t split = 0;            ///< inside none but inside both together
};

class CountingTable {
 public:
  /// `planes` are those of a grid and outlive the table.
  CountingTable(std::span<const refs::Reference> references, const CandidatePlanes& planes);

  std::uint32_t inside(const PlaneBox& box) const {
    std::size_t index = 0;
    for (int i = 0; i < 3; ++i) {
      if (box.lower[i] > box.upper[i]) return 0;
      index =
          index * size_[i] + row_[i][static_cast<std::size_t>(box.lower[i])] + static_cast<std::size_t>(box.upper[i]);
    }
    return table_[index];
  }

  /// `may_split`: does it suffice that each reference is inside both children together?
  SideCounts count(const PlaneBox& left, const PlaneBox& right, bool may_split) const;

 private:
  void sum_up(int axis);

  std::uint32_t all_;
  std::size_t size_[3];              ///< intervals between planes
  std::vector<std::size_t> row_[3];  ///< [lower] + upper is an interval's number
  std::vector<std::uint32_t> table_;
};

}  // namespace boxwood::builders
