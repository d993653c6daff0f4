// Reading JSON that nobody has checked: look-ups that give a fallback instead of failing.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "boxwood/base.h"

namespace boxwood::io {

/// Parses one value and the blanks around it. The error's message is a reason ("byte 17 is not what JSON allows
/// there"), without the file. Nesting deeper than 512 is refused, since assimp's reader recurses along it.
Result<nlohmann::json> parse_json(const std::string& text);

/// The array `name` of an object, or an empty one when there is none.
const nlohmann::json& json_array(const nlohmann::json& object, const char* name);

/// The string `name` of an object, or an empty one when there is none.
std::string json_string(const nlohmann::json& object, const char* name);

/// The value as a non-negative integer below 2^53, otherwise `fallback`.
std::uint64_t json_integer(const nlohmann::json& value, std::uint64_t fallback);

/// The member `name` of an object as such an integer, otherwise `fallback`.
std::uint64_t json_integer(const nlohmann::json& object, const char* name, std::uint64_t fallback);

}  // namespace boxwood::io
