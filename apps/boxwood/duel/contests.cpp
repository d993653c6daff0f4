#include "duel/contests.h"

#include <algorithm>
#include <string_view>

namespace boxwood::program::duel {
namespace {

constexpr Contest kContests[] = {
    {"closest-fast", "closest-fast", "", "closest hit, single calls, fast : default mode", 1.15, 1.3, 1.0},
    {"closest-fast-primary", "closest-fast", "primary", "- primary rays alone", 1.25, 1.5},
    {"closest-robust", "closest-robust", "", "closest hit, single calls, robust : ROBUST", 1.4, 1.7},
    {"any-hit", "any-hit", "", "any hit, single calls : rtcOccluded1", 1.3, 1.8, 1.0},
    {"batch-incoherent", "batch-incoherent", "", "batch, incoherent, closest : rtcIntersect1", 1.3, 2.0},
    {"batch-incoherent-large", "batch-incoherent", "", "- scenes over a million triangles", 1.5, 2.0, 0, 1'000'000},
    {"batch-coherent", "batch-coherent", "", "batch, coherent, closest : rtcIntersect1", 2.0, 3.0},
    {"batch-coherent-any", "batch-coherent-any", "", "batch, coherent, any : rtcOccluded8 coherent", 1.1, 1.5},
    {"build-balanced", "build-balanced", "", "build speed, balanced : MEDIUM", 1.0, 1.5},
    {"trace-balanced", "trace-balanced", "", "- its trace speed : MEDIUM's", 1.0, 1.0},
    {"build-fast", "build-fast", "", "build speed, fast : LOW", 1.0, 1.5},
    {"trace-fast", "trace-fast", "", "- its trace speed : LOW's", 1.0, 1.0},
    {"bytes", "bytes", "", "bytes per triangle of balanced", 62, 45, 0, 0, true},
    {"optimize", "optimize", "", "optimize on held-out rays : best", 1.1, 1.25},
};

bool takes(const Contest& contest, const Cell& cell) {
  return cell.group == contest.group && (!*contest.rays || cell.rays == contest.rays) &&
         cell.triangles > contest.triangles_over;
}

/// Is `a` worse for us than `b`?
bool is_worse(const Contest& contest, double a, double b) {
  return contest.is_bytes ? a > b : a < b;
}

Summary summarise(const Contest& contest, const std::vector<Cell>& cells) {
  Summary summary;
  summary.contest = &contest;
  std::vector<double> medians;
  std::size_t rounds = SIZE_MAX;
  for (const Cell& cell : cells) {
    if (!takes(contest, cell)) continue;
    summary.cells.push_back(&cell);
    medians.push_back(cell.value());
    rounds = std::min(rounds, cell.values.size());
    if (!summary.worst || is_worse(contest, cell.value(), summary.worst->value())) summary.worst = &cell;
  }
  if (medians.empty()) return summary;
  summary.mean = summary.lowest = summary.highest = geometric_mean(medians);
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<double> values;
    for (const Cell* cell : summary.cells) values.push_back(cell->values[round]);
    const double mean = geometric_mean(values);
    summary.lowest = std::min(summary.lowest, mean), summary.highest = std::max(summary.highest, mean);
  }
  return summary;
}

}  // namespace

std::span<const Contest> contests() {
  return kContests;
}

bool Summary::meets(double limit) const {
  if (contest->is_bytes) return mean <= limit;
  if (mean < limit) return false;
  return std::all_of(cells.begin(), cells.end(), [&](const Cell* cell) {
    return scene_value(*this, cell->scene).value_or(1) >= contest->no_scene_under;
  });
}

const char* Summary::verdict() const {
  if (cells.empty()) return "-";
  return meets(contest->aim) ? "aim" : meets(contest->at_least) ? "yes" : "no";
}

std::vector<Summary> summarise(const std::vector<Cell>& cells) {
  std::vector<Summary> list;
  for (const Contest& contest : kContests) list.push_back(summarise(contest, cells));
  return list;
}

std::optional<double> scene_value(const Summary& summary, const std::string& scene) {
  std::vector<double> values;
  for (const Cell* cell : summary.cells)
    if (cell->scene == scene) values.push_back(cell->value());
  if (values.empty()) return {};
  return geometric_mean(values);
}

}  // namespace boxwood::program::duel
