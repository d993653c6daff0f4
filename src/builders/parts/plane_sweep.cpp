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
  Chooser(const SweepInput& input, int axis) : input_(input), axis_(axis) {}

  void offer(float position, bool flat_left, const Counts& counts, double left_area, double right_area) {
    double cost = left_area * static_cast<double>(counts.left) + right_area * static_cast<double>(counts.right);
    if (counts.left == 0 || counts.right == 0) {
      const bool inside = input_.region.lower[axis_] < position && position < input_.region.upper[axis_];
      if (!inside || !input_.empty_sides) return;
      cost *= input_.empty_factor;
    }
    if (!(cost < result_.best.cost)) return;
    if (counts.left + counts.right - input_.references.size() > input_.spare) {
      result_.overrun_cost = std::min(result_.overrun_cost, cost);
      return;
    }
    result_.best = {axis_, position, flat_left, counts.left, counts.right, cost};
  }

  double best_cost() const { return result_.best.cost; }
  const SweepResult& result() const { return result_; }

 private:
  const SweepInput& input_;
  int axis_;
  SweepResult result_;
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
  /// With the areas of both sides' boxes, without [0] and with [1] what is flat in the plane.
  struct Stop : PlaneStop {
    float left[2], right[2];
    double most_cost = 0;  ///< what it costs at most, as long as its areas are not exact
    bool exact = false;
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

  /// Cutting is slow, so it is done only at stops that may be the best one: those that cost less with boxes of whole
  /// references only than the best one does with uncut boxes of the cut ones.
  void sweep_tight() {
    for_each_stop(events_, [&](const PlaneStop& stop) { stops_.push_back({stop, {}, {}}); });
    add_most_costs();
    double limit = kInfinity;
    for (const Stop& stop : stops_)
      if (may_be_taken(stop)) limit = std::min(limit, stop.most_cost);
    walk_up(
        WholeBox(axis_, true, false), [](const Stop&) { return true; }, &Stop::left);
    walk_down(
        WholeBox(axis_, false, false), [](const Stop&) { return true; }, &Stop::right);
    for (Stop& stop : stops_) stop.exact = least_cost(stop) <= limit;
    const auto is_wanted = [](const Stop& stop) { return stop.exact; };
    walk_up(SideBox(input_.primitives, axis_, true), is_wanted, &Stop::left);
    walk_down(SideBox(input_.primitives, axis_, false), is_wanted, &Stop::right);
    for (const Stop& stop : stops_) {
      if (!stop.exact) continue;
      const Counts here = counts(stop);
      const std::size_t flat = stop.flats_to - stop.flats;
      chooser_.offer(stop.position, true, {here.left + flat, here.right}, stop.left[1], stop.right[0]);
      if (flat != 0) chooser_.offer(stop.position, false, {here.left, here.right + flat}, stop.left[0], stop.right[1]);
    }
  }

  void add_most_costs() {
    const auto all = [](const Stop&) { return true; };
    walk_up(WholeBox(axis_, true, true), all, &Stop::left);
    walk_down(WholeBox(axis_, false, true), all, &Stop::right);
    for (Stop& stop : stops_) stop.most_cost = least_cost(stop);
  }

  /// Does the plane leave something on both sides, without adding too much?
  bool may_be_taken(const Stop& stop) const {
    const Counts here = counts(stop);
    const std::size_t flat = stop.flats_to - stop.flats;
    return here.left != 0 && here.right != 0 &&
           here.left + here.right + flat - input_.references.size() <= input_.spare;
  }

  /// By the areas as they are, with flat boxes on the cheaper side.
  double least_cost(const Stop& stop) const {
    const Counts here = counts(stop);
    const auto left = static_cast<double>(here.left), right = static_cast<double>(here.right);
    const auto flat = static_cast<double>(stop.flats_to - stop.flats);
    return std::min(stop.left[1] * (left + flat) + stop.right[0] * right,
                    stop.left[0] * left + stop.right[1] * (right + flat));
  }

  /// Sweeps up with a box of the side below the plane, and stores its areas at the wanted stops.
  template <class Side, class Wanted>
  void walk_up(Side side, Wanted is_wanted, float (Stop::*areas)[2]) {
    for (Stop& stop : stops_) {
      for (std::uint32_t i = stop.ends; i < stop.ends_to; ++i) side.add(reference(events_.ends[i]));
      if (is_wanted(stop)) (stop.*areas)[0] = side_area(side, stop);
      for (std::uint32_t i = stop.flats; i < stop.flats_to; ++i) side.add(reference(events_.flats[i]));
      if (is_wanted(stop)) (stop.*areas)[1] = area(side.at(stop.position, cuts(stop)));
      for (std::uint32_t i = stop.begins; i < stop.begins_to; ++i) side.begin(reference(events_.begins[i]));
    }
  }

  /// The same for the side above, sweeping down.
  template <class Side, class Wanted>
  void walk_down(Side side, Wanted is_wanted, float (Stop::*areas)[2]) {
    for (std::size_t k = stops_.size(); k-- > 0;) {
      Stop& stop = stops_[k];
      for (std::uint32_t i = stop.begins; i < stop.begins_to; ++i) side.add(reference(events_.begins[i]));
      if (is_wanted(stop)) (stop.*areas)[0] = side_area(side, stop);
      for (std::uint32_t i = stop.flats; i < stop.flats_to; ++i) side.add(reference(events_.flats[i]));
      if (is_wanted(stop)) (stop.*areas)[1] = area(side.at(stop.position, cuts(stop)));
      for (std::uint32_t i = stop.ends; i < stop.ends_to; ++i) side.begin(reference(events_.ends[i]));
    }
  }

  static bool cuts(const PlaneStop& stop) { return stop.begins > stop.ends_to; }
  template <class Side>
  float side_area(Side& side, const PlaneStop& stop) const {
    side.move_to(stop.position);
    return area(side.at(stop.position, cuts(stop)));
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
      const double bound =
          from.left[1] * static_cast<double>(here.left) + to.right[1] * static_cast<double>(here.right);
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
  float area(const Box& box) const { return scaled_half_area(box, input_.area_scale); }

  static constexpr std::size_t kMostGaps = 2;
  static constexpr int kParabolas = 1;

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
  SweepResult all;
  for (const SweepResult& result : results) {
    if (result.best.cost < all.best.cost) all.best = result.best;
    all.overrun_cost = std::min(all.overrun_cost, result.overrun_cost);
  }
  return all;
}

}  // namespace boxwood::builders
