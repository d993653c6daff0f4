// The numbers of POPOV's Tables 2 to 4 (Popov, Georgiev, Dimov and Slusallek 2009).
#pragma once

#include <span>
#include <string_view>

namespace boxwood::program::reproduce {

/// Tables 3 and 4: MiB (NaN in Table 3, which has no such column), Exp, cost, nodes and triangles per random ray, and
/// frames per second of a million rays: random, packets of 4, range packets, partition packets.
struct PopovFullRow {
  const char* scene;
  const char* type;
  double values[9];
};
std::span<const PopovFullRow> popov_geometric_rows();
std::span<const PopovFullRow> popov_generic_rows();

/// Table 2, Sponza.
struct PopovPresplitRow {
  bool turned;
  const char* type;
  double size, exp, cost, speed;
};
/// Null: the paper has no such row.
const PopovPresplitRow* popov_presplit_row(bool turned, std::string_view type);

}  // namespace boxwood::program::reproduce
