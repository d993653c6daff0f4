// Tables 1 to 3 of Houghton and Spoerer (EBBVH): build time, camera rays and random rays of four builders.
#include <functional>

#include "reproduce/cells.h"
#include "reproduce/tables.h"

namespace boxwood::program::reproduce {
namespace {

constexpr std::size_t kBinned = 2;  ///< the column that ratios are over

/// The paper's columns, and ours behind them.
std::vector<NamedMethod> methods() {
  return {{"recursive-split", {"middle", popov_cost()}},
          {"aac", {"aac", popov_cost()}},
          {"binned-sah", {"binned-sah", popov_cost({{"bins", "8"}})}},
          {"ebbvh", {"ebbvh", popov_cost()}},
          {"ebbvh-gated", {"ebbvh-gated", popov_cost()}}};
}

struct PaperRow {
  const char* scene;
  double values[4];
};

// Milliseconds.
constexpr PaperRow kBuild[] = {{"Sponza", {48, 390, 514, 497}},
                               {"Bunny", {159, 191, 251, 312}},
                               {"Dragon", {398, 351, 542, 566}},
                               {"San-Miguel", {2496, 12161, 24958, 38127}}};
// Mrays/s.
constexpr PaperRow kCamera[] = {{"Sponza", {0.00028, 0.06, 0.004, 0.5}},
                                {"Bunny", {3.07, 0.26, 2.88, 0.89}},
                                {"Dragon", {3.47, 0.157, 2.95, 1.44}},
                                {"San-Miguel", {0.002, 0.002, 0.013, 0.22}}};
constexpr PaperRow kRandom[] = {{"Sponza", {0.0013, 1.08, 0.050, 3.26}},
                                {"Bunny", {5.02, 0.98, 3.2, 2.05}},
                                {"Dragon", {5.33, 2.42, 3.5, 2.69}},
                                {"San-Miguel", {7.06e-5, 0.014, 0.7, 0.95}}};

using Measure = std::function<Result<double>(const Subject&, const Method&)>;

Result<TableResult> make(Laboratory& laboratory, const std::vector<Subject>& subjects, PaperTable table,
                         std::span<const PaperRow> paper, const Measure& measure) {
  table.labels = {"scene"};
  table.baseline = "binned-sah";
  for (const NamedMethod& m : methods()) table.columns.push_back({m.name, table.id == "ebbvh-1" ? 0 : 2, true});
  for (const Subject& subject : subjects) {
    Row row{{scene_label(subject)}, {}};
    const PaperRow* values = nullptr;
    for (const PaperRow& candidate : paper)
      if (subject.paper_scene == candidate.scene) values = &candidate;
    const auto list = methods();
    for (std::size_t m = 0; m < list.size(); ++m) {
      Cell cell = paper_cell(values && m < 4 ? std::optional(values->values[m]) : std::nullopt);
      const Status status =
          fill(laboratory, subject, list[m].method, cell, [&] { return measure(subject, list[m].method); });
      if (!status) return status.error();
      row.cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  table.set_ratios_to_column(kBinned);
  return TableResult{std::move(table)};
}

Result<TableResult> rays_table(Laboratory& laboratory, const std::vector<Subject>& subjects, const char* id,
                               const char* title, std::span<const PaperRow> paper, Rays rays) {
  PaperTable table;
  table.id = id;
  table.title = title;
  table.notes = {subject_note(subjects), ray_note(laboratory.effort())};
  return make(laboratory, subjects, std::move(table), paper,
              [&](const Subject& subject, const Method& method) -> Result<double> {
                const auto traced = laboratory.trace(subject, method, rays);
                if (!traced) return traced.error();
                return traced->mrays;
              });
}

}  // namespace

Result<TableResult> ebbvh_build_times(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  PaperTable table;
  table.id = "ebbvh-1";
  table.title = "build time in ms (EBBVH, Table 1)";
  table.notes = {subject_note(subjects),
                 fmt::format("References and tree, {} threads, medians of {} rounds in turns or more (builds of over "
                             "a second: once); the paper built on one.",
                             laboratory.session().threads(), laboratory.effort().repeat)};
  std::vector<Method> timed;
  for (const NamedMethod& named : methods()) timed.push_back(named.method);
  for (const Subject& subject : subjects)
    if (Status status = laboratory.time_builds_in_turns(subject, timed); !status) return status.error();
  return make(laboratory, subjects, std::move(table), kBuild,
              [&](const Subject& subject, const Method& method) -> Result<double> {
                const auto built = laboratory.build(subject, method);
                if (!built) return built.error();
                return built->milliseconds;
              });
}

Result<TableResult> ebbvh_camera_rays(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  return rays_table(laboratory, subjects, "ebbvh-2", "camera rays in Mrays/s (EBBVH, Table 2)", kCamera, Rays::primary);
}

Result<TableResult> ebbvh_random_rays(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  return rays_table(laboratory, subjects, "ebbvh-3", "random rays in Mrays/s (EBBVH, Table 3)", kRandom, Rays::random);
}

}  // namespace boxwood::program::reproduce
