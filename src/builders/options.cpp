// Options of builders: text in, checked values out.
#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

#include "boxwood/builders.h"

namespace boxwood::builders {
namespace {

constexpr OptionSpec kCommonOptions[] = {
    {.key = "cost.traversal",
     .description = "price C_T of visiting an inner node in the surface area heuristic (MacDonald and Booth 1990)",
     .default_value = 1,
     .lowest = 0,
     .highest = 1e6},
    {.key = "cost.intersection",
     .description = "price C_I of testing one primitive in the surface area heuristic (MacDonald and Booth 1990)",
     .default_value = 1.5,
     .lowest = 1e-6,
     .highest = 1e6},
};

std::string text_of(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

std::string text_of(const OptionSpec& spec, double value) {
  return spec.choices.empty() ? text_of(value) : spec.choices[static_cast<std::size_t>(value)];
}

std::string quoted(std::string_view text) {
  return std::string("'").append(text).append("'");
}

/// Every option of a builder: the common ones, then its own.
std::vector<const OptionSpec*> all_options(const BuilderInfo& info) {
  std::vector<const OptionSpec*> specs;
  for (const OptionSpec& spec : common_options()) specs.push_back(&spec);
  for (const OptionSpec& spec : info.options) specs.push_back(&spec);
  return specs;
}

std::string known_builders() {
  std::string list;
  for (const BuilderInfo& row : registry()) list += std::string(list.empty() ? "" : ", ") + row.id;
  return list;
}

Result<double> parse_choice(const OptionSpec& spec, const std::string& where, const std::string& text) {
  std::string list;
  for (std::size_t i = 0; i < spec.choices.size(); ++i) {
    if (text == spec.choices[i]) return static_cast<double>(i);
    list += std::string(list.empty() ? "" : ", ") + spec.choices[i];
  }
  return {ErrorCode::unknown_name, where + " can't be " + quoted(text) + "; choose one of: " + list};
}

Result<double> parse_number(const OptionSpec& spec, const std::string& where, const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc::invalid_argument || end != text.data() + text.size())
    return {ErrorCode::invalid_argument, where + " must be a number, not " + quoted(text)};
  const bool in_range = code == std::errc() && value >= spec.lowest && value <= spec.highest;  // false for NaN
  if (!in_range || (spec.integer && value != std::floor(value)))
    return {ErrorCode::out_of_range, where + " must be a " + (spec.integer ? "whole number" : "number") + " from " +
                                         text_of(spec.lowest) + " to " + text_of(spec.highest) + ", not " +
                                         quoted(text)};
  return value;
}

}  // namespace

std::span<const OptionSpec> common_options() {
  return kCommonOptions;
}

const OptionValues::Entry& OptionValues::entry(std::string_view key) const {
  for (const Entry& entry : entries_)
    if (key == entry.spec->key) return entry;
  assert(!"an option that the builder does not have");
  static constexpr OptionSpec kNone{.key = "", .description = ""};
  static constexpr Entry kNothing{&kNone, 0};
  return kNothing;
}

double OptionValues::number(std::string_view key) const {
  return entry(key).value;
}

std::uint32_t OptionValues::integer(std::string_view key) const {
  assert(entry(key).spec->integer);
  return static_cast<std::uint32_t>(entry(key).value);
}

std::size_t OptionValues::choice(std::string_view key) const {
  assert(!entry(key).spec->choices.empty());
  return static_cast<std::size_t>(entry(key).value);
}

bool OptionValues::has(std::string_view key) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) { return key == entry.spec->key; });
}

void OptionValues::set(std::string_view key, double value) {
  for (Entry& entry : entries_)
    if (key == entry.spec->key) entry.value = value;
}

tree::CostModel OptionValues::cost() const {
  return {static_cast<float>(number("cost.traversal")), static_cast<float>(number("cost.intersection"))};
}

std::vector<std::pair<std::string, std::string>> OptionValues::echo() const {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const Entry& entry : entries_) pairs.emplace_back(entry.spec->key, text_of(*entry.spec, entry.value));
  return pairs;
}

Result<OptionValues> resolve_options(std::string_view builder, const std::map<std::string, std::string>& settings) {
  try {
    const BuilderInfo* info = find(builder);
    if (!info)
      return {ErrorCode::unknown_name, "unknown builder " + quoted(builder) + "; there are: " + known_builders()};
    const std::vector<const OptionSpec*> specs = all_options(*info);

    OptionValues values;
    std::string known;
    for (const OptionSpec* spec : specs) {
      values.entries_.push_back({spec, spec->choices.empty() ? spec->default_value : 0});
      known += std::string(known.empty() ? "" : ", ") + spec->key;
    }
    for (const auto& [key, text] : settings) {
      OptionValues::Entry* entry = nullptr;
      for (OptionValues::Entry& candidate : values.entries_)
        if (key == candidate.spec->key) entry = &candidate;
      if (!entry)
        return {ErrorCode::unknown_name,
                "builder " + quoted(builder) + " has no option " + quoted(key) + "; it has: " + known};
      const std::string where = "option " + quoted(key) + " of builder " + quoted(builder);
      const Result<double> value = entry->spec->choices.empty() ? parse_number(*entry->spec, where, text)
                                                                : parse_choice(*entry->spec, where, text);
      if (!value) return value.error();
      entry->value = *value;
    }
    return values;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while reading the options of a builder"};
  }
}

}  // namespace boxwood::builders
