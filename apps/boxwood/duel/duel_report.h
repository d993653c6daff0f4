// What boxwood duel says: the target table, the scenes, the agreement of hits; as text, Markdown, JSON and CSV.
#pragma once

#include <string>
#include <vector>

#include "duel/rounds.h"
#include "table.h"

namespace boxwood::program::duel {

/// A table with the sentence over it and those below it.
struct ReportTable {
  std::string title;
  Table table;
  std::vector<std::string> notes = {};
  bool is_detail = false;  ///< too long for a document
};

/// Targets, scenes, agreement, speeds: the tables that have anything to show.
std::vector<ReportTable> report_tables(const std::vector<SceneResult>& results);

Json cells_json(const std::vector<SceneResult>& results);
Json contests_json(const std::vector<SceneResult>& results);
Json agreements_json(const std::vector<SceneResult>& results);
/// One line per cell, with the keys of cells_json that are no lists.
std::string cells_csv(const Json& cells);

}  // namespace boxwood::program::duel
