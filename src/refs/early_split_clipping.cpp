// Early split clipping (Ernst and Greiner 2007, bib key ernst2007): while a reference's box has a larger area than the
// scene's box divided by k, cut it at the centre of its longest axis and box what lies on each side. Ours differs: the
// clipping is conservative (refs::Primitives::cut), so no ray is lost between two parts. Areas are in double precision.
// O(parts), parallel, deterministic.
#include "refs/plane_splitter.h"
#include "refs/presplit_list.h"

namespace boxwood::refs {
namespace {

struct Area {
  static double of(const Box& box) { return box_area(box); }
};

Status split_by_area(ReferenceSet& set, const MeshView&, const Presplit& presplit, Executor& executor,
                     PresplitReport& report) {
  const double area = set.bounds.is_empty() ? 0 : box_area(set.bounds);
  report.threshold = area / presplit.value("k");
  // A scene that is a point or a line has no area, and nothing there can be cut to advantage.
  const PlaneSplitter<Area> splitter{*set.primitives, area > 0 ? report.threshold : double(kInfinity)};
  return split_references(set, splitter, executor, report);
}

constexpr PresplitOption kOptions[] = {
    {"k", "boxes are cut while they have more than the area of the scene's box / k", 1000, 1, 1e9}};

}  // namespace

constinit const PresplitInfo early_split_clipping_presplit = {
    .id = "esc",
    .summary =
        "early split clipping: halves boxes on their longest axis while they are larger than a share of the "
        "scene's area",
    .paper = "ernst2007",
    .options = kOptions,
    .subdivides = false,
    .apply = &split_by_area,
};

}  // namespace boxwood::refs
