// Text to numbers and back: strict readers for what people type, writers for what reports show.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/math.h"

namespace boxwood::program {

/// The parts between separators; one empty part for an empty text.
std::vector<std::string> split(std::string_view text, char separator);

/// A whole number without sign. `what` names it in the error: "triangles".
Result<std::uint64_t> parse_integer(std::string_view text, std::string_view what);
/// A finite number.
Result<float> parse_number(std::string_view text, std::string_view what);
/// Three finite numbers, "x:y:z".
Result<Vec3> parse_vector(std::string_view text, std::string_view what);
/// "width x height" in pixels, both from 1 to 16384: "1024x768".
Result<std::pair<int, int>> parse_size(std::string_view text);
/// "key=value", split at the first '='. Neither may be empty.
Result<std::pair<std::string, std::string>> parse_setting(std::string_view text);
/// Several of them; a key given twice is an error.
Result<std::map<std::string, std::string>> parse_settings(const std::vector<std::string>& texts);

/// 1234567 as "1,234,567".
std::string with_thousands(std::uint64_t value);
/// A 64-bit hash as 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);
/// "x:y:z" with as many digits as reading it back to the same bits needs.
std::string vector_text(Vec3 v);
/// A field of a CSV line: in quotes when it needs them.
std::string csv_field(const std::string& text);
/// Everything on one line: line breaks and what surrounds them become single spaces.
std::string one_line(std::string_view text);

}  // namespace boxwood::program
