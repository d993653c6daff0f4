// Early split clipping (Ernst and Greiner 2007, bib key ernst2007): while a reference's box has a larger area than the
// scene's box divided by k, cut it at the centre of its longest axis and box what lies on each side. Ours differs: the
// clipping is conservative (refs::Primitives::cut), so no ray is lost between two parts, and parts stop at 48 cuts.
// Areas are in double precision. O(parts), parallel, deterministic.
#include <array>

#include "refs/presplit_list.h"
#include "refs/presplit_passes.h"

namespace boxwood::refs {
namespace {

constexpr std::uint32_t kDeepestCut = 48;

struct AreaSplitter {
  const Primitives& primitives;
  double threshold;

  struct Waiting {
    Reference reference;
    std::uint32_t depth = 0;
  };

  /// False when the part is small enough, or can't be made smaller.
  bool cut(const Waiting& part, Box& left, Box& right) const {
    const Box box = part.reference.box();
    if (part.depth >= kDeepestCut || !(box_area(box) > threshold)) return false;
    const int axis = box.widest_axis();
    const float position = box.center()[axis];
    if (!(position > box.lower[axis] && position < box.upper[axis])) return false;
    primitives.cut(part.reference, axis, position, left, right);
    return true;
  }

  template <class Sink>
  void operator()(const Reference& reference, Sink& sink) const {
    if (!(box_area(reference.box()) > threshold)) {  // nearly all: spare them the stack
      sink.part(reference.box());
      return;
    }
    std::array<Waiting, kDeepestCut + 1> stack;
    std::size_t waiting = 0;
    stack[waiting++] = {reference};
    while (waiting > 0 && !sink.is_full()) {
      const Waiting part = stack[--waiting];
      Box left, right;
      if (!cut(part, left, right)) {
        sink.part(part.reference.box());
        continue;
      }
      if (!left.is_empty() && !right.is_empty()) sink.cut(part.reference.box(), left, right);
      for (const Box& side : {right, left})  // the left one is on top
        if (!side.is_empty()) stack[waiting++] = {{side.lower, reference.primitive, side.upper, 0}, part.depth + 1};
    }
  }
};

Status split_by_area(ReferenceSet& set, const MeshView&, const Presplit& presplit, Executor& executor,
                     PresplitReport& report) {
  const double area = set.bounds.is_empty() ? 0 : box_area(set.bounds);
  report.threshold = area / presplit.value("k");
  // A scene that is a point or a line has no area, and nothing there can be cut to advantage.
  const AreaSplitter splitter{*set.primitives, area > 0 ? report.threshold : double(kInfinity)};
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
