// The registry of pre-splits, its text form, and the entry that runs one.
#include <cassert>
#include <charconv>

#include "refs/presplit_list.h"
#include "refs/presplit_passes.h"

namespace boxwood::refs {
namespace {

constexpr PresplitInfo kNone = {
    .id = "none",
    .summary = "one reference per triangle",
    .paper = "",
    .options = {},
    .subdivides = false,
    .apply = nullptr,
};

std::string quoted(std::string_view text) {
  return std::string("'").append(text).append("'");
}

std::string text_of(double value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string known_ids() {
  std::string list;
  for (const PresplitInfo& row : presplits()) list += std::string(list.empty() ? "" : ", ") + row.id;
  return list;
}

std::string known_options(const PresplitInfo& info) {
  std::string list;
  for (const PresplitOption& option : info.options) list += std::string(list.empty() ? "" : ", ") + option.key;
  return list.empty() ? "it has none" : "it has: " + list;
}

/// The text up to the next colon or comma, which are taken off `rest`.
std::string_view next_word(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of(":,"), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return word;
}

Result<double> parse_value(const PresplitOption& option, const std::string& where, std::string_view text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc::invalid_argument || end != text.data() + text.size())
    return {ErrorCode::invalid_argument, where + " must be a number, not " + quoted(text)};
  if (code != std::errc() || !(value >= option.lowest && value <= option.highest))
    return {ErrorCode::out_of_range, where + " must be from " + text_of(option.lowest) + " to " +
                                         text_of(option.highest) + ", not " + quoted(text)};
  return value;
}

Status parse_option(std::string_view word, Presplit& presplit, std::vector<bool>& given) {
  const PresplitInfo& info = *presplit.info;
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos)
    return {ErrorCode::invalid_argument, "the pre-split " + quoted(info.id) + " can't read " + quoted(word) +
                                             ", which is not of the form key=value; " + known_options(info) +
                                             "; pre-splits are: " + known_ids()};
  const std::string_view key = word.substr(0, equals);
  for (std::size_t i = 0; i < info.options.size(); ++i) {
    if (key != info.options[i].key) continue;
    const std::string where = "option " + quoted(key) + " of the pre-split " + quoted(info.id);
    if (given[i]) return {ErrorCode::invalid_argument, where + " is given twice"};
    const Result<double> value = parse_value(info.options[i], where, word.substr(equals + 1));
    if (!value) return value.error();
    presplit.values[i] = *value;
    given[i] = true;
    return {};
  }
  return {ErrorCode::unknown_name,
          "the pre-split " + quoted(info.id) + " has no option " + quoted(key) + "; " + known_options(info)};
}

void use(Presplit& presplit, const PresplitInfo& info) {
  presplit.info = &info;
  presplit.values.clear();
  for (const PresplitOption& option : info.options) presplit.values.push_back(option.default_value);
}

const PresplitInfo* find(std::string_view id) {
  for (const PresplitInfo& row : presplits())
    if (id == row.id) return &row;
  return nullptr;
}

}  // namespace

std::span<const PresplitInfo> presplits() {
  static const PresplitInfo rows[] = {kNone, edge_volume_presplit, automatic_edge_volume_presplit,
                                      local_edge_volume_presplit, early_split_clipping_presplit};
  return rows;
}

Presplit::Presplit() : info(&presplits()[0]) {}

double Presplit::value(std::string_view key) const {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (key == info->options[i].key) return values[i];
  assert(!"an option that the pre-split does not have");
  return 0;
}

std::string Presplit::text() const {
  std::string text = info->id;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool has_colon = text.find(':') != std::string::npos;
    text += (has_colon ? "," : ":") + std::string(info->options[i].key) + "=" + text_of(values[i]);
  }
  return text;
}

Result<Presplit> parse_presplit(std::string_view text) {
  try {
    std::string_view rest = text;
    const std::string_view method = next_word(rest);
    const PresplitInfo* info = find(method);
    if (!info) return {ErrorCode::unknown_name, "unknown pre-split " + quoted(method) + "; there are: " + known_ids()};
    if (text.ends_with(':') || text.ends_with(','))
      return {ErrorCode::invalid_argument, "the pre-split " + quoted(text) + " ends in a separator"};
    // A word without '=' is a variant: evh:auto.
    const std::string_view variant =
        text.substr(0, text.size() - rest.size() + std::min(rest.find_first_of(":,"), rest.size()));
    if (const PresplitInfo* row = find(variant); row && !rest.empty()) {
      info = row;
      next_word(rest);
    }
    Presplit presplit;
    use(presplit, *info);
    std::vector<bool> given(info->options.size());
    while (!rest.empty())
      if (const Status status = parse_option(next_word(rest), presplit, given); !status) return status.error();
    return presplit;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while reading a pre-split"};
  }
}

Result<ReferenceSet> apply_presplit(ReferenceSet&& set, const MeshView& mesh, const Presplit& presplit,
                                    Executor& executor, PresplitReport* report) {
  try {
    ReferenceSet split = std::move(set);
    PresplitReport own;
    PresplitReport& filled = report ? *report : own;
    filled = {};
    filled.references_before = split.references.size();
    if (!presplit.is_none()) {
      if (!split.primitives) split.primitives = triangle_primitives(mesh);
      if (const Status status = presplit.info->apply(split, mesh, presplit, executor, filled); !status)
        return status.error();
    }
    filled.references_after = split.references.size();
    return split;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory for the references of the pre-split '" + presplit.text() + "'"};
  }
}

}  // namespace boxwood::refs
