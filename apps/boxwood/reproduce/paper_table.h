// A table of a paper with our values beside the paper's, and its forms as text, CSV, JSON and Markdown.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session.h"

namespace boxwood::program::reproduce {

struct Column {
  std::string name;
  int digits = 1;
  /// Depends on the machine: comparable between papers and us only as a ratio within one run.
  bool of_machine = false;
};

struct Cell {
  std::optional<double> ours, paper;
  std::optional<double> our_ratio, paper_ratio;  ///< of machine-dependent values to their baseline
  std::string note;                              ///< stands where ours is missing: why
};

struct Row {
  std::vector<std::string> labels;
  std::vector<Cell> cells;
};

struct PaperTable {
  std::string id, title;
  std::vector<std::string> notes;   ///< what was measured, and on what
  std::vector<std::string> labels;  ///< heads of the label columns
  std::vector<Column> columns;
  std::string baseline;  ///< what the ratios are over, in words
  std::vector<Row> rows;

  /// Gives every machine-dependent cell the ratio to the cell of `column` in its own row.
  void set_ratios_to_column(std::size_t column);
  /// Gives every machine-dependent cell the ratio to the same column of the latest row before it, or of itself, for
  /// which `is_baseline` says so.
  void set_ratios_to_row(const std::function<bool(const Row&)>& is_baseline);
};

std::string text(const PaperTable& table);
std::string markdown(const PaperTable& table);
/// One line per cell: table, row, column, ours, paper, our_ratio, paper_ratio, note. `head` also writes the head line.
std::string csv(const PaperTable& table, bool head);
Json json(const PaperTable& table);

}  // namespace boxwood::program::reproduce
