// Tables 1 to 4 and Figure 6 of Popov, Georgiev, Dimov and Slusallek (2009).
#include <algorithm>
#include <limits>

#include "reproduce/cells.h"
#include "reproduce/popov_values.h"
#include "reproduce/tables.h"
#include "text.h"

namespace boxwood::program::reproduce {
namespace {

std::optional<double> known(double value) {
  return value == value ? std::optional(value) : std::nullopt;
}

/// C-BVH, the classic build, is every table's baseline.
bool is_classic(const Row& row) {
  return row.labels.back() == "C-BVH";
}

/// One row of Tables 3 and 4: Exp, random rays, and rays per second of four traversals.
Status add_full_row(Laboratory& laboratory, const Subject& subject, const NamedMethod& method,
                    const PopovFullRow* paper, PaperTable& table) {
  using queries::Traversal;
  using queries::TraversalOptions;
  const auto paper_value = [&](std::size_t column) {
    return paper_cell(paper ? known(paper->values[column]) : std::nullopt);
  };
  Row row{{scene_label(subject), method.name}, {}};
  const auto add = [&](auto measure) {
    Cell cell = paper_value(row.cells.size());
    Status status = fill(laboratory, subject, method.method, cell, measure);
    row.cells.push_back(std::move(cell));
    return status;
  };
  const auto built = [&](double scale, auto value) {
    return add([&, scale, value]() -> Result<double> {
      const auto result = laboratory.build(subject, method.method);
      if (!result) return result.error();
      return scale * static_cast<double>((*result).*value);
    });
  };
  const auto traced = [&](Rays rays, const TraversalOptions& options, auto value) {
    return add([&, value]() -> Result<double> {
      const auto result = laboratory.trace(subject, method.method, rays, options);
      if (!result) return result.error();
      return value(*result);
    });
  };
  const auto cost = [](const TraceResult& t) { return t.cost(); };
  const auto nodes = [](const TraceResult& t) { return t.nodes; };
  const auto primitives = [](const TraceResult& t) { return t.primitives; };
  const auto speed = [](const TraceResult& t) { return t.mrays; };
  if (Status s = built(0x1p-20, &BuildResult::bytes); !s) return s;
  if (Status s = built(1, &BuildResult::surface_area_cost); !s) return s;
  if (Status s = traced(Rays::random, {}, cost); !s) return s;
  if (Status s = traced(Rays::random, {}, nodes); !s) return s;
  if (Status s = traced(Rays::random, {}, primitives); !s) return s;
  if (Status s = traced(Rays::random, {}, speed); !s) return s;
  for (const Traversal traversal : {Traversal::packet4, Traversal::range, Traversal::partition})
    if (Status s = traced(Rays::primary, TraversalOptions{.traversal = traversal}, speed); !s) return s;
  table.rows.push_back(std::move(row));
  return {};
}

Result<TableResult> full_table(Laboratory& laboratory, const std::vector<Subject>& given, PaperTable table,
                               const std::vector<NamedMethod>& methods, std::span<const PopovFullRow> paper) {
  const std::vector<Subject> subjects = of_paper(given);
  table.notes = {
      subject_note(subjects), ray_note(laboratory.effort()),
      "C_T = 2, C_I = 3; Cost = nodes + 1.5 x triangles per random ray. Packets trace primary rays. The paper's "
      "frames per second are of a million rays, so they are Mrays/s."};
  table.labels = {"scene", "type"};
  table.baseline = "C-BVH";
  table.columns = {{"MiB", 1},
                   {"Exp", 1},
                   {"Cost", 1},
                   {"nodes", 1},
                   {"triangles", 1},
                   {"random", 2, true},
                   {"packet 4", 2, true},
                   {"range 256", 2, true},
                   {"partition 256", 2, true}};
  for (const Subject& subject : subjects)
    for (const NamedMethod& method : methods) {
      const auto values = std::find_if(paper.begin(), paper.end(), [&](const PopovFullRow& row) {
        return subject.paper_scene == row.scene && std::string(method.name) == row.type;
      });
      const PopovFullRow* const row = values == paper.end() ? nullptr : &*values;
      if (Status status = add_full_row(laboratory, subject, method, row, table); !status) return status.error();
    }
  table.set_ratios_to_row(is_classic);
  return TableResult{std::move(table)};
}

NamedMethod classic() {
  return {"C-BVH", {"sweep-sah", popov_cost()}};
}
NamedMethod spatial(const char* name, const char* growth) {
  return {name, {"spatial-split", popov_cost({{"growth", growth}})}};
}

}  // namespace

Result<TableResult> popov_recursive_cost(Laboratory& laboratory, const std::vector<Subject>& given) {
  const std::vector<Subject> subjects = of_paper(given);
  struct Measure {
    const char* name;
    const char* terminates;
    double (*value)(const TraceResult&);
    double paper[2];
  };
  constexpr auto nodes = [](const TraceResult& t) { return t.nodes; };
  constexpr auto triangles = [](const TraceResult& t) { return t.primitives; };
  constexpr auto cost = [](const TraceResult& t) { return t.cost(); };
  const Measure measures[] = {
      {"nodes", "yes", nodes, {62.5, 81.0}},        {"triangles", "yes", triangles, {15.2, 8.0}},
      {"Cost", "yes", cost, {85.3, 93.0}},          {"nodes", "no", nodes, {122.3, 137.4}},
      {"triangles", "no", triangles, {48.7, 26.7}}, {"Cost", "no", cost, {195.3, 177.5}}};
  const Method methods[] = {classic().method, {"geometric", popov_cost({{"cost", "recursive"}})}};
  PaperTable table;
  table.id = "popov-1";
  table.title = "recursive cost against the centroid sweep (POPOV, Table 1)";
  table.notes = {subject_note(subjects), ray_note(laboratory.effort()),
                 "Rays that end: primary. Rays that don't: lines through the whole scene, every hit counted."};
  table.labels = {"scene", "measure", "rays end"};
  table.columns = {{"centroid sweep", 1}, {"grid, recursive cost", 1}};
  for (const Subject& subject : subjects) {
    const bool is_sponza = subject.paper_scene == "SPONZA";
    const auto paper = [&](double value) { return paper_cell(is_sponza ? std::optional(value) : std::nullopt); };
    Row exp{{scene_label(subject), "Exp", "-"}, {paper(142.6), paper(124.0)}};
    for (std::size_t m = 0; m < 2; ++m) {
      const Status status = fill(laboratory, subject, methods[m], exp.cells[m], [&]() -> Result<double> {
        const auto built = laboratory.build(subject, methods[m]);
        if (!built) return built.error();
        return built->surface_area_cost;
      });
      if (!status) return status.error();
    }
    table.rows.push_back(std::move(exp));
    for (const Measure& measure : measures) {
      const bool ends = measure.terminates == std::string("yes");
      Row row{{scene_label(subject), measure.name, measure.terminates},
              {paper(measure.paper[0]), paper(measure.paper[1])}};
      for (std::size_t m = 0; m < 2; ++m) {
        const Status status = fill(laboratory, subject, methods[m], row.cells[m], [&]() -> Result<double> {
          const auto traced = laboratory.trace(subject, methods[m], ends ? Rays::primary : Rays::lines,
                                               queries::TraversalOptions{.terminating = ends});
          if (!traced) return traced.error();
          return measure.value(*traced);
        });
        if (!status) return status.error();
      }
      table.rows.push_back(std::move(row));
    }
  }
  return TableResult{std::move(table)};
}

Result<TableResult> popov_presplit(Laboratory& laboratory, const std::vector<Subject>& given) {
  const std::vector<Subject> subjects = of_paper(given);
  const auto with = [](const char* name, const char* presplit) {
    return NamedMethod{name, {"sweep-sah", popov_cost(), presplit}};
  };
  const NamedMethod methods[] = {classic(),
                                 with("EVH-BVH t=14", "evh:t=14"),
                                 with("EVH-BVH t=16", "evh:t=16"),
                                 with("ESC-BVH 80", "esc:k=80"),
                                 with("ESC-BVH 200", "esc:k=200"),
                                 {"G-BVH", {"generic", popov_cost()}},
                                 spatial("SS-BVH growth 1.5", "1.5"),
                                 spatial("SS-BVH growth 2.5", "2.5"),
                                 spatial("SS-BVH growth 4", "4"),
                                 spatial("SS-BVH growth 8", "8"),
                                 {"SBVH", {"sbvh", popov_cost()}}};
  PaperTable table;
  table.id = "popov-2";
  table.title = "pre-splits and spatial splits, upright and turned (POPOV, Table 2)";
  table.notes = {
      subject_note(subjects), ray_note(laboratory.effort()),
      "C_T = 2, C_I = 3; Cost = nodes + 1.5 x triangles per primary ray. Turned: by 30, 40 and 20 degrees; the paper "
      "gives no angles. Its five sizes of SS-BVH stand beside the growth limit that comes nearest."};
  table.labels = {"scene", "turned", "type"};
  table.baseline = "C-BVH";
  table.columns = {{"MiB", 1}, {"references", 0}, {"Exp", 1}, {"Cost", 1}, {"primary", 2, true}};
  for (const Subject& upright : subjects)
    for (const bool turned : {false, true}) {
      const Subject subject = turned ? rotated(upright, {30, 40, 20}, *laboratory.session().executor()) : upright;
      for (const NamedMethod& method : methods) {
        const PopovPresplitRow* const paper =
            upright.paper_scene == "SPONZA" ? popov_presplit_row(turned, method.name) : nullptr;
        const auto value = [&](double PopovPresplitRow::*member) {
          return paper_cell(paper ? known(paper->*member) : std::nullopt);
        };
        Row row{{scene_label(upright), turned ? "yes" : "no", method.name},
                {value(&PopovPresplitRow::size), paper_cell({}), value(&PopovPresplitRow::exp),
                 value(&PopovPresplitRow::cost), value(&PopovPresplitRow::speed)}};
        const std::string reason = laboratory.left_out(subject, method.method);
        if (!reason.empty()) {
          for (Cell& cell : row.cells) cell.note = reason;
        } else {
          const auto built = laboratory.build(subject, method.method);
          if (!built) return built.error();
          const auto traced = laboratory.trace(subject, method.method, Rays::primary);
          if (!traced) return traced.error();
          row.cells[0].ours = 0x1p-20 * static_cast<double>(built->bytes);
          row.cells[1].ours = static_cast<double>(built->references);
          row.cells[2].ours = built->surface_area_cost;
          row.cells[3].ours = traced->cost();
          row.cells[4].ours = traced->mrays;
        }
        table.rows.push_back(std::move(row));
      }
    }
  table.set_ratios_to_row(is_classic);
  return TableResult{std::move(table)};
}

Result<TableResult> popov_geometric(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  PaperTable table;
  table.id = "popov-3";
  table.title = "the geometric partitioner (POPOV, Table 3)";
  return full_table(laboratory, subjects, std::move(table),
                    {classic(),
                     {"GP-BVH K_R=2^6", {"geometric", popov_cost({{"grid.k", "64"}})}},
                     {"GP-BVH K_R=2^12", {"geometric", popov_cost({{"grid.k", "4096"}})}}},
                    popov_geometric_rows());
}

Result<TableResult> popov_generic(Laboratory& laboratory, const std::vector<Subject>& subjects) {
  PaperTable table;
  table.id = "popov-4";
  table.title = "the generic builder and KD trees (POPOV, Table 4)";
  return full_table(laboratory, subjects, std::move(table),
                    {classic(),
                     {"G-BVH", {"generic", popov_cost()}},
                     {"GK-BVH", {"generic", popov_cost({{"oracle.centroid", "0"}, {"oracle.grid", "0"}})}},
                     {"KD-BVH", {"kd", popov_cost()}},
                     {"SS-BVH", {"spatial-split", popov_cost()}}},
                    popov_generic_rows());
}

Result<TableResult> popov_overlap_penalty(Laboratory& laboratory, const std::vector<Subject>& given) {
  const std::vector<Subject> subjects = of_paper(given);
  constexpr const char* kPenalties[] = {"0", "1", "10", "100", "1000", "10000", "1e16"};
  PaperTable table;
  table.id = "popov-6";
  table.title = "cost of a random ray over the overlap penalty of the generic builder (POPOV, Figure 6)";
  table.notes = {subject_note(subjects), ray_note(laboratory.effort()),
                 "C_T = 2, C_I = 3; Cost = nodes + 1.5 x triangles per ray. The paper draws curves without numbers."};
  table.labels = {"scene"};
  Chart chart{.name = "popov-6",
              .title = table.title,
              .x = "overlap penalty C_O + 1",
              .y = "cost per random ray",
              .series = {},

              .log_x = true};
  for (const char* penalty : kPenalties) table.columns.push_back({fmt::format("C_O = {}", penalty), 1});
  for (const Subject& subject : subjects) {
    Row row{{scene_label(subject)}, {}};
    Chart::Series series{.name = subject.paper_scene.empty() ? subject.label : subject.paper_scene, .points = {}};
    for (const char* penalty : kPenalties) {
      const Method method{"generic", popov_cost({{"overlap", penalty}})};
      Cell cell;
      const Status status = fill(laboratory, subject, method, cell, [&]() -> Result<double> {
        const auto traced = laboratory.trace(subject, method, Rays::random);
        if (!traced) return traced.error();
        return traced->cost();
      });
      if (!status) return status.error();
      if (cell.ours) series.points.emplace_back(std::min(std::stod(penalty), 1e5) + 1, *cell.ours);
      row.cells.push_back(std::move(cell));
    }
    chart.series.push_back(std::move(series));
    table.rows.push_back(std::move(row));
  }
  return TableResult{std::move(table), {std::move(chart)}};
}

}  // namespace boxwood::program::reproduce
