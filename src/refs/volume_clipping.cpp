// Volume clipping, ours: the stop of the Edge Volume Heuristic (Dammertz and Keller 2008, bib key evh) with the cuts of
// early split clipping (Ernst and Greiner 2007, bib key ernst2007). While a reference's box has a larger volume than
// V / 2^t, V that of the scene's box, cut it at the centre of its longest axis and box what lies on each side. Like the
// former it leaves flat boxes alone, so geometry along the axes costs nothing; like the latter its parts touch only in
// a plane, where the halves of an edge cut overlap. Volumes are in double precision. O(parts), parallel, deterministic.
#include "refs/edge_volume.h"
#include "refs/plane_splitter.h"
#include "refs/presplit_list.h"

namespace boxwood::refs {
namespace {

struct Volume {
  static double of(const Box& box) { return box_volume(box); }
};

Status split_by_volume(ReferenceSet& set, const MeshView&, const Presplit& presplit, Executor& executor,
                       PresplitReport& report) {
  const double threshold = volume_threshold(set.bounds, presplit.value("t"));
  report.t = presplit.value("t");
  report.threshold = std::isfinite(threshold) ? threshold : 0;
  return split_references(set, PlaneSplitter<Volume>{*set.primitives, threshold}, executor, report);
}

constexpr PresplitOption kOptions[] = {
    {"t", "boxes are cut while they have more than the scene's volume / 2^t", 14, 0, 30}};

}  // namespace

constinit const PresplitInfo volume_clipping_presplit = {
    .id = "evh:clip",
    .summary =
        "halves boxes on their longest axis while their volume is larger than a share of the scene's; best of "
        "these for turned architecture",
    .paper = "evh, ernst2007",
    .options = kOptions,
    .subdivides = false,
    .apply = &split_by_volume,
};

}  // namespace boxwood::refs
