// All builders on all meshes: what each costs to build and what rays cost then. Not a paper's table, but its question.
#include <algorithm>
#include <cmath>

#include "reproduce/cells.h"
#include "reproduce/tables.h"

namespace boxwood::program::reproduce {
namespace {

/// Layout and ray counts of everyday use.
constexpr const char* kLayout = "wide8";

/// Columns.
constexpr std::size_t kBuildColumn = 0, kRandomColumn = 7;

/// Geometric means over the meshes, over one builder.
struct Means {
  double log_build = 0, log_speed = 0;
  int count = 0;
};

/// The builders that none beats in both, connected.
Chart::Series pareto_front(const std::vector<Chart::Series>& builders) {
  Chart::Series front{.name = "Pareto front", .points = {}};
  for (const Chart::Series& builder : builders) {
    const std::pair<double, double> point = builder.points[0];  // build time, speed
    const bool is_beaten = std::any_of(builders.begin(), builders.end(), [&](const Chart::Series& other) {
      const auto& [time, speed] = other.points[0];
      return time <= point.first && speed >= point.second && (time < point.first || speed > point.second);
    });
    if (!is_beaten) front.points.push_back(point);
  }
  std::sort(front.points.begin(), front.points.end());
  return front;
}

}  // namespace

Result<TableResult> compare_builders(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  PaperTable table;
  table.id = "builders";
  table.title = "build time against ray speed of all builders";
  table.notes = {
      fmt::format(
          "Layout {}, robust mode. Build: references and tree on {} threads, medians of {} rounds in turns or "
          "more (builds of over a second: once). Rays: {}x{} primary and {} random rays on one thread, median of {}; "
          "nodes and triangles per random ray.",
          kLayout, laboratory.session().threads(), laboratory.effort().repeat, laboratory.effort().width,
          laboratory.effort().height, laboratory.effort().random_rays, laboratory.effort().repeat),
      "C_T = 2, C_I = 3. EPO: end-point overlap (Aila, Karras and Laine 2013)."};
  table.labels = {"mesh", "builder"};
  table.baseline = "sweep-sah";
  table.columns = {{"build ms", 0, true}, {"Exp", 1},       {"EPO", 2},           {"references", 0},
                   {"nodes", 2},          {"triangles", 2}, {"primary", 2, true}, {"random", 2, true}};
  Chart chart{.name = "builders",
              .title = "Builders: speed of random rays against build time",
              .x = "build time, x of sweep-sah's (geometric mean of the meshes)",
              .y = "random rays, x of sweep-sah's",
              .series = {},
              .log_x = true,
              .from_zero = false};
  std::map<std::string, Means> means;
  for (const Subject& subject : subjects) {
    std::optional<double> base_build, base_speed;
    std::vector<std::pair<std::string, std::pair<double, double>>> points;
    const std::size_t first_row = table.rows.size();
    std::vector<Method> methods;
    for (const auto& builder : builders::registry()) methods.push_back({builder.id, popov_cost(), "none", kLayout});
    for (const Method& method : methods) {
      const builders::BuilderInfo& builder = *builders::find(method.builder);
      Row row{{subject.label, builder.id}, std::vector<Cell>(table.columns.size())};
      const std::string reason = laboratory.left_out(subject, method);
      if (!reason.empty()) {
        for (Cell& cell : row.cells) cell.note = reason;
        table.rows.push_back(std::move(row));
        continue;
      }
      const auto built = laboratory.build(subject, method);
      if (!built) return built.error();
      const auto overlap = laboratory.end_point_overlap(subject, method);
      if (!overlap) return overlap.error();
      const auto primary = laboratory.trace(subject, method, Rays::primary);
      if (!primary) return primary.error();
      const auto random = laboratory.trace(subject, method, Rays::random);
      if (!random) return random.error();
      const double values[] = {0,
                               built->surface_area_cost,
                               *overlap,
                               static_cast<double>(built->references),
                               random->nodes,
                               random->primitives,
                               primary->mrays,
                               random->mrays};
      for (std::size_t c = 0; c < row.cells.size(); ++c) row.cells[c].ours = values[c];
      table.rows.push_back(std::move(row));
    }
    // Last, since the trees of large meshes are too many to keep them all.
    if (Status status = laboratory.time_builds_in_turns(subject, methods); !status) return status.error();
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Row& row = table.rows[first_row + m];
      if (!row.cells[kBuildColumn].ours) continue;
      const auto built = laboratory.build(subject, methods[m]);
      if (!built) return built.error();
      const double speed = *row.cells[kRandomColumn].ours;
      row.cells[kBuildColumn].ours = built->milliseconds;
      if (methods[m].builder == table.baseline) base_build = built->milliseconds, base_speed = speed;
      points.push_back({methods[m].builder, {built->milliseconds, speed}});
    }
    if (!base_build || !base_speed) continue;
    for (const auto& [id, point] : points) {
      Means& mean = means[id];
      mean.log_build += std::log(point.first / *base_build);
      mean.log_speed += std::log(point.second / *base_speed);
      ++mean.count;
    }
  }
  for (const auto& builder : builders::registry()) {
    const auto mean = means.find(builder.id);
    if (mean == means.end()) continue;
    const double count = mean->second.count;
    chart.series.push_back({builder.id,
                            {{std::exp(mean->second.log_build / count), std::exp(mean->second.log_speed / count)}},
                            {builder.id},
                            false});
  }
  chart.series.push_back(pareto_front(chart.series));
  // The baseline is not the first row of a mesh, so its ratios are found per mesh.
  std::map<std::string, std::vector<Cell>> base;
  for (const Row& row : table.rows)
    if (row.labels.back() == table.baseline) base[row.labels.front()] = row.cells;
  for (Row& row : table.rows)
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      if (const auto found = base.find(row.labels.front());
          table.columns[c].of_machine && found != base.end() && row.cells[c].ours && found->second[c].ours)
        row.cells[c].our_ratio = *row.cells[c].ours / *found->second[c].ours;
  return TableResult{std::move(table), {std::move(chart)}};
}

}  // namespace boxwood::program::reproduce
