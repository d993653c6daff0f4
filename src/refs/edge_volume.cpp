// Edge Volume Heuristic (Dammertz and Keller 2008, bib key evh): while the box of a triangle's edge has a larger volume
// than V / 2^t, V that of the scene's box, cut the triangle at the midpoint of the edge whose box is largest. The
// parts' boxes become references; no triangle is made. Variant `auto`, ours: the largest t whose references stay within
// a budget, found by bisection over counting passes.
//
// Ours differs: a midpoint is rounded to floats, so a part is not quite a part of the triangle that rays will meet.
// A corner after n cuts is off by at most n times half a unit in the last place of the triangle's largest coordinate,
// and boxes are padded by that (never past the triangle's own box), so that together they hold the exact triangle.
// Volumes are in double precision, where they neither overflow nor vanish. O(parts), parallel, deterministic.
#include "refs/edge_volume.h"

#include "math/clip.h"
#include "math/rounding.h"
#include "refs/presplit_list.h"
#include "refs/presplit_passes.h"

namespace boxwood::refs {
namespace {

constexpr std::string_view kAutomatic = "evh:auto";
constexpr std::string_view kLocal = "evh:local";
constexpr double kSteps = 16;  // per unit of t, for `auto`

/// The box of a part of a triangle whose box is `whole`, with room for what rounding moved its corners.
Box padded_bounds(const TrianglePart& part, const Box& whole) {
  Box box = part.bounds();
  if (part.depth == 0) return box;
  for (int axis = 0; axis < 3; ++axis) {
    const double largest = std::max(std::fabs(double(whole.lower[axis])), std::fabs(double(whole.upper[axis])));
    const double error = part.depth * (largest * 0x1p-24 + 0x1p-149);
    box.lower[axis] = round_down(box.lower[axis] - error);
    box.upper[axis] = round_up(box.upper[axis] + error);
  }
  return intersection(box, whole);
}

/// Hands parts on as boxes.
template <class Sink>
struct BoxSink {
  Sink& sink;
  Box whole;

  void part(const TrianglePart& part) { sink.part(padded_bounds(part, whole)); }
  void cut(const TrianglePart& part, const TrianglePart& first, const TrianglePart& second, Vec3) {
    sink.cut(part.bounds(), first.bounds(), second.bounds());
  }
  bool is_full() const { return sink.is_full(); }
};

struct EdgeSplitter {
  const MeshView& mesh;
  EdgeRule rule;

  template <class Sink>
  void operator()(const Reference& reference, Sink& sink) const {
    BoxSink<Sink> boxes{sink, reference.box()};
    cut_by_edges(mesh.triangle(reference.primitive), rule, boxes);
  }
};

/// The largest t in steps of 1/16 that makes at most `budget` times as many references.
double fitting_t(const ReferenceSet& set, const MeshView& mesh, const Presplit& presplit, Executor& executor) {
  const auto limit = static_cast<std::size_t>(
      std::min(presplit.value("budget") * static_cast<double>(set.references.size()), double(kMostParts)));
  // The order of cuts does not depend on the threshold, only where they end: more t never makes fewer parts.
  int fits = 0, too_many = static_cast<int>(kSteps * presplit.value("t.most")) + 1;
  while (too_many - fits > 1) {
    const int middle = (fits + too_many) / 2;
    const EdgeSplitter splitter{mesh, {edge_threshold(set.bounds, middle / kSteps), {}}};
    (sum_of(count_parts(set, splitter, executor, limit)) > limit ? too_many : fits) = middle;
  }
  return fits / kSteps;
}

Status split_by_edge_volume(ReferenceSet& set, const MeshView& mesh, const Presplit& presplit, Executor& executor,
                            PresplitReport& report) {
  const EdgeSplitter splitter{mesh, make_edge_rule(set, mesh, presplit, executor, report)};
  return split_references(set, splitter, executor, report);
}

constexpr PresplitOption kOptions[] = {
    {"t", "edges are cut while their box has more than the scene's volume / 2^t", 14, 0, 30}};

constexpr PresplitOption kAutomaticOptions[] = {
    {"budget", "references after over references before, at most", 1.3, 1, 64},
    {"t.most", "t is not raised further, whatever the budget", 16, 0, 30}};

}  // namespace

double edge_threshold(const Box& scene, double t) {
  const double volume = scene.is_empty() ? 0 : box_volume(scene);
  // A flat scene has no volume to take a share of: nothing is cut, whatever rounding leaves of its edges' volumes.
  return volume > 0 ? volume * std::exp2(-t) : double(kInfinity);
}

EdgeRule make_edge_rule(const ReferenceSet& set, const MeshView& mesh, const Presplit& presplit, Executor& executor,
                        PresplitReport& report) {
  report.t = presplit.info->id == kAutomatic ? fitting_t(set, mesh, presplit, executor) : presplit.value("t");
  const double threshold = edge_threshold(set.bounds, report.t);
  report.threshold = std::isfinite(threshold) ? threshold : 0;
  EdgeRule rule{threshold, {}};
  if (presplit.info->id == kLocal) rule.crowding = std::make_shared<const Crowding>(set, executor);
  return rule;
}

constinit const PresplitInfo edge_volume_presplit = {
    .id = "evh",
    .summary = "edge volume heuristic: cuts edges in half while their boxes are larger than a share of the scene's",
    .paper = "evh",
    .options = kOptions,
    .subdivides = true,
    .apply = &split_by_edge_volume,
};

constinit const PresplitInfo automatic_edge_volume_presplit = {
    .id = kAutomatic.data(),
    .summary = "the same with the largest t that stays within a budget of references",
    .paper = "evh",
    .options = kAutomaticOptions,
    .subdivides = true,
    .apply = &split_by_edge_volume,
};

constinit const PresplitInfo local_edge_volume_presplit = {
    .id = kLocal.data(),
    .summary = "the same with volume counting for more where the scene is crowded, for less where it is empty",
    .paper = "evh",
    .options = kOptions,
    .subdivides = true,
    .apply = &split_by_edge_volume,
};

}  // namespace boxwood::refs
