#include "duel/duel_report.h"

#include "text.h"

namespace boxwood::program::duel {
namespace {

using Align = Table::Align;

std::vector<Cell> all_cells(const std::vector<SceneResult>& results) {
  std::vector<Cell> cells;
  for (const SceneResult& result : results) cells.insert(cells.end(), result.cells.begin(), result.cells.end());
  return cells;
}

std::string number(const Contest& contest, double value) {
  return fmt::format("{:.{}f}", value, contest.is_bytes ? 1 : 2);
}

ReportTable target_table(const std::vector<Cell>& all, const std::vector<Summary>& summaries) {
  ReportTable report{"Targets: geometric means over scenes and rays, above 1 where ours is better", {}};
  report.table.column("contest", Align::left);
  for (const char* head : {"at least", "aim", "ours", "rounds", "worst"}) report.table.column(head);
  report.table.column("on", Align::left);
  report.table.column("reached", Align::left);
  for (const Summary& s : summaries) {
    const Contest& c = *s.contest;
    std::vector<std::string> cells{c.title, number(c, c.at_least), number(c, c.aim)};
    if (s.cells.empty()) {
      cells.insert(cells.end(), {"-", "-", "-", "-", "-"});
    } else {
      cells.insert(cells.end(), {number(c, s.mean), number(c, s.lowest) + " to " + number(c, s.highest),
                                 number(c, s.worst->value()), s.worst->scene + " " + s.worst->rays, s.verdict()});
    }
    report.table.row(std::move(cells));
  }
  report.notes.emplace_back(
      "rounds: lowest and highest of the same mean over one round each; worst: a single cell. Single calls in "
      "fast mode and for any hit are reached only if no scene's mean is under 1. Embree is the faster of MEDIUM and "
      "HIGH in each "
      "cell. Bytes: less is better.");
  std::size_t repeated = 0, disturbed = 0;
  for (const Cell& cell : all) repeated += cell.repeated, disturbed += cell.disturbed;
  report.notes.push_back(
      fmt::format("{} passes were made again because the process lacked a processor; {} lacked it to the last.",
                  repeated, disturbed));
  return report;
}

ReportTable scene_table(const std::vector<SceneResult>& results, const std::vector<Summary>& summaries) {
  ReportTable report{"Scenes: geometric mean over their rays", {}};
  report.table.column("scene", Align::left);
  report.table.column("triangles");
  for (const Summary& s : summaries)
    if (!s.cells.empty()) report.table.column(s.contest->id);
  for (const SceneResult& result : results) {
    std::vector<std::string> cells{result.scene, with_thousands(result.triangles)};
    for (const Summary& s : summaries) {
      if (s.cells.empty()) continue;
      const auto value = scene_value(s, result.scene);
      cells.push_back(value ? number(*s.contest, *value) : "-");
    }
    report.table.row(std::move(cells));
  }
  return report;
}

ReportTable speed_table(const std::vector<SceneResult>& results) {
  ReportTable report{"Speeds: million rays or triangles a second, bytes per triangle; ours : theirs (ratio)", {}};
  for (const char* head : {"scene", "contest", "rays", "ours", "theirs"}) report.table.column(head, Align::left);
  for (const char* head : {"ours", "theirs", "ratio", "spread"}) report.table.column(head);
  for (const SceneResult& result : results)
    for (const Cell& cell : result.cells) {
      const Spread spread = spread_of(cell.values);
      const bool has_rival = cell.rival_value > 0;
      const bool has_ratio = has_rival && cell.group != "bytes";
      report.table.row({cell.scene, cell.group, cell.rays, cell.ours, has_rival ? cell.rival : "-",
                        fmt::format("{:.2f}", cell.our_value),
                        has_rival ? fmt::format("{:.2f}", cell.rival_value) : "-",
                        has_ratio ? fmt::format("{:.2f}", spread.median) : "-",
                        has_ratio ? fmt::format("{:.2f} to {:.2f}", spread.lowest, spread.highest) : "-"});
    }
  return report;
}

ReportTable agreement_table(const std::vector<SceneResult>& results) {
  ReportTable report{"Agreement: robust mode against Embree's ROBUST, brute force in double precision as the judge",
                     {}};
  report.table.column("scene", Align::left);
  for (const char* head : {"rays", "hits", "differ", "judged", "ours right", "both right", "border", "ours wrong"})
    report.table.column(head);
  std::size_t wrong = 0;
  for (const SceneResult& result : results) {
    rivals::Verdicts sum;
    for (const Agreement& a : result.agreements) {
      const rivals::Verdicts& v = a.verdicts;
      sum.rays += v.rays, sum.hits += v.hits, sum.differences += v.differences, sum.judged += v.judged;
      sum.ours_right += v.ours_right, sum.both += v.both, sum.border += v.border, sum.wrong += v.wrong;
      if (v.wrong) report.notes.push_back(fmt::format("{} {}, {}", a.scene, a.rays, v.first_wrong));
    }
    std::vector<std::string> cells{result.scene};
    for (const std::size_t count :
         {sum.rays, sum.hits, sum.differences, sum.judged, sum.ours_right, sum.both, sum.border, sum.wrong})
      cells.push_back(with_thousands(count));
    report.table.row(std::move(cells));
    wrong += sum.wrong;
  }
  report.notes.push_back(wrong ? fmt::format("{} answers of ours contradict brute force.", wrong)
                               : "No answer of ours contradicts a clear verdict of brute force.");
  return report;
}

}  // namespace

std::vector<ReportTable> report_tables(const std::vector<SceneResult>& results) {
  const std::vector<Cell> cells = all_cells(results);
  const std::vector<Summary> summaries = summarise(cells);
  std::vector<ReportTable> tables{target_table(cells, summaries), scene_table(results, summaries)};
  bool has_agreement = false;
  for (const SceneResult& result : results) has_agreement |= !result.agreements.empty();
  if (has_agreement) tables.push_back(agreement_table(results));
  tables.push_back(speed_table(results));
  tables.back().is_detail = true;
  return tables;
}

Json cells_json(const std::vector<SceneResult>& results) {
  Json list = Json::array();
  for (const SceneResult& result : results)
    for (const Cell& cell : result.cells) {
      const Spread spread = spread_of(cell.values);
      const bool has_rival = cell.rival_value > 0;
      Json json{{"scene", cell.scene},
                {"triangles", cell.triangles},
                {"group", cell.group},
                {"rays", cell.rays},
                {"ray_count", cell.ray_count},
                {"ours", cell.ours},
                {"rival", has_rival ? Json(cell.rival) : Json()},
                {"our_value", cell.our_value},
                {"rival_value", has_rival ? Json(cell.rival_value) : Json()}};
      const bool has_ratio = has_rival && cell.group != "bytes";
      json["ratio"] = has_ratio ? Json(spread.median) : Json();
      json["ratio_min"] = has_ratio ? Json(spread.lowest) : Json();
      json["ratio_max"] = has_ratio ? Json(spread.highest) : Json();
      json["passes_repeated"] = cell.repeated;
      json["passes_disturbed"] = cell.disturbed;
      list.push_back(std::move(json));
    }
  return list;
}

Json contests_json(const std::vector<SceneResult>& results) {
  const std::vector<Cell> cells = all_cells(results);
  Json list = Json::array();
  for (const Summary& s : summarise(cells)) {
    const bool has = !s.cells.empty();
    list.push_back({{"id", s.contest->id},
                    {"title", s.contest->title},
                    {"at_least", s.contest->at_least},
                    {"aim", s.contest->aim},
                    {"cells", s.cells.size()},
                    {"mean", has ? Json(s.mean) : Json()},
                    {"mean_min", has ? Json(s.lowest) : Json()},
                    {"mean_max", has ? Json(s.highest) : Json()},
                    {"worst", has ? Json(s.worst->value()) : Json()},
                    {"worst_scene", has ? Json(s.worst->scene) : Json()},
                    {"worst_rays", has ? Json(s.worst->rays) : Json()},
                    {"reached", s.verdict()}});
  }
  return list;
}

Json agreements_json(const std::vector<SceneResult>& results) {
  Json list = Json::array();
  for (const SceneResult& result : results)
    for (const Agreement& a : result.agreements) {
      const rivals::Verdicts& v = a.verdicts;
      list.push_back({{"scene", a.scene},
                      {"rays", a.rays},
                      {"query", a.asks_any ? "any" : "closest"},
                      {"count", v.rays},
                      {"hits", v.hits},
                      {"differ", v.differences},
                      {"judged", v.judged},
                      {"ours_right", v.ours_right},
                      {"both_right", v.both},
                      {"border", v.border},
                      {"ours_wrong", v.wrong}});
    }
  return list;
}

std::string cells_csv(const Json& cells) {
  std::string text;
  for (const Json& cell : cells) {
    std::string head, line;
    for (const auto& [key, value] : cell.items()) {
      head += (head.empty() ? "" : ",") + key;
      const std::string field = value.is_null()     ? ""
                                : value.is_string() ? csv_field(value.get<std::string>())
                                                    : value.dump();
      line += (&value == &cell.front() ? "" : ",") + field;
    }
    if (text.empty()) text = head + "\n";
    text += line + "\n";
  }
  return text;
}

}  // namespace boxwood::program::duel
