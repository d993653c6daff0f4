#include "correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "text.h"

namespace boxwood::program {

double Subject::cost_per_ray() const {
  const double nodes = row->nodes_per_ray.value_or(0);
  // The linear layout counts boxes tested: the root's and two for each inner node entered.
  const bool is_linear = contestant->accel->layout().id == layouts::LayoutId::linear;
  const double entered = is_linear ? std::max(nodes - 1, 0.0) / 2 : nodes;
  const tree::CostModel& cost = contestant->build->cost;
  return cost.traversal * entered + cost.intersection * row->primitives_per_ray.value_or(0);
}

double Subject::nanoseconds_per_ray() const {
  return 1e3 / row->mrays.median;
}

const std::vector<Measure>& measures() {
  static const std::vector<Measure> list = {
      {"surface_area_cost", "Exp(T)", 2, [](const Subject& s) { return *s.contestant->build->surface_area_cost; }},
      {"end_point_overlap", "EPO", 3,
       [](const Subject& s) { return s.contestant->build->measures->end_point_overlap.value; }},
      {"leaf_count_variability", "LCV", 3,
       [](const Subject& s) { return s.contestant->build->measures->leaf_count_variability.value; }},
      {"sibling_overlap_area", "area", 3,
       [](const Subject& s) { return s.contestant->build->measures->sibling_overlap.area; }},
      {"sibling_overlap_volume", "volume", 3,
       [](const Subject& s) { return s.contestant->build->measures->sibling_overlap.volume; }},
      {"references_per_primitive", "refs/tri", 3,
       [](const Subject& s) { return s.contestant->build->measures->references_per_primitive; }},
      {"bytes", "MiB", 1, [](const Subject& s) { return static_cast<double>(s.contestant->build->bytes) / (1 << 20); }},
      {"max_depth", "depth", 0, [](const Subject& s) { return static_cast<double>(s.contestant->build->max_depth); }},
      {"cost_per_ray", "cost/ray", 2, [](const Subject& s) { return s.cost_per_ray(); }},
  };
  return list;
}

std::optional<double> pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  if (x.size() < 3) return {};
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - mean_x, dy = y[i] - mean_y;
    xx += dx * dx, yy += dy * dy, xy += dx * dy;
  }
  // Equal numbers may differ from their mean by a rounding.
  const double tiny = 1e-12;
  if (!(xx > tiny * tiny * n * mean_x * mean_x) || !(yy > tiny * tiny * n * mean_y * mean_y)) return {};
  return xy / std::sqrt(xx * yy);
}

std::string Group::title() const {
  return fmt::format("{}, {}, {}, {}", name(kind), layout, queries::name(mode),
                     terminating ? "terminating" : "non-terminating");
}

std::vector<std::optional<double>> Group::correlations(const std::function<double(const Subject&)>& predicted) const {
  const auto values = [&](const std::function<double(const Subject&)>& value) {
    std::vector<double> list;
    for (const Subject& subject : subjects) list.push_back(value(subject));
    return list;
  };
  const std::vector<double> target = values(predicted);
  std::vector<std::optional<double>> result;
  for (const Measure& measure : measures()) result.push_back(pearson(values(measure.value), target));
  return result;
}

std::vector<Group> groups(const BenchResult& result) {
  std::vector<Group> list;
  for (const Row& row : result.rows) {
    const Contestant& c = *row.contestant;
    const auto same = std::find_if(list.begin(), list.end(), [&](const Group& g) {
      return g.kind == row.kind && g.layout == c.layout && g.mode == c.mode && g.terminating == c.traversal.terminating;
    });
    if (same != list.end())
      same->subjects.push_back({&c, &row});
    else
      list.push_back({row.kind, c.layout, c.mode, c.traversal.terminating, {{&c, &row}}});
  }
  return list;
}

}  // namespace boxwood::program
