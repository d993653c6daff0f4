#include "table.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::program {
namespace {

constexpr std::size_t kGap = 2;

std::string padded(const std::string& text, std::size_t width, Table::Align align) {
  return align == Table::Align::left ? fmt::format("{:<{}}", text, width) : fmt::format("{:>{}}", text, width);
}

/// With room for a dash on both sides.
std::string group_word(const std::string& group) {
  return group.empty() ? group : "- " + group + " -";
}

void end_line(std::string& text, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  text += line + "\n";
}

}  // namespace

void Table::column(std::string head, Align align, std::string group) {
  columns_.push_back({std::move(head), std::move(group), align});
}

void Table::row(std::vector<std::string> cells) {
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> Table::widths() const {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    std::size_t width = columns_[c].head.size();
    for (const auto& row : rows_) width = std::max(width, row[c].size());
    widths.push_back(width);
  }
  // A group's word must fit over its columns.
  for (std::size_t begin = 0, end; begin < columns_.size(); begin = end) {
    std::size_t span = 0;
    for (end = begin; end < columns_.size() && columns_[end].group == columns_[begin].group; ++end)
      span += widths[end] + (end > begin ? kGap : 0);
    const std::size_t word = group_word(columns_[begin].group).size();
    if (word > span) widths[begin] += word - span;
  }
  return widths;
}

std::string Table::group_line(const std::vector<std::size_t>& widths) const {
  std::string line;
  for (std::size_t begin = 0, end; begin < columns_.size(); begin = end) {
    std::size_t span = 0;
    for (end = begin; end < columns_.size() && columns_[end].group == columns_[begin].group; ++end)
      span += widths[end] + (end > begin ? kGap : 0);
    const std::string word = group_word(columns_[begin].group);
    if (begin) line.append(kGap, ' ');
    line += word.empty() ? std::string(span, ' ') : fmt::format("{:-^{}}", word, span);
  }
  return line;
}

std::string Table::text() const {
  const std::vector<std::size_t> width = widths();
  std::string text;
  if (std::any_of(columns_.begin(), columns_.end(), [](const Column& c) { return !c.group.empty(); }))
    end_line(text, group_line(width));
  std::string head;
  for (std::size_t c = 0; c < columns_.size(); ++c)
    head += std::string(c ? kGap : 0, ' ') + padded(columns_[c].head, width[c], columns_[c].align);
  end_line(text, std::move(head));
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c)
      line += std::string(c ? kGap : 0, ' ') + padded(row[c], width[c], columns_[c].align);
    end_line(text, std::move(line));
  }
  return text;
}

std::string Table::markdown() const {
  std::string text = "|", rule = "|";
  for (const Column& column : columns_) {
    text += " " + column.group + (column.group.empty() ? "" : ", ") + column.head + " |";
    rule += column.align == Align::left ? " --- |" : " ---: |";
  }
  text += "\n" + rule + "\n";
  for (const auto& row : rows_) {
    text += "|";
    for (const std::string& cell : row) text += " " + cell + " |";
    text += "\n";
  }
  return text;
}

}  // namespace boxwood::program
