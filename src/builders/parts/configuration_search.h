// The cheapest configuration of each of the 2^5 ways in which two boxes can share the sides of their parent's box
// (Popov et al. 2009, bib key popov2009, sections 3 and 4).
//
// Each side of the node belongs to the left or the right child, and the other child's side there is a free plane: six
// free planes. Boxes that fail to cover all references still do so when they shrink, so axes are fixed one by one, from
// wide to narrow, and a failure ends the loop over what is narrower. What is left is priced by eq. (5).
#pragma once

#include <array>

#include "boxwood/parallel.h"
#include "builders/parts/counting_table.h"

namespace boxwood::builders {

/// Ranges of more references than this are searched by several threads: a search costs far more than the sweeps that
/// kLargeRange is for.
inline constexpr std::size_t kLargeSearch = 1 << 12;

/// How configurations are priced, and which are allowed.
struct ConfigurationPrice {
  float area_scale = 1;
  double overlap = 0;       ///< C_O
  bool may_split = false;   ///< may references be split?
  std::uint64_t spare = 0;  ///< so many at most

  /// The factor of eq. (5).
  double penalty(const Box& left, const Box& right, const Box& node) const {
    return overlap > 0 ? 1 + overlap * overlap_share(left, right, node) : 1;
  }
};

struct PricedConfiguration {
  double cost = std::numeric_limits<double>::infinity();  ///< area * count of both sides, added, times the penalty
  Configuration boxes;
  /// The least cost of those that split more references than is allowed.
  double refused = std::numeric_limits<double>::infinity();
};

/// The counter gives SideCounts to two PlaneBoxes: a CountingTable or a CountingTree.
template <class Counter>
class ConfigurationSearch {
 public:
  static constexpr int kPatterns = 32;

  ConfigurationSearch(const Box& node, std::uint32_t references, const CandidatePlanes& planes, const Counter& counter,
                      const ConfigurationPrice& price)
      : references_(references), planes_(planes), counter_(counter), price_(price) {
    Box thinnest{{0, 0, 0}, {0, 0, 0}};
    for (int axis = 0; axis < 3; ++axis) {
      const float whole = node.upper[axis] - node.lower[axis];
      float& thin = thinnest.upper[axis] = planes.flat_boxes ? 0 : whole;
      for (std::size_t i = 1; i < planes.lower[axis].size() && !planes.flat_boxes; ++i)
        thin = std::min(thin, planes.lower[axis][i] - planes.lower[axis][i - 1]);
      thin_[axis] = whole > 0 ? static_cast<double>(thin) / static_cast<double>(whole) : 1;
    }
    least_area_ = scaled_half_area(thinnest, price.area_scale);
  }

  /// The cheapest configuration of each pattern, in order; cost infinity where none is below `limit`.
  std::array<PricedConfiguration, kPatterns> run(double limit, Executor& executor) const {
    std::array<PricedConfiguration, kPatterns> best;
    executor.for_chunks(kPatterns, 1, [&](std::size_t pattern, std::size_t, std::size_t) {
      best[pattern] = search(static_cast<int>(pattern), limit);
    });
    return best;
  }

 private:
  struct State {
    PlaneBox left, right;
    double limit;
    double share[2] = {};  ///< of the node's extent that both children have: on the first axis, the first two
    PricedConfiguration best;
  };

  /// Does one child have both of the node's sides, so that the other is inside it on the axis?
  static bool is_nested(int owner) { return owner == 0 || owner == 3; }

  double axis_share(const State& state, int axis) const {
    const auto at = [&](const std::vector<float>& planes, std::int32_t i) {
      return static_cast<double>(planes[static_cast<std::size_t>(i)]);
    };
    const double shared = at(planes_.upper[axis], std::min(state.left.upper[axis], state.right.upper[axis])) -
                          at(planes_.lower[axis], std::max(state.left.lower[axis], state.right.lower[axis]));
    const double whole =
        at(planes_.upper[axis], static_cast<std::int32_t>(planes_.upper[axis].size()) - 1) - at(planes_.lower[axis], 0);
    return whole > 0 ? std::max(shared, 0.0) / whole : shared < 0 ? 0 : 1;
  }

  /// True when no children that share at least this part of the node can be the best, however small they are.
  bool costs_too_much(const State& state, double least_share) const {
    return price_.overlap > 0 &&
           !((1 + price_.overlap * least_share) * least_area_ * references_ < std::min(state.limit, state.best.cost));
  }

  void widen(State& state, int axis) const {
    const auto last = static_cast<std::int32_t>(planes_.upper[axis].size()) - 1;
    state.left.lower[axis] = state.right.lower[axis] = 0;
    state.left.upper[axis] = state.right.upper[axis] = last;
  }

