// Pre-splits with a budget, spent where boxes are loosest: after Karras and Aila 2013 (bib key karras2013). A
// reference's priority is the cube root of e^2 * (A - A'), e the longest side of its box, A the box's area and A' what
// the areas of ever smaller boxes around the triangle tend to: the sum of its projections along the axes. Each
// reference is cut floor(D * priority) times, with the largest D that keeps within the budget, found by bisection over
// the priorities. It is cut by the coarsest plane of a grid over the scene that its box crosses, so that neighbours are
// cut by the same planes, and the further cuts are shared out by the longest sides of the parts.
//
// Ours differs: D is also limited so that only references of a multiple (`loose`) of the mean priority are cut at all.
// Where triangles are much alike, as in scans, nothing is worth cutting, and nothing is cut. The grid has cubic cells.
// O(references + parts * log), parallel, deterministic.
#include <bit>
#include <cmath>

#include "refs/presplit_list.h"
#include "refs/presplit_passes.h"

namespace boxwood::refs {
namespace {

constexpr std::size_t kMostCuts = 1 << 10;  // of one reference
constexpr int kGridBits = 20;

/// Planes that halve a cube around the scene, halve the halves, and so on.
class Grid {
 public:
  explicit Grid(const Box& scene) : origin_(scene.lower) {
    const double longest = scene.is_empty() ? 0 : double(scene.extent()[scene.widest_axis()]);
    cell_ = longest > 0 ? std::ldexp(longest, -kGridBits) * (1 + 0x1p-20) : 1;
  }

  struct Plane {
    int axis = -1;  ///< -1: the box is in one cell
    float position = 0;
  };

  /// The coarsest plane inside the box; of equally coarse ones that on the longest side.
  Plane coarsest(const Box& box) const {
    Plane plane;
    int level = 0;
    float length = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t first = cell(axis, box.lower[axis]), last = cell(axis, box.upper[axis]);
      const int here = std::bit_width(first ^ last);  // 0: in one cell
      const float extent = box.upper[axis] - box.lower[axis];
      if (here == 0 || here < level || (here == level && !(extent > length))) continue;
      const std::uint32_t border = last >> (here - 1) << (here - 1);
      const float position = static_cast<float>(double(origin_[axis]) + cell_ * border);
      if (!(position > box.lower[axis] && position < box.upper[axis])) continue;
      plane = {axis, position};
      level = here, length = extent;
    }
    return plane;
  }

 private:
  std::uint32_t cell(int axis, float position) const {
    const double at = (double(position) - origin_[axis]) / cell_;
    return static_cast<std::uint32_t>(std::min(std::max(at, 0.0), std::ldexp(1.0, kGridBits) - 1));
  }

  Vec3 origin_;
  double cell_ = 1;
};

/// How much a reference wants to be cut, in units of length^(4/3); 0: not at all.
double priority_of(const Box& box, const Triangle& triangle) {
  double a[3], b[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = double(triangle.v1[k]) - triangle.v0[k];
    b[k] = double(triangle.v2[k]) - triangle.v0[k];
  }
  const double least = std::fabs(a[1] * b[2] - a[2] * b[1]) + std::fabs(a[2] * b[0] - a[0] * b[2]) +
                       std::fabs(a[0] * b[1] - a[1] * b[0]);
  const double longest = double(box.extent()[box.widest_axis()]);
  return std::cbrt(longest * longest * std::max(box_area(box) - least, 0.0));
}

/// The priority of a box as large as the scene: others are taken against it, so that none overflows or vanishes.
double scene_priority(const Box& scene) {
  const double longest = scene.is_empty() ? 0 : double(scene.extent()[scene.widest_axis()]);
  return longest > 0 ? std::pow(longest, 4.0 / 3) : 1;
}

float relative_priority(const Reference& reference, const MeshView& mesh, double scene) {
  return static_cast<float>(priority_of(reference.box(), mesh.triangle(reference.primitive)) / scene);
}

std::size_t cuts_of(float priority, double cuts_per_priority) {
  return static_cast<std::size_t>(std::min(double(priority) * cuts_per_priority, double(kMostCuts)));
}

struct PrioritySplitter {
  const Primitives& primitives;
  const MeshView& mesh;
  Grid grid;
  double scene;  ///< see scene_priority
  double cuts_per_priority;

  struct Waiting {
    Reference reference;
    std::size_t cuts = 0;
  };

