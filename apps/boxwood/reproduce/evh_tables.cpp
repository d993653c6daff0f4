// Table 1 and Figures 4 and 5 of Dammertz and Keller (2008), the edge volume heuristic.
#include <algorithm>

#include "reproduce/cells.h"
#include "reproduce/tables.h"

namespace boxwood::program::reproduce {
namespace {

/// The paper traces with a QBVH.
constexpr const char* kLayout = "wide4";

Method split_method(const std::string& presplit) {
  return {"sweep-sah", popov_cost(), presplit, kLayout};
}

std::string threshold(int t) {
  return fmt::format("evh:t={}", t);
}

/// Time of the primary rays with a pre-split over that without.
struct Compared {
  double references = 1, time = 1;
};

Result<Compared> compare(Laboratory& laboratory, const Subject& subject, const std::string& presplit) {
  const auto base_built = laboratory.build(subject, split_method("none"));
  const auto built = laboratory.build(subject, split_method(presplit));
  const auto base = laboratory.trace(subject, split_method("none"), Rays::primary);
  const auto traced = laboratory.trace(subject, split_method(presplit), Rays::primary);
  if (!base_built) return base_built.error();
  if (!built) return built.error();
  if (!base) return base.error();
  if (!traced) return traced.error();
  return Compared{static_cast<double>(built->references) / static_cast<double>(base_built->references),
                  base->mrays / traced->mrays};
}

std::string quad_note(const Effort& effort) {
  return fmt::format("Builder sweep-sah, layout {}, robust mode, one thread; {}x{} primary rays, median of {}.",
                     kLayout, effort.width, effort.height, effort.repeat);
}

/// The paper's animation: 32 steps to (90, 20, 30) degrees, 32 more to (-180, 0, 90).
Vec3 frame_angles(int frame) {
  const Vec3 middle{90, 20, 30}, end{-180, 0, 90};
  const float share = static_cast<float>(frame <= 32 ? frame : frame - 32) / 32;
  return frame <= 32 ? middle * share : middle + (end - middle) * share;
}

constexpr const char* kSponza = "Sponza (Frame 16)";

/// The paper's Sponza stands as in frame 16 of its animation; a mesh of it stands upright.
std::vector<Subject> as_in_frame_16(const std::vector<Subject>& subjects, Executor& executor) {
  std::vector<Subject> turned;
  for (const Subject& subject : subjects) {
    const bool upright = subject.paper_scene == kSponza && !subject.input->is_scene;
    turned.push_back(upright ? rotated(subject, frame_angles(16), executor) : subject);
  }
  return turned;
}

}  // namespace

Result<TableResult> evh_area_reduction(Laboratory& laboratory, const std::vector<Subject>& given) {
  const std::vector<Subject> subjects = as_in_frame_16(given, *laboratory.session().executor());
  struct PaperRow {
    const char* scene;
    double values[3];
  };
  constexpr PaperRow kPaper[] = {
      {"Space Ship", {0.25, 0.435, 1.0}}, {"Kitchen", {0.25, 0.463, 0.992}}, {kSponza, {0.25, 0.457, 0.99}}};
  PaperTable table;
  table.id = "evh-1";
  table.title = "area of a part's box over that of the box it was cut from (EVH, Table 1)";
  table.notes = {subject_note(subjects), "evh:t=14, over both parts of every cut; 0.25 is the least there can be."};
  table.labels = {"scene"};
  table.columns = {
      {"best", 3}, {"average", 3}, {"worst", 3}, {"cuts", 0}, {"references added, %", 2}, {"area after / before", 3}};
  const auto presplit = refs::parse_presplit("evh:t=14");
  if (!presplit) return presplit.error();
  for (const Subject& subject : subjects) {
    auto references = refs::make_references(subject.input->mesh, *laboratory.session().executor());
    if (!references) return references.error();
    refs::PresplitReport report;
    const auto split = refs::apply_presplit(std::move(*references), subject.input->mesh, *presplit,
                                            *laboratory.session().executor(), &report);
    if (!split) return split.error();
    Row row{{scene_label(subject)}, std::vector<Cell>(table.columns.size())};
    for (const PaperRow& paper : kPaper)
      if (subject.paper_scene == paper.scene)
        for (std::size_t c = 0; c < 3; ++c) row.cells[c].paper = paper.values[c];
    if (report.splits > 0) {
      row.cells[0].ours = report.best_factor;
      row.cells[1].ours = report.average_factor;
      row.cells[2].ours = report.worst_factor;
    } else {
      for (std::size_t c = 0; c < 3; ++c) row.cells[c].note = "nothing cut";
    }
    row.cells[3].ours = static_cast<double>(report.splits);
    row.cells[4].ours =
        100 * (static_cast<double>(report.references_after) / static_cast<double>(report.references_before) - 1);
    row.cells[5].ours = report.area_reduction();
    table.rows.push_back(std::move(row));
  }
  return TableResult{std::move(table)};
}

Result<TableResult> evh_thresholds(Laboratory& laboratory, const std::vector<Subject>& given) {
  const std::vector<Subject> subjects = as_in_frame_16(of_paper(given), *laboratory.session().executor());
  constexpr int kThresholds[] = {4, 6, 8, 10, 12, 14, 16, 18};
  PaperTable table;
  table.id = "evh-4";
  table.title = "references and time of primary rays over the threshold t, both over those without (EVH, Figure 4)";
  table.notes = {subject_note(subjects), quad_note(laboratory.effort()), "The paper draws curves without numbers."};
  table.labels = {"scene", "of"};
  Chart chart{.name = "evh-4",
              .title = "Edge volume heuristic, t = 4 to 18",
              .x = "references, x of those without",
              .y = "time of primary rays, x of that without",
              .series = {}};
  for (const int t : kThresholds) table.columns.push_back({fmt::format("t = {}", t), 3});
  for (const Subject& subject : subjects) {
    Row references{{scene_label(subject), "references"}, {}}, time{{scene_label(subject), "time"}, {}};
    Chart::Series series{.name = subject.paper_scene.empty() ? subject.label : subject.paper_scene, .points = {{1, 1}}};
    for (const int t : kThresholds) {
      const auto compared = compare(laboratory, subject, threshold(t));
      if (!compared) return compared.error();
      references.cells.push_back(
          Cell{.ours = compared->references, .paper = {}, .our_ratio = {}, .paper_ratio = {}, .note = {}});
      time.cells.push_back(Cell{.ours = compared->time, .paper = {}, .our_ratio = {}, .paper_ratio = {}, .note = {}});
      series.points.emplace_back(compared->references, compared->time);
    }
    table.rows.push_back(std::move(references));
    table.rows.push_back(std::move(time));
    chart.series.push_back(std::move(series));
  }
  return TableResult{std::move(table), {std::move(chart)}};
}

Result<TableResult> evh_rotation(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  constexpr int kThresholds[] = {12, 14, 16};
  constexpr int kFrames = 64;
  const auto sponza = std::find_if(subjects.begin(), subjects.end(),
                                   [](const Subject& subject) { return subject.paper_scene == kSponza; });
  PaperTable table;
  table.id = "evh-5";
  table.title = "a scene turned through 64 frames (EVH, Figure 5)";
  table.labels = {"frame", "degrees"};
  table.columns = {{"base, ms", 1},          {"t = 12, ms", 1}, {"t = 14, ms", 1}, {"t = 16, ms", 1},
                   {"references t = 12", 3}, {"t = 14", 3},     {"t = 16", 3}};
  if (sponza == subjects.end() && !subjects.empty()) {
    table.notes = {"None of the given meshes is the paper's Sponza (about 66,454 triangles), the scene it turns."};
    return TableResult{std::move(table)};
  }
  // Frame 0 stands upright: the stand-in is kept as frame 16.
  Subject upright = *sponza;
  if (upright.input->is_scene) {
    auto input = load_usable_input("scene:atrium,triangles=66454", {}, laboratory.session());
    if (!input) return input.error();
    upright.input = std::make_shared<Input>(std::move(*input));
    upright.label = upright.input->text;
  }
  table.notes = {fmt::format("{}, {} triangles. {}", upright.label, upright.input->mesh.triangles.size(),
                             quad_note(laboratory.effort())),
                 "The view turns with the scene. Milliseconds per picture; references over those of the base."};
  Chart time{.name = "evh-5-time",
             .title = "Edge volume heuristic: a turning scene",
             .x = "frame",
             .y = "ms per picture",
             .series = {}};
  Chart size{.name = "evh-5-references",
             .title = "Edge volume heuristic: references of a turning scene",
             .x = "frame",
             .y = "references, x of the base",
             .series = {}};
  time.series.push_back({.name = "base", .points = {}});
  for (const int t : kThresholds) {
    time.series.push_back({.name = fmt::format("t = {}", t), .points = {}});
    size.series.push_back({.name = fmt::format("t = {}", t), .points = {}});
  }
  const double rays = static_cast<double>(laboratory.effort().width) * laboratory.effort().height;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Vec3 angles = frame_angles(frame);
    const Subject subject = rotated(upright, angles, *laboratory.session().executor());
    const auto base = laboratory.trace(subject, split_method("none"), Rays::primary);
    if (!base) return base.error();
    Row row{{fmt::format("{}", frame), fmt::format("{:.1f} {:.1f} {:.1f}", angles.x, angles.y, angles.z)},
            std::vector<Cell>(table.columns.size())};
    row.cells[0].ours = 1e-3 * rays / base->mrays;
    time.series[0].points.emplace_back(frame, *row.cells[0].ours);
    for (std::size_t i = 0; i < std::size(kThresholds); ++i) {
      const auto compared = compare(laboratory, subject, threshold(kThresholds[i]));
      if (!compared) return compared.error();
      row.cells[1 + i].ours = *row.cells[0].ours * compared->time;
      row.cells[4 + i].ours = compared->references;
      time.series[1 + i].points.emplace_back(frame, *row.cells[1 + i].ours);
      size.series[i].points.emplace_back(frame, compared->references);
    }
    table.rows.push_back(std::move(row));
  }
  return TableResult{std::move(table), {std::move(time), std::move(size)}};
}

}  // namespace boxwood::program::reproduce