  PricedConfiguration search(int pattern, double limit) const {
    // By axis: bit 0, the left child has the node's lower side; bit 1, it has the upper one. Exchanged children are
    // the same configuration, so the left one always has the lower side of the first axis.
    const int owner[3] = {1 | (pattern & 1) << 1, pattern >> 1 & 3, pattern >> 3 & 3};
    State state{.left = {}, .right = {}, .limit = limit, .best = {}};
    for (int axis = 0; axis < 3; ++axis) widen(state, axis);
    const auto covered = [&] { return counter_.count(state.left, state.right, price_.may_split).covered; };
    for_pairs(state, 0, owner[0], [&] {
      if (!covered()) return false;
      state.share[0] = axis_share(state, 0);
      if (is_nested(owner[1]) && is_nested(owner[2]) && costs_too_much(state, state.share[0] * thin_[1] * thin_[2]))
        return true;
      for_pairs(state, 1, owner[1], [&] {
        if (!covered()) return false;
        state.share[1] = state.share[0] * axis_share(state, 1);
        if (is_nested(owner[2]) && costs_too_much(state, state.share[1] * thin_[2])) return true;
        for_pairs(state, 2, owner[2], [&] { return consider(state); });
        return true;
      });
      return true;
    });
    return state.best;
  }

  /// Calls f for all pairs of free planes of an axis, wide boxes first; f says whether narrower boxes are worth a look.
  template <class F>
  void for_pairs(State& state, int axis, int owner, const F& f) const {
    const std::vector<float>&lower = planes_.lower[axis], &upper = planes_.upper[axis];
    const bool may_be_flat = planes_.flat_boxes || lower.front() == upper.back();
    std::int32_t& free_lower = (owner & 1 ? state.right : state.left).lower[axis];
    std::int32_t& free_upper = (owner & 2 ? state.right : state.left).upper[axis];
    const auto is_box = [&](const PlaneBox& box) {
      const float a = lower[static_cast<std::size_t>(box.lower[axis])];
      const float b = upper[static_cast<std::size_t>(box.upper[axis])];
      return a < b || (may_be_flat && a == b);
    };
    // Where both children have a side of the node, the pattern with the left child as its owner stands for it.
    const std::int32_t first = owner & 1 ? 0 : 1;
    const auto last = static_cast<std::int32_t>(upper.size()) - (owner & 2 ? 1 : 2);
    const auto end = static_cast<std::int32_t>(lower.size());
    for (std::int32_t a = first, go_on = 1; a < end && go_on; ++a) {
      free_lower = a;
      go_on = 0;
      for (std::int32_t b = last; b >= 0; --b) {
        free_upper = b;
        if (!is_box(state.left) || !is_box(state.right) || !f()) break;
        go_on = 1;
      }
    }
    widen(state, axis);
  }

  Box box_of(const PlaneBox& box) const {
    Box out;
    for (int axis = 0; axis < 3; ++axis) {
      out.lower[axis] = planes_.lower[axis][static_cast<std::size_t>(box.lower[axis])];
      out.upper[axis] = planes_.upper[axis][static_cast<std::size_t>(box.upper[axis])];
    }
    return out;
  }

  /// Prices the state's boxes. False when they do not cover the references.
  bool consider(State& state) const {
    const Box left = box_of(state.left), right = box_of(state.right);
    const double left_area = scaled_half_area(left, price_.area_scale);
    const double right_area = scaled_half_area(right, price_.area_scale);
    const double penalty = price_.overlap > 0 ? 1 + price_.overlap * state.share[1] * axis_share(state, 2) : 1;
    const double enough = std::min(state.limit, state.best.cost);
    if (!(penalty * std::min(left_area, right_area) * references_ < enough)) return true;
    const SideCounts counts = counter_.count(state.left, state.right, price_.may_split);
    if (!counts.covered) return false;
    std::uint32_t to_left = counts.left + counts.split, to_right = counts.right + counts.split;
    (left_area <= right_area ? to_left : to_right) += counts.both;
    const bool useful = 0 < to_left && to_left < references_ && 0 < to_right && to_right < references_;
    if (!useful) return true;
    const double cost = penalty * (left_area * to_left + right_area * to_right);
    if (counts.split > price_.spare)
      state.best.refused = std::min(state.best.refused, cost);
    else if (cost < enough)
      state.best.cost = cost, state.best.boxes = {left, right};
    return true;
  }

  std::uint32_t references_;
  const CandidatePlanes& planes_;
  const Counter& counter_;
  const ConfigurationPrice& price_;
  double thin_[3];     ///< the least share of the node's extent that a child can have
  double least_area_;  ///< of a child
};

}  // namespace boxwood::builders
