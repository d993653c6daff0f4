// The plane sweep of spatial splits (Popov, Georgiev, Dimov and Slusallek 2009, section 5; bib key popov2009) over the
// events of KD trees (Wald and Havran 2006, wald2006), with their tight boxes and planes between events (5.2) as
// options. Counts left, right and both are updated along each axis; boxes flat in the plane go where it is cheaper.
//
// Ours differs from 5.2: references leave the queue once they cannot widen a side's box any more, no more than some
// dozen are cut at each event, and the minimum between two events is looked for only where a bound (the smaller left
// and the smaller right box of both ends) is below the best cost, by parabolas through exact costs.
#include "builders/parts/plane_sweep.h"

#include <algorithm>
#include <array>

#include "builders/parts/area_scale.h"
#include "builders/parts/plane_events.h"
#include "builders/parts/side_box.h"

namespace boxwood::builders {
namespace {

/// What lies on both sides of a plane.
struct Counts {
  std::size_t left, right;
};

/// Keeps the cheapest plane of one axis.
class Chooser {
 public:
  Chooser(const SweepInput& input, int axis) : input_(input) {
    result_.best.axis = -1;
    axis_ = axis;
  }

  void offer(float position, bool flat_left, const Counts& counts, double left_area, double right_area) {
    double cost = left_area * static_cast<double>(counts.left) + right_area * static_cast<double>(counts.right);
    if (counts.left == 0 || counts.right == 0) {
      const bool inside = input_.region.lower[axis_] < position && position < input_.region.upper[axis_];
      if (!inside || !(input_.empty_factor < 1)) return;
      cost *= input_.empty_factor;
    }
    if (!(cost < result_.best.cost)) return;
    if (counts.left + counts.right - input_.references.size() > input_.spare) {
      cheapest_overrun_ = std::min(cheapest_overrun_, cost);
      return;
    }
    result_.best = {axis_, position, flat_left, counts.left, counts.right, cost};
  }

  double best_cost() const { return result_.best.cost; }
  SweepResult result() const {
    SweepResult result = result_;
    result.overrun = cheapest_overrun_ < result.best.cost;
    return result;
  }

 private:
  const SweepInput& input_;
  int axis_;
  SweepResult result_;
  double cheapest_overrun_ = kInfinity;
};

/// Areas of a part of the region as functions of the part's length on one axis.
class RegionArea {
 public:
  RegionArea(const Box& region, int axis, float scale) : scale_(scale) {
    const Vec3 extent = region.extent() * scale;
    const double u = extent[(axis + 1) % 3], v = extent[(axis + 2) % 3];
    across_ = u * v;
    around_ = u + v;
  }
  double operator()(float length) const { return across_ + around_ * static_cast<double>(length * scale_); }

 private:
  float scale_;
  double across_, around_;
};

/// One axis of one sweep.
class AxisSweep {
 public:
  AxisSweep(const SweepInput& input, const AxisEvents& events, int axis)
      : input_(input), events_(events), axis_(axis), chooser_(input, axis) {}

  SweepResult run() {
    if (input_.areas == SideAreas::region) {
      sweep_region();
    } else {
      sweep_tight();
      if (input_.areas == SideAreas::between) search_between();
    }
    return chooser_.result();
  }

 private:
  struct Stop : PlaneStop {
    Box left, right;  ///< tight boxes without what is flat here
    Box flat;         ///< what is flat here
  };

  /// Without what is flat in the plane.
  Counts counts(const PlaneStop& stop) const {
    return {stop.begins + stop.flats, events_.ends.size() - stop.ends_to + events_.flats.size() - stop.flats_to};
  }

  void sweep_region() {
    const RegionArea area(input_.region, axis_, input_.area_scale);
    const float lower = input_.region.lower[axis_], upper = input_.region.upper[axis_];
    for_each_stop(events_, [&](const PlaneStop& stop) {
      const Counts here = counts(stop);
      const std::size_t flat = stop.flats_to - stop.flats;
      const double left = area(stop.position - lower), right = area(upper - stop.position);
      chooser_.offer(stop.position, true, {here.left + flat, here.right}, left, right);
      if (flat != 0) chooser_.offer(stop.position, false, {here.left, here.right + flat}, left, right);
    });
  }

