// Text for a method with options, "evh:t=14" or "reinsertion:passes=4,gain=0.01", for the registries of methods whose
// options are numbers. A row has an `id` ("evh", or with a variant "evh:auto") and `options`, each with `key`,
// `default_value`, `lowest`, `highest` and perhaps `integer`.
#pragma once

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/base.h"

namespace boxwood {

inline std::string quoted(std::string_view text) {
  return std::string("'").append(text).append("'");
}

inline std::string text_of(double value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

/// Reads such text. `kind` is what errors call a row: "pre-split".
template <class Row>
class MethodParser {
 public:
  struct Parsed {
    const Row* row;
    std::vector<double> values;
  };

  MethodParser(std::string_view kind, std::span<const Row> rows) : kind_(kind), rows_(rows) {}

  Result<Parsed> parse(std::string_view text) const {
    std::string_view rest = text;
    const std::string_view method = next_word(rest);
    const Row* row = find(method);
    if (!row)
      return {ErrorCode::unknown_name, "unknown " + kind_ + " " + quoted(method) + "; there are: " + known_ids()};
    if (text.ends_with(':') || text.ends_with(','))
      return {ErrorCode::invalid_argument, "the " + kind_ + " " + quoted(text) + " ends in a separator"};
    // A word without '=' is a variant: evh:auto.
    const std::string_view variant =
        text.substr(0, text.size() - rest.size() + std::min(rest.find_first_of(":,"), rest.size()));
    if (const Row* other = find(variant); other && !rest.empty()) {
      row = other;
      next_word(rest);
    }
    Parsed parsed{row, {}};
    for (const auto& option : row->options) parsed.values.push_back(option.default_value);
    std::vector<bool> given(row->options.size());
    while (!rest.empty())
      if (const Status status = parse_option(next_word(rest), parsed, given); !status) return status.error();
    return parsed;
  }

 private:
  const Row* find(std::string_view id) const {
    for (const Row& row : rows_)
      if (id == row.id) return &row;
    return nullptr;
  }

  std::string known_ids() const {
    std::string list;
    for (const Row& row : rows_) list += std::string(list.empty() ? "" : ", ") + row.id;
    return list;
  }

  static std::string known_options(const Row& row) {
    std::string list;
    for (const auto& option : row.options) list += std::string(list.empty() ? "" : ", ") + option.key;
    return list.empty() ? "it has none" : "it has: " + list;
  }

  /// The text up to the next colon or comma, which are taken off `rest`.
  static std::string_view next_word(std::string_view& rest) {
    const std::size_t end = std::min(rest.find_first_of(":,"), rest.size());
    const std::string_view word = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return word;
  }

  template <class Option>
  static Result<double> parse_value(const Option& option, const std::string& where, std::string_view text) {
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code == std::errc::invalid_argument || end != text.data() + text.size())
      return {ErrorCode::invalid_argument, where + " must be a number, not " + quoted(text)};
    if (code != std::errc() || !(value >= option.lowest && value <= option.highest))
      return {ErrorCode::out_of_range, where + " must be from " + text_of(option.lowest) + " to " +
                                           text_of(option.highest) + ", not " + quoted(text)};
    if constexpr (requires { option.integer; })
      if (option.integer && value != std::floor(value))
        return {ErrorCode::invalid_argument, where + " must be a whole number, not " + quoted(text)};
    return value;
  }

  Status parse_option(std::string_view word, Parsed& parsed, std::vector<bool>& given) const {
    const Row& row = *parsed.row;
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos)
      return {ErrorCode::invalid_argument, "the " + kind_ + " " + quoted(row.id) + " can't read " + quoted(word) +
                                               ", which is not of the form key=value; " + known_options(row) + "; " +
                                               kind_ + "s are: " + known_ids()};
    const std::string_view key = word.substr(0, equals);
    for (std::size_t i = 0; i < row.options.size(); ++i) {
      if (key != row.options[i].key) continue;
      const std::string where = "option " + quoted(key) + " of the " + kind_ + " " + quoted(row.id);
      if (given[i]) return {ErrorCode::invalid_argument, where + " is given twice"};
      const Result<double> value = parse_value(row.options[i], where, word.substr(equals + 1));
      if (!value) return value.error();
      parsed.values[i] = *value;
      given[i] = true;
      return {};
    }
    return {ErrorCode::unknown_name,
            "the " + kind_ + " " + quoted(row.id) + " has no option " + quoted(key) + "; " + known_options(row)};
  }

  std::string kind_;
  std::span<const Row> rows_;
};

/// The value of an option that the row must have.
template <class Row>
double method_value(const Row& row, const std::vector<double>& values, std::string_view key) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (key == row.options[i].key) return values[i];
  assert(!"an option that the method does not have");
  return 0;
}

/// What MethodParser reads, every option with its value.
template <class Row>
std::string method_text(const Row& row, const std::vector<double>& values) {
  std::string text = row.id;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool has_colon = text.find(':') != std::string::npos;
    text += (has_colon ? "," : ":") + std::string(row.options[i].key) + "=" + text_of(values[i]);
  }
  return text;
}

}  // namespace boxwood
