#include "tree/unique_prefix.h"

#include <algorithm>
#include <unordered_set>

namespace boxwood::tree {
namespace {

/// Up to here looking back through the ids kept so far beats a hash set.
constexpr std::size_t kShort = 32;

}  // namespace

std::size_t unique_prefix(std::span<std::uint32_t> ids) {
  std::size_t kept = 0;
  if (ids.size() <= kShort) {
    for (const std::uint32_t id : ids) {
      const auto end = ids.begin() + static_cast<std::ptrdiff_t>(kept);
      if (std::find(ids.begin(), end, id) == end) ids[kept++] = id;
    }
    return kept;
  }
  std::unordered_set<std::uint32_t> seen;
  for (const std::uint32_t id : ids)
    if (seen.insert(id).second) ids[kept++] = id;
  return kept;
}

}  // namespace boxwood::tree
