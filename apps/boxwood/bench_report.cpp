#include "bench_report.h"

#include <algorithm>

#include "table.h"
#include "text.h"

namespace boxwood::program {
namespace {

using Align = Table::Align;

std::string mebibytes(std::size_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / (1 << 20));
}
std::string optional_text(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}
std::string thread_word(int threads) {
  return threads == 1 ? "1 thread" : fmt::format("{} threads", threads);
}
double median_build(const Contestant& c, std::size_t thread_index) {
  return spread_of(c.build->milliseconds[thread_index]).median;
}
bool differs_only_in_mode(const Contestant& a, const Contestant& b) {
  return a.build == b.build;
}

std::string traversal_text(const Contestant& c) {
  const std::string word = queries::name(c.traversal.traversal);
  const bool has_size = c.packet_size() > 4;
  return has_size ? fmt::format("{} of {}", word, c.packet_size()) : word;
}

/// The columns that tell contestants apart, leaving out what is the same for all.
struct Names {
  bool presplit, optimizer, layout, mode, traversal, terminating;
  explicit Names(const BenchPlan& plan)
      : presplit(plan.presplits.size() > 1),
        optimizer(plan.optimizers.size() > 1),
        layout(plan.layouts.size() > 1),
        mode(plan.modes.size() > 1),
        traversal(plan.traversals.back().traversal != queries::Traversal::single ||
                  plan.traversals.front().traversal != queries::Traversal::single),
        terminating(!plan.traversals.back().terminating) {}
  void columns(Table& table) const {
    table.column("builder", Align::left);
    if (presplit) table.column("pre-split", Align::left);
    if (optimizer) table.column("optimizer", Align::left);
    if (layout) table.column("layout", Align::left);
    if (mode) table.column("mode", Align::left);
    if (traversal) table.column("traversal", Align::left);
    if (terminating) table.column("hits end rays", Align::left);
  }
  std::vector<std::string> cells(const Contestant& c) const {
    std::vector<std::string> cells{c.builder};
    if (presplit) cells.push_back(c.is_rival() ? "-" : c.presplit);
    if (optimizer) cells.push_back(c.is_rival() ? "-" : c.optimizer);
    if (layout) cells.push_back(c.is_rival() ? "-" : c.layout);
    if (mode) cells.push_back(queries::name(c.mode));
    if (traversal) cells.push_back(c.is_rival() ? "-" : traversal_text(c));
    if (terminating) cells.push_back(c.traversal.terminating ? "yes" : "no");
    return cells;
  }
};

std::string build_table(const BenchPlan& plan, const BenchResult& result) {
  Table table;
  const bool has_presplits = plan.presplits.size() > 1, has_optimizers = plan.optimizers.size() > 1;
  table.column("builder", Align::left);
  if (has_presplits) table.column("pre-split", Align::left);
  if (has_optimizers) table.column("optimizer", Align::left);
  table.column("layout", Align::left);
  for (const int threads : plan.thread_counts) {
    table.column("ms", Align::right, "build, " + thread_word(threads));
    table.column("Mtri/s", Align::right, "build, " + thread_word(threads));
  }
  for (const char* head : {"Exp(T)", "nodes", "references", "depth", "leaf", "MiB"}) table.column(head);
  for (std::size_t i = 0; i < result.contestants.size(); ++i) {
    const Contestant& c = result.contestants[i];
    if (i > 0 && differs_only_in_mode(c, result.contestants[i - 1])) continue;
    // A rival is built anew for each mode.
    std::vector<std::string> cells{c.builder};
    if (has_presplits) cells.push_back(c.is_rival() ? "-" : c.presplit);
    if (has_optimizers) cells.push_back(c.is_rival() ? "-" : c.optimizer);
    cells.push_back(c.is_rival() ? queries::name(c.mode) : c.layout);
    for (std::size_t t = 0; t < plan.thread_counts.size(); ++t) {
      const double ms = median_build(c, t);
      cells.push_back(fmt::format("{:.1f}", ms));
      cells.push_back(fmt::format("{:.2f}", 1e-3 * static_cast<double>(result.input->mesh.triangles.size()) / ms));
    }
    const BuildFigures& b = *c.build;
    cells.push_back(optional_text(b.surface_area_cost, 2));
    for (const std::size_t value : {b.nodes, b.references, b.max_depth, b.max_leaf})
      cells.push_back(c.is_rival() ? "-" : with_thousands(value));
    cells.push_back(mebibytes(b.bytes));
    table.row(std::move(cells));
  }
  return "Building (median)\n" + table.text();
}

std::string kind_table(const BenchPlan& plan, const BenchResult& result, const RaySet& set) {
  const Names names(plan);
  const bool has_rivals = !plan.rivals.empty();
  Table table;
  names.columns(table);
  table.column("nodes/ray");
  if (names.traversal) table.column("packet nodes/ray");
  for (const char* head : {"tris/ray", "hits"}) table.column(head);
  for (const int threads : plan.thread_counts) {
    const std::string group = "Mrays/s, " + thread_word(threads);
    for (const char* head : {"median", "min", "max"}) table.column(head, Align::right, group);
    if (has_rivals) table.column("ratio", Align::right, group);
  }
  table.column("differ");
  std::vector<std::string> examples;
  for (std::size_t r = 0; r < result.rows.size(); ++r) {
    const Row& first = result.rows[r];
    if (first.kind != set.kind || first.thread_index != 0) continue;
    std::vector<std::string> cells = names.cells(*first.contestant);
    cells.push_back(optional_text(first.nodes_per_ray, 2));
    if (names.traversal) cells.push_back(optional_text(first.packet_nodes_per_ray, 2));
    cells.push_back(optional_text(first.primitives_per_ray, 2));
    cells.push_back(with_thousands(first.hits));
    for (std::size_t t = 0; t < plan.thread_counts.size(); ++t) {
      const Row& row = result.rows[r + t];
      for (const double value : {row.mrays.median, row.mrays.lowest, row.mrays.highest})
        cells.push_back(fmt::format("{:.2f}", value));
      if (has_rivals) cells.push_back(optional_text(row.ratio, 2));
    }
    cells.push_back(with_thousands(first.disagreements));
    table.row(std::move(cells));
    if (first.disagreements)
      examples.push_back(fmt::format("{} {}, {}\n", first.contestant->builder, queries::name(first.contestant->mode),
                                     first.first_disagreement));
  }
  std::string text = fmt::format("{}: {} rays, {} hit, hash {}\n{}", name(set.kind), with_thousands(set.rays.size()),
                                 asks_any(set.kind) ? "any" : "closest", hash_text(set.hash), table.text());
  for (const std::string& example : examples) text += "first that differs: " + example;
  return text;
}

std::string summary_table(const BenchPlan& plan, const BenchResult& result) {
  const Names names(plan);
  const std::size_t last = plan.thread_counts.size() - 1;
  Table table;
  names.columns(table);
  for (const int threads : plan.thread_counts) table.column(thread_word(threads), Align::right, "build ms");
  table.column("Exp(T)");
  for (const RaySet& set : result.ray_sets)
    for (const char* head : {"nodes", "tris", "Mrays/s"}) table.column(head, Align::right, name(set.kind));
  for (const Contestant& c : result.contestants) {
    std::vector<std::string> cells = names.cells(c);
    for (std::size_t t = 0; t <= last; ++t) cells.push_back(fmt::format("{:.1f}", median_build(c, t)));
    cells.push_back(optional_text(c.build->surface_area_cost, 2));
    for (const RaySet& set : result.ray_sets) {
      const auto row = std::find_if(result.rows.begin(), result.rows.end(), [&](const Row& r) {
        return r.contestant == &c && r.kind == set.kind && r.thread_index == last;
      });
      cells.push_back(optional_text(row->nodes_per_ray, 1));
      cells.push_back(optional_text(row->primitives_per_ray, 1));
      cells.push_back(fmt::format("{:.2f}", row->mrays.median));
    }
    table.row(std::move(cells));
  }
  return fmt::format("Summary: nodes and triangles per ray, Mrays/s with {}{}{}\n{}",
                     thread_word(plan.thread_counts[last]), names.layout ? "" : ", " + plan.layouts[0],
                     names.mode ? "" : fmt::format(", {} mode", queries::name(plan.modes[0])), table.text());
}

std::string csv_cell(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  return csv_field(value.get<std::string>());
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

std::string tables(const BenchPlan& plan, const BenchResult& result, bool full) {
  std::string text;
  if (full) {
    text += build_table(plan, result) + "\n";
    for (const RaySet& set : result.ray_sets) text += kind_table(plan, result, set) + "\n";
  }
  return text + summary_table(plan, result);
}

Json rows_json(const BenchPlan& plan, const BenchResult& result) {
  Json rows = Json::array();
  for (const Row& row : result.rows) {
    const Contestant& c = *row.contestant;
    const auto set = std::find_if(result.ray_sets.begin(), result.ray_sets.end(),
                                  [&](const RaySet& s) { return s.kind == row.kind; });
    const Spread build = spread_of(c.build->milliseconds[row.thread_index]);
    const auto ours = [&](std::size_t value) { return c.is_rival() ? Json() : Json(value); };
    Json json;
    json["scene"] = result.input->mesh.name;
    json["input"] = result.input->text;
    json["triangles"] = result.input->mesh.triangles.size();
    json["builder"] = c.builder;
    json["presplit"] = c.is_rival() ? Json() : Json(c.presplit);
    json["optimizer"] = c.is_rival() ? Json() : Json(c.optimizer);
    json["layout"] = c.layout;
    json["mode"] = queries::name(c.mode);
    json["traversal"] = c.is_rival() ? Json() : Json(queries::name(c.traversal.traversal));
    json["packet_size"] = ours(c.packet_size());
    json["terminating"] = c.traversal.terminating;
    json["rays"] = name(row.kind);
    json["ray_count"] = row.rays;
    json["ray_hash"] = hash_text(set->hash);
    json["threads"] = plan.thread_counts[row.thread_index];
    json["build_ms"] = build.median;
    json["build_ms_min"] = build.lowest;
    json["build_ms_max"] = build.highest;
    json["surface_area_cost"] = optional_json(c.build->surface_area_cost);
    json["nodes_per_ray"] = optional_json(row.nodes_per_ray);
    json["packet_nodes_per_ray"] = optional_json(row.packet_nodes_per_ray);
    json["primitives_per_ray"] = optional_json(row.primitives_per_ray);
    if (c.build->measures) json.update(measures_json(*c.build->measures));
    json["bytes"] = c.build->bytes;
    json["nodes"] = ours(c.build->nodes);
    json["references"] = ours(c.build->references);
    json["max_depth"] = ours(c.build->max_depth);
    json["max_leaf"] = ours(c.build->max_leaf);
    json["hash"] = c.is_rival() ? Json() : Json(hash_text(c.build->hash));
    json["hits"] = row.hits;
    json["mrays"] = {{"median", row.mrays.median}, {"min", row.mrays.lowest}, {"max", row.mrays.highest}};
    json["ratio"] = optional_json(row.ratio);
    json["disagreements"] = row.disagreements;
    json["first_disagreement"] = row.first_disagreement;
    rows.push_back(std::move(json));
  }
  return rows;
}

std::string csv(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    std::string head, line;
    for (const auto& [key, value] : row.items()) {
      const char* comma = line.empty() && head.empty() ? "" : ",";
      if (value.is_object()) {
        for (const auto& [inner_key, inner] : value.items())
          head += "," + key + "_" + inner_key, line += "," + csv_cell(inner);
      } else {
        head += comma + key, line += comma + csv_cell(value);
      }
    }
    if (text.empty()) text = head + "\n";
    text += line + "\n";
  }
  return text;
}

}  // namespace boxwood::program
