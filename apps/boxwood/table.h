// Aligned columns of text: the first column to the left, numbers to the right, heads in one or two lines.
#pragma once

#include <string>
#include <vector>

namespace boxwood::program {

class Table {
 public:
  enum class Align { left, right };

  /// A column. Neighbours with the same non-empty `group` get that word over them.
  void column(std::string head, Align align = Align::right, std::string group = {});
  /// Cells in the order of the columns, as many as there are columns.
  void row(std::vector<std::string> cells);
  std::string text() const;
  /// As a table of Markdown; a group's word stands before the head.
  std::string markdown() const;

 private:
  struct Column {
    std::string head, group;
    Align align;
  };
  std::vector<std::size_t> widths() const;
  std::string group_line(const std::vector<std::size_t>& widths) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace boxwood::program
