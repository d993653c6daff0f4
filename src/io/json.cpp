// JSON (RFC 8259), iterative: open arrays and objects wait on a stack of our own, so nesting can't exhaust the
// thread's. Lenient where it does no harm (a comma before a closing bracket, any bytes within strings). O(size).
#include "io/json.h"

#include <charconv>
#include <string>

namespace boxwood::io {
namespace {

constexpr std::size_t kDeepest = 512;

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<JsonValue> parse() {
    do {
      skip_blanks();
      if (!open_.empty() && closes_here()) continue;
      if (!open_.empty() && open_.back().kind == JsonValue::Kind::object && !read_name()) return fail();
      if (open_.size() >= kDeepest) return {ErrorCode::unsupported, "its JSON is nested deeper than 512 levels"};
      if (!read_value()) return fail();
    } while (!open_.empty());
    skip_blanks();
    if (at_ != text_.size()) return fail();
    return std::move(root_);
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || (text_[at_] >= '\t' && text_[at_] <= '\r'))) ++at_;
  }

  bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }

  bool closes_here() {
    if (!next_is(open_.back().kind == JsonValue::Kind::object ? '}' : ']')) return false;
    ++at_;
    JsonValue closed = std::move(open_.back());
    open_.pop_back();
    place(std::move(closed));
    return true;
  }

  // Puts a finished value where it belongs, and moves over the comma behind it.
  void place(JsonValue value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return;
    }
    open_.back().items.push_back(std::move(value));
    skip_blanks();
    if (next_is(',')) ++at_;
  }

  bool read_name() {
    std::string_view name;
    if (!read_string(name)) return false;
    skip_blanks();
    if (!next_is(':')) return false;
    ++at_;
    skip_blanks();
    open_.back().names.push_back(name);
    return true;
  }

  bool read_value() {
    JsonValue value;
    if (next_is('{') || next_is('[')) {
      value.kind = text_[at_++] == '{' ? JsonValue::Kind::object : JsonValue::Kind::array;
      open_.push_back(std::move(value));
      return true;
    }
    if (next_is('"')) {
      value.kind = JsonValue::Kind::string;
      if (!read_string(value.string)) return false;
    } else if (!read_word(value)) {
      return false;
    }
    place(std::move(value));
    return true;
  }

  bool read_string(std::string_view& string) {
    if (!next_is('"')) return false;
    const std::size_t begin = ++at_;
    for (;; ++at_) {
      at_ = text_.find_first_of("\"\\", at_);
      if (at_ == text_.npos) return at_ = text_.size(), false;
      if (text_[at_] == '"') break;
      if (++at_ >= text_.size()) return false;
    }
    string = text_.substr(begin, at_ - begin);
    ++at_;
    return true;
  }

  bool read_word(JsonValue& value) {
    for (const auto& [word, kind, number] :
         {Word{"null", JsonValue::Kind::null, 0}, Word{"false", JsonValue::Kind::boolean, 0},
          Word{"true", JsonValue::Kind::boolean, 1}, Word{"NaN", JsonValue::Kind::null, 0}}) {
      if (!text_.substr(at_).starts_with(word)) continue;
      value.kind = kind;
      value.number = number;
      at_ += word.size();
      return true;
    }
    const char* begin = text_.data() + at_;
    const auto parsed = std::from_chars(begin, text_.data() + text_.size(), value.number);
    if (parsed.ec == std::errc::invalid_argument) return false;
    value.kind = JsonValue::Kind::number;
    at_ += static_cast<std::size_t>(parsed.ptr - begin);
    return true;
  }

  struct Word {
    std::string_view text;
    JsonValue::Kind kind;
    double number;
  };

  Error fail() const {
    if (at_ >= text_.size()) return {ErrorCode::malformed, "it is truncated: its JSON ends within a value"};
    return {ErrorCode::malformed, "byte " + std::to_string(at_) + " of its JSON is not what JSON allows there"};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<JsonValue> open_;
  JsonValue root_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view name) const {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return &items[i];
  return nullptr;
}

const std::vector<JsonValue>& JsonValue::array(std::string_view name) const {
  static const std::vector<JsonValue> kNone;
  const JsonValue* value = find(name);
  return value && value->kind == Kind::array ? value->items : kNone;
}

std::uint64_t JsonValue::integer_or(std::uint64_t fallback) const {
  if (kind != Kind::number || !(number >= 0 && number < 9007199254740992.0)) return fallback;
  return static_cast<std::uint64_t>(number);
}

std::uint64_t JsonValue::integer(std::string_view name, std::uint64_t fallback) const {
  const JsonValue* value = find(name);
  return value ? value->integer_or(fallback) : fallback;
}

Result<JsonValue> parse_json(std::string_view text) {
  return Parser(text).parse();
}

}  // namespace boxwood::io
