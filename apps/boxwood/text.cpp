#include "text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace boxwood::program {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.emplace_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

Result<std::uint64_t> parse_integer(std::string_view text, std::string_view what) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)
    return {ErrorCode::out_of_range, fmt::format("{} is {}, which is more than 64 bits hold", what, text)};
  if (error != std::errc() || end != text.data() + text.size())
    return {ErrorCode::invalid_argument, fmt::format("{} must be a whole number, not '{}'", what, text)};
  return value;
}

Result<float> parse_number(std::string_view text, std::string_view what) {
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return {ErrorCode::invalid_argument, fmt::format("{} must be a finite number, not '{}'", what, text)};
  return value;
}

Result<Vec3> parse_vector(std::string_view text, std::string_view what) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 3)
    return {ErrorCode::invalid_argument, fmt::format("{} must be three numbers x:y:z, not '{}'", what, text)};
  Vec3 v;
  for (int axis = 0; axis < 3; ++axis) {
    const Result<float> number = parse_number(parts[axis], what);
    if (!number) return number.error();
    v[axis] = *number;
  }
  return v;
}

Result<std::pair<int, int>> parse_size(std::string_view text) {
  const std::vector<std::string> parts = split(text, 'x');
  if (parts.size() != 2)
    return {ErrorCode::invalid_argument, fmt::format("the size must be WIDTHxHEIGHT such as 1024x768, not '{}'", text)};
  int sides[2];
  for (int i = 0; i < 2; ++i) {
    const Result<std::uint64_t> side = parse_integer(parts[i], i == 0 ? "the width" : "the height");
    if (!side) return side.error();
    if (*side < 1 || *side > 16384)
      return {ErrorCode::out_of_range,
              fmt::format("the {} must be from 1 to 16384 pixels, not {}", i == 0 ? "width" : "height", *side)};
    sides[i] = static_cast<int>(*side);
  }
  return std::pair{sides[0], sides[1]};
}

Result<std::pair<std::string, std::string>> parse_setting(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    return {ErrorCode::invalid_argument, fmt::format("'{}' is not of the form key=value", text)};
  return std::pair{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Result<std::map<std::string, std::string>> parse_settings(const std::vector<std::string>& texts) {
  std::map<std::string, std::string> settings;
  for (const std::string& text : texts) {
    auto setting = parse_setting(text);
    if (!setting) return setting.error();
    if (!settings.insert(*setting).second)
      return {ErrorCode::invalid_argument, fmt::format("the key '{}' is given twice", setting->first)};
  }
  return settings;
}

std::string with_thousands(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3;) digits.insert(i -= 3, 1, ',');
  return digits;
}

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

std::string vector_text(Vec3 v) {
  return fmt::format("{}:{}:{}", v.x, v.y, v.z);
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool is_break = c == '\n' || c == '\r' || c == '\t';
    if (!is_break)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace boxwood::program