  template <class Sink>
  void operator()(const Reference& reference, Sink& sink) const {
    const std::size_t cuts = cuts_of(relative_priority(reference, mesh, scene), cuts_per_priority);
    if (cuts == 0) {  // nearly all: spare them the stack
      sink.part(reference.box());
      return;
    }
    std::vector<Waiting> stack{{reference, cuts}};
    while (!stack.empty() && !sink.is_full()) {
      const Waiting part = stack.back();
      stack.pop_back();
      const Box box = part.reference.box();
      const Grid::Plane plane = part.cuts > 0 ? grid.coarsest(box) : Grid::Plane{};
      if (plane.axis < 0) {
        sink.part(box);
        continue;
      }
      Box left, right;
      primitives.cut(part.reference, plane.axis, plane.position, left, right);
      const bool both = !left.is_empty() && !right.is_empty();
      if (both) sink.cut(box, left, right);
      // A side without anything takes no cut: the other goes on with all that are left but one, so that this ends.
      const std::size_t rest = part.cuts - 1;
      const double left_length = both ? double(left.extent()[left.widest_axis()]) : double(!left.is_empty());
      const double right_length = both ? double(right.extent()[right.widest_axis()]) : double(!right.is_empty());
      const double length = left_length + right_length;
      const double share = length > 0 ? left_length / length : 0.5;
      const auto to_left = std::min(rest, static_cast<std::size_t>(static_cast<double>(rest) * share + 0.5));
      if (!right.is_empty()) stack.push_back({{right.lower, reference.primitive, right.upper, 0}, rest - to_left});
      if (!left.is_empty()) stack.push_back({{left.lower, reference.primitive, left.upper, 0}, to_left});
    }
  }
};

struct Priorities {
  std::vector<float> of;  ///< each reference
  double sum = 0;
};

Priorities find_priorities(const ReferenceSet& set, const MeshView& mesh, double scene, Executor& executor) {
  Priorities priorities;
  priorities.of.resize(set.references.size());
  std::vector<double> sums((set.references.size() + kPresplitChunk - 1) / kPresplitChunk);
  executor.for_chunks(set.references.size(), kPresplitChunk,
                      [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                        for (std::size_t i = begin; i < end; ++i) {
                          priorities.of[i] = relative_priority(set.references[i], mesh, scene);
                          sums[chunk] += double(priorities.of[i]);
                        }
                      });
  for (const double sum : sums) priorities.sum += sum;
  return priorities;
}

/// The largest number of cuts per priority that stays within `most` and makes no more than `budget` cuts.
double fitting_cuts(const Priorities& priorities, double most, std::size_t budget, Executor& executor) {
  std::vector<std::size_t> counts((priorities.of.size() + kPresplitChunk - 1) / kPresplitChunk);
  const auto cuts = [&](double per_priority) {
    executor.for_chunks(priorities.of.size(), kPresplitChunk,
                        [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                          counts[chunk] = 0;
                          for (std::size_t i = begin; i < end; ++i)
                            counts[chunk] += cuts_of(priorities.of[i], per_priority);
                        });
    return sum_of(counts);
  };
  if (cuts(most) <= budget) return most;
  double fits = 0, too_many = most;
  for (int step = 0; step < 24; ++step) {
    const double middle = 0.5 * (fits + too_many);
    (cuts(middle) > budget ? too_many : fits) = middle;
  }
  return fits;
}

Status split_by_priority(ReferenceSet& set, const MeshView& mesh, const Presplit& presplit, Executor& executor,
                         PresplitReport& report) {
  const double scene = scene_priority(set.bounds);
  const Priorities priorities = find_priorities(set, mesh, scene, executor);
  const auto count = static_cast<double>(set.references.size());
  const auto budget = static_cast<std::size_t>(std::min((presplit.value("budget") - 1) * count, double(kMostParts)));
  const double mean = priorities.sum / std::max(count, 1.0);
  const double most = mean > 0 ? 1 / (presplit.value("loose") * mean) : 0;
  const double cuts = fitting_cuts(priorities, most, budget, executor);
  return split_references(set, PrioritySplitter{*set.primitives, mesh, Grid(set.bounds), scene, cuts}, executor,
                          report);
}

constexpr PresplitOption kOptions[] = {
    {"budget", "references after over references before, at most", 1.3, 1, 64},
    {"loose", "only references of so many times the mean priority are cut", 4, 0.01, 1000}};

}  // namespace

constinit const PresplitInfo priority_presplit = {
    .id = "priority",
    .summary = "cuts the loosest boxes at the planes of a grid within a budget of references; best for mixed scenes",
    .paper = "karras2013",
    .options = kOptions,
    .subdivides = false,
    .apply = &split_by_priority,
};

}  // namespace boxwood::refs