  void sweep_tight() {
    for_each_stop(events_, [&](const PlaneStop& stop) { stops_.push_back({stop, {}, {}, {}}); });
    SideBox left(input_.primitives, axis_, true);
    for (Stop& stop : stops_) {
      for (std::uint32_t i = stop.ends; i < stop.ends_to; ++i) left.add(reference(events_.ends[i]));
      left.move_to(stop.position);
      stop.left = left.at(stop.position, stop.begins > stop.ends_to);
      for (std::uint32_t i = stop.flats; i < stop.flats_to; ++i) stop.flat.grow(reference(events_.flats[i]).box());
      for (std::uint32_t i = stop.flats; i < stop.flats_to; ++i) left.add(reference(events_.flats[i]));
      for (std::uint32_t i = stop.begins; i < stop.begins_to; ++i) left.begin(reference(events_.begins[i]));
    }
    SideBox right(input_.primitives, axis_, false);
    for (std::size_t k = stops_.size(); k-- > 0;) {
      Stop& stop = stops_[k];
      for (std::uint32_t i = stop.begins; i < stop.begins_to; ++i) right.add(reference(events_.begins[i]));
      right.move_to(stop.position);
      stop.right = right.at(stop.position, stop.begins > stop.ends_to);
      for (std::uint32_t i = stop.flats; i < stop.flats_to; ++i) right.add(reference(events_.flats[i]));
      for (std::uint32_t i = stop.ends; i < stop.ends_to; ++i) right.begin(reference(events_.ends[i]));
    }
    for (const Stop& stop : stops_) {
      const Counts here = counts(stop);
      const std::size_t flat = stop.flats_to - stop.flats;
      chooser_.offer(stop.position, true, {here.left + flat, here.right}, area(merge(stop.left, stop.flat)),
                     area(stop.right));
      if (flat != 0)
        chooser_.offer(stop.position, false, {here.left, here.right + flat}, area(stop.left),
                       area(merge(stop.right, stop.flat)));
    }
  }

  /// Between stops k and k + 1.
  struct Gap {
    double bound;
    std::size_t k;
  };

  void search_between() {
    std::vector<Gap> gaps;
    for (std::size_t k = 0; k + 1 < stops_.size(); ++k) {
      const Stop &from = stops_[k], &to = stops_[k + 1];
      if (from.begins_to == to.ends) continue;  // the plane would cut nothing
      const Counts here = between(k);
      const double bound = area(merge(from.left, from.flat)) * static_cast<double>(here.left) +
                           area(merge(to.right, to.flat)) * static_cast<double>(here.right);
      if (bound < chooser_.best_cost()) gaps.push_back({bound, k});
    }
    std::stable_sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.bound < b.bound; });
    for (std::size_t i = 0; i < gaps.size() && i < kMostGaps && gaps[i].bound < chooser_.best_cost(); ++i)
      search_gap(gaps[i].k);
  }

  Counts between(std::size_t k) const {
    const Stop& from = stops_[k];
    return {from.begins_to + from.flats_to, events_.ends.size() - from.ends_to + events_.flats.size() - from.flats_to};
  }

  /// The cost is a parabola in the position where no corner is passed: three costs tell its lowest place.
  void search_gap(std::size_t k) {
    const double from = stops_[k].position, to = stops_[k + 1].position;
    const double middle = 0.5 * (from + to), quarter = 0.25 * (to - from);
    double low = offer_between(k, middle - quarter), centre = offer_between(k, middle),
           high = offer_between(k, middle + quarter);
    double step = quarter, at = middle;
    for (int round = 0; round < kParabolas; ++round) {
      const double bend = low - 2 * centre + high;
      if (!(bend > 0)) return;
      const double shift = std::clamp(0.5 * (low - high) / bend, -1.5, 1.5);
      at += shift * step;
      step *= 0.5;
      low = offer_between(k, at - step), centre = offer_between(k, at), high = offer_between(k, at + step);
    }
  }

  /// Offers the plane and returns its cost; infinite outside the gap.
  double offer_between(std::size_t k, double at) {
    const auto position = static_cast<float>(at);
    if (!(stops_[k].position < position && position < stops_[k + 1].position)) return kInfinity;
    Box left, right;
    for (const refs::Reference& reference : input_.references) {
      if (reference.upper[axis_] <= position) {
        left.grow(reference.box());
      } else if (reference.lower[axis_] >= position) {
        right.grow(reference.box());
      } else {
        Box below, above;
        input_.primitives.cut(reference, axis_, position, below, above);
        left.grow(below), right.grow(above);
      }
    }
    const Counts here = between(k);
    const double left_area = area(left), right_area = area(right);
    chooser_.offer(position, true, here, left_area, right_area);
    return left_area * static_cast<double>(here.left) + right_area * static_cast<double>(here.right);
  }

  const refs::Reference& reference(PlaneEvent event) const { return input_.references[event.reference()]; }
  double area(const Box& box) const { return scaled_half_area(box, input_.area_scale); }

  static constexpr std::size_t kMostGaps = 4;
  static constexpr int kParabolas = 2;

  const SweepInput& input_;
  const AxisEvents& events_;
  int axis_;
  Chooser chooser_;
  std::vector<Stop> stops_;
};

}  // namespace

SweepResult sweep_planes(const SweepInput& input, Executor& executor) {
  AxisEvents events[3];
  make_events(input.references, executor, events);
  SweepResult results[3];
  executor.for_chunks(3, 1, [&](std::size_t axis, std::size_t, std::size_t) {
    results[axis] = AxisSweep(input, events[axis], static_cast<int>(axis)).run();
  });
  SweepResult best = results[0];
  bool overrun[3] = {results[0].overrun, results[1].overrun, results[2].overrun};
  for (int axis = 1; axis < 3; ++axis)
    if (results[axis].best.cost < best.best.cost) best = results[axis];
  best.overrun = overrun[0] || overrun[1] || overrun[2];
  return best;
}

}  // namespace boxwood::builders
