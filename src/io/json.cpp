#include "io/json.h"

namespace boxwood::io {
namespace {

constexpr int kDeepestNesting = 512;

/// Thrown out of the parser's callback, which has no other way to stop it.
struct TooDeep {};

}  // namespace

Result<nlohmann::json> parse_json(const std::string& text) {
  using Event = nlohmann::json::parse_event_t;
  const auto check_depth = [](int depth, Event, nlohmann::json&) {
    if (depth > kDeepestNesting) throw TooDeep();
    return true;
  };
  try {
    return nlohmann::json::parse(text, check_depth);
  } catch (const TooDeep&) {
    return Result<nlohmann::json>(ErrorCode::unsupported, "its JSON is nested deeper than 512 levels");
  } catch (const nlohmann::json::parse_error& error) {
    return Result<nlohmann::json>(ErrorCode::malformed, "byte " + std::to_string(error.byte > 0 ? error.byte - 1 : 0) +
                                                            " of its JSON is not what JSON allows there");
  } catch (const nlohmann::json::exception&) {
    return Result<nlohmann::json>(ErrorCode::malformed, "a number in its JSON is too large");
  }
}

const nlohmann::json& json_array(const nlohmann::json& object, const char* name) {
  static const nlohmann::json kNone = nlohmann::json::array();
  if (!object.is_object()) return kNone;
  const auto member = object.find(name);
  return member != object.end() && member->is_array() ? *member : kNone;
}

std::string json_string(const nlohmann::json& object, const char* name) {
  if (!object.is_object()) return {};
  const auto member = object.find(name);
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

std::uint64_t json_integer(const nlohmann::json& value, std::uint64_t fallback) {
  constexpr double kLimit = 9007199254740992.0;  // 2^53
  if (!value.is_number()) return fallback;
  const double number = value.get<double>();
  const bool whole =
      number >= 0 && number < kLimit && number == static_cast<double>(static_cast<std::uint64_t>(number));
  return whole ? static_cast<std::uint64_t>(number) : fallback;
}

std::uint64_t json_integer(const nlohmann::json& object, const char* name, std::uint64_t fallback) {
  if (!object.is_object()) return fallback;
  const auto member = object.find(name);
  return member == object.end() ? fallback : json_integer(*member, fallback);
}

}  // namespace boxwood::io
