// Where the Edge Volume Heuristic cuts a triangle; what references, counting and subdivision share.
#pragma once

#include <array>

#include "boxwood/refs.h"
#include "refs/crowding.h"

namespace boxwood::refs {

/// A triangle cut `depth` times in two. Corners are numbered: 0 to 2 the triangle's own, then midpoints as they came.
struct TrianglePart {
  std::array<Vec3, 3> corners;
  std::array<std::uint32_t, 3> numbers{0, 1, 2};
  std::uint32_t depth = 0;

  Box bounds() const { return Triangle{corners[0], corners[1], corners[2]}.bounds(); }
};

/// The same for both directions of an edge: addition is commutative and halving exact.
inline Vec3 midpoint(Vec3 a, Vec3 b) {
  return 0.5f * (a + b);
}

/// Stops inputs on which rounding keeps edges long; with room even for t = 30, where edges are halved 10 times.
inline constexpr std::uint32_t kDeepestCut = 64;

/// Which edges are cut. It looks at nothing but the edge itself, so triangles that share one cut it alike.
struct EdgeRule {
  static constexpr std::size_t kNone = 3;

  double threshold = 0;  ///< edges whose box has a larger volume are cut
  /// Counts volume where it is crowded for more, elsewhere for less; null: everywhere alike.
  std::shared_ptr<const Crowding> crowding = {};

  /// Volume of the edge's box; 0 where the edge is not to be cut: it is small enough, or its midpoint is one of its
  /// ends for want of digits.
  double excess(Vec3 a, Vec3 b) const {
    double volume = std::fabs((double(b.x) - a.x) * (double(b.y) - a.y) * (double(b.z) - a.z));
    if (crowding && volume * Crowding::kMost > threshold) volume *= crowding->around({minimum(a, b), maximum(a, b)});
    if (!(volume > threshold)) return 0;
    const Vec3 m = midpoint(a, b);
    return m == a || m == b ? 0 : volume;
  }
  /// The edge from corner i to the next one that is to be cut; kNone: the part stays whole.
  std::size_t edge_to_cut(const TrianglePart& part) const {
    std::size_t edge = kNone;
    double largest = 0;
    for (std::size_t i = 0; i < 3 && part.depth < kDeepestCut; ++i)
      if (const double here = excess(part.corners[i], part.corners[(i + 1) % 3]); here > largest)
        largest = here, edge = i;
    return edge;
  }
};

/// Cuts at the midpoint of the edge of the largest volume until no edge exceeds the threshold. Calls
/// sink.cut(whole, first, second, midpoint) for each cut and sink.part(part) for what is left, depth first, until
/// sink.is_full().
template <class Sink>
void cut_by_edges(const Triangle& triangle, const EdgeRule& rule, Sink& sink) {
  TrianglePart part{{triangle.v0, triangle.v1, triangle.v2}};
  std::size_t edge = rule.edge_to_cut(part);
  if (edge == EdgeRule::kNone) {  // nearly all triangles: spare them the stack
    sink.part(part);
    return;
  }
  std::array<TrianglePart, kDeepestCut + 1> stack;
  std::size_t waiting = 0;
  std::uint32_t next_number = 3;
  for (; !sink.is_full(); edge = rule.edge_to_cut(part)) {
    if (edge == EdgeRule::kNone) {
      sink.part(part);
      if (waiting == 0) return;
      part = stack[--waiting];
      continue;
    }
    const std::size_t end = (edge + 1) % 3;
    const Vec3 middle = midpoint(part.corners[edge], part.corners[end]);
    TrianglePart first = part, second = part;
    first.corners[end] = second.corners[edge] = middle;
    first.numbers[end] = second.numbers[edge] = next_number++;
    first.depth = second.depth = part.depth + 1;
    sink.cut(part, first, second, middle);
    stack[waiting++] = second;
    part = first;
  }
}

/// Log2 of scene volume over threshold, to threshold. 0 for scenes without a volume: nothing can be cut there.
double edge_threshold(const Box& scene, double t);

/// The rule of a pre-split that subdivides, over all references of the set.
EdgeRule make_edge_rule(const ReferenceSet& set, const MeshView& mesh, const Presplit& presplit, Executor& executor,
                        PresplitReport& report);

}  // namespace boxwood::refs
