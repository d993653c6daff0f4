// A small JSON reader for checks before a file is handed to a library: it never recurses and copies no text.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "boxwood/base.h"

namespace boxwood::io {

/// One value. Strings and keys are views into the text, with their escapes as they stand there.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

  Kind kind = Kind::null;
  double number = 0;  ///< also 0 or 1 for booleans
  std::string_view string;
  std::vector<JsonValue> items;         ///< of an array, or the values of an object
  std::vector<std::string_view> names;  ///< of an object, as many as items

  /// The member of an object, or null when it has none of that name or is no object.
  const JsonValue* find(std::string_view name) const;

  /// The member's items if it is an array, otherwise an empty list.
  const std::vector<JsonValue>& array(std::string_view name) const;

  /// The member as a non-negative integer below 2^53, otherwise `fallback`.
  std::uint64_t integer(std::string_view name, std::uint64_t fallback) const;

  /// The value itself as such an integer, otherwise `fallback`.
  std::uint64_t integer_or(std::uint64_t fallback) const;
};

/// Parses one value and the blanks around it. `text` must outlive the result. The error's message is a reason
/// ("byte 17 is not what JSON allows there"), without the file. Nesting deeper than 512 is refused.
Result<JsonValue> parse_json(std::string_view text);

}  // namespace boxwood::io
