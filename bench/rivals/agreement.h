// Do two programs give the same hits, and where they do not, which of them is right? Brute force in double precision
// over the whole mesh decides.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "boxwood/mesh.h"
#include "boxwood/parallel.h"
#include "boxwood/queries.h"

namespace boxwood::rivals {

/// Two distances that single precision can't tell apart: 1e-5, relative.
bool close(double a, double b);

/// How one set of answers compares with another's.
struct Verdicts {
  std::size_t rays = 0, hits = 0;  ///< hits: ours
  std::size_t differences = 0;
  // Of these, as far as `judged` goes:
  std::size_t judged = 0;
  std::size_t ours_right = 0;  ///< brute force sides with ours alone
  std::size_t both = 0;        ///< with both: two triangles at one distance
  std::size_t border = 0;      ///< the ray passes a triangle's border nearer than roundings of coordinates
  std::size_t wrong = 0;       ///< ours contradicts a clear verdict
  std::string first_wrong;     ///< a sentence about the first of them
};

/// Closest hits agree when both miss, name one triangle, or their t are close. At most `most_judged` of the differences
/// go to brute force, each of which takes time linear in the mesh.
Verdicts compare_closest(const MeshView& mesh, std::span<const Ray> rays, std::span<const Hit> ours,
                         std::span<const Hit> theirs, Executor& executor, std::size_t most_judged = SIZE_MAX);

/// Any hits agree when both say yes or both say no. `our_hit` gives the closest hit of a ray, to look how near to a
/// border it is.
Verdicts compare_any(const MeshView& mesh, std::span<const Ray> rays, std::span<const std::uint8_t> ours,
                     std::span<const std::uint8_t> theirs, const std::function<Hit(const Ray&)>& our_hit,
                     Executor& executor, std::size_t most_judged = SIZE_MAX);

}  // namespace boxwood::rivals
