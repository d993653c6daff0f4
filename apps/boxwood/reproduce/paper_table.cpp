#include "reproduce/paper_table.h"

#include <cmath>

#include "table.h"
#include "text.h"

namespace boxwood::program::reproduce {
namespace {

std::string number(double value, int digits) {
  // Very small values (0.00028 Mrays/s) keep two significant digits.
  const double size = std::fabs(value);
  if (size > 0 && size < 0.5 * std::pow(10.0, 1 - digits)) return fmt::format("{:.2g}", value);
  return fmt::format("{:.{}f}", value, digits);
}

std::string one_side(const std::optional<double>& value, const std::optional<double>& ratio, int digits) {
  if (!value) return "-";
  return ratio ? fmt::format("{} = {:.2f}x", number(*value, digits), *ratio) : number(*value, digits);
}

/// "ours (paper)", each with its ratio.
std::string cell_text(const Cell& cell, const Column& column) {
  const std::string ours =
      cell.ours || cell.note.empty() ? one_side(cell.ours, cell.our_ratio, column.digits) : cell.note;
  if (!cell.paper) return ours;
  return fmt::format("{} ({})", ours, one_side(cell.paper, cell.paper_ratio, column.digits));
}

std::optional<double> ratio(const std::optional<double>& value, const std::optional<double>& baseline) {
  if (!value || !baseline || !(*baseline > 0)) return {};
  return *value / *baseline;
}

std::string csv_number(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : std::string();
}

Json json_number(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

std::string legend(const PaperTable& table) {
  std::string text = "Cells: ours (the paper's).";
  if (!table.baseline.empty()) text += fmt::format(" \"= N x\": over {} of the same run.", table.baseline);
  return text;
}

}  // namespace

void PaperTable::set_ratios_to_column(std::size_t column) {
  for (Row& row : rows) {
    const Cell base = row.cells[column];
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (!columns[c].of_machine) continue;
      row.cells[c].our_ratio = ratio(row.cells[c].ours, base.ours);
      row.cells[c].paper_ratio = ratio(row.cells[c].paper, base.paper);
    }
  }
}

void PaperTable::set_ratios_to_row(const std::function<bool(const Row&)>& is_baseline) {
  std::vector<Cell> base(columns.size());
  for (Row& row : rows) {
    if (is_baseline(row)) base = row.cells;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (!columns[c].of_machine) continue;
      row.cells[c].our_ratio = ratio(row.cells[c].ours, base[c].ours);
      row.cells[c].paper_ratio = ratio(row.cells[c].paper, base[c].paper);
    }
  }
}

std::string text(const PaperTable& table) {
  std::string text = fmt::format("{}: {}\n", table.id, table.title);
  for (const std::string& note : table.notes) text += fmt::format("  {}\n", note);
  text += fmt::format("  {}\n\n", legend(table));
  Table out;
  for (const std::string& label : table.labels) out.column(label, Table::Align::left);
  for (const Column& column : table.columns) out.column(column.name);
  for (const Row& row : table.rows) {
    std::vector<std::string> cells = row.labels;
    for (std::size_t c = 0; c < table.columns.size(); ++c) cells.push_back(cell_text(row.cells[c], table.columns[c]));
    out.row(std::move(cells));
  }
  return text + out.text();
}

std::string markdown(const PaperTable& table) {
  std::string text = fmt::format("## {}: {}\n\n", table.id, table.title);
  for (const std::string& note : table.notes) text += fmt::format("{}\n", note);
  text += fmt::format("{}\n\n|", legend(table));
  std::string rule = "|";
  for (const std::string& label : table.labels) text += fmt::format(" {} |", label), rule += " --- |";
  for (const Column& column : table.columns) text += fmt::format(" {} |", column.name), rule += " ---: |";
  text += fmt::format("\n{}\n", rule);
  for (const Row& row : table.rows) {
    text += "|";
    for (const std::string& label : row.labels) text += fmt::format(" {} |", label);
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      text += fmt::format(" {} |", cell_text(row.cells[c], table.columns[c]));
    text += "\n";
  }
  return text;
}

std::string csv(const PaperTable& table, bool head) {
  std::string text = head ? "table,row,column,ours,paper,our_ratio,paper_ratio,note\n" : "";
  for (const Row& row : table.rows) {
    std::string name;
    for (const std::string& label : row.labels) name += (name.empty() ? "" : "; ") + label;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const Cell& cell = row.cells[c];
      text += fmt::format("{},{},{},{},{},{},{},{}\n", table.id, csv_field(name), csv_field(table.columns[c].name),
                          csv_number(cell.ours), csv_number(cell.paper), csv_number(cell.our_ratio),
                          csv_number(cell.paper_ratio), csv_field(cell.note));
    }
  }
  return text;
}

Json json(const PaperTable& table) {
  Json out{{"id", table.id}, {"title", table.title}, {"notes", table.notes}, {"baseline", table.baseline}};
  out["rows"] = Json::array();
  for (const Row& row : table.rows) {
    Json entry;
    for (std::size_t l = 0; l < table.labels.size(); ++l) entry[table.labels[l]] = row.labels[l];
    Json cells;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const Cell& cell = row.cells[c];
      Json values{{"ours", json_number(cell.ours)}, {"paper", json_number(cell.paper)}};
      if (table.columns[c].of_machine) {
        values["our_ratio"] = json_number(cell.our_ratio);
        values["paper_ratio"] = json_number(cell.paper_ratio);
      }
      if (!cell.note.empty()) values["note"] = cell.note;
      cells[table.columns[c].name] = std::move(values);
    }
    entry["cells"] = std::move(cells);
    out["rows"].push_back(std::move(entry));
  }
  return out;
}

}  // namespace boxwood::program::reproduce
