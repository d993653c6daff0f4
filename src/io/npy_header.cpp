// NumPy's array format (NEP 1; Kern 2007), versions 1.0 to 3.0: magic, version, header length, a Python dictionary.
#include "io/npy_header.h"

#include <charconv>
#include <cstring>
#include <string_view>

#include "io/sentence.h"

namespace boxwood::io {
namespace {

constexpr char kMagic[] = {'\x93', 'N', 'U', 'M', 'P', 'Y'};
constexpr std::size_t kAlignment = 64;
// NumPy itself trusts no header beyond 10,000 bytes.
constexpr std::uint64_t kLongestHeader = 1 << 20;

// Just as much of Python's literals as NumPy writes: one dictionary of strings, booleans, tuples, and types in
// brackets.
class DictionaryParser {
 public:
  explicit DictionaryParser(std::string_view text) : text_(text) {}

  bool parse(NpyHeader& header) {
    if (!take('{')) return false;
    while (!take('}')) {
      std::string key;
      if (!take_string(key) || !take(':') || !parse_member(key, header)) return false;
      if (!take(',') && !peek('}')) return false;
    }
    skip_blanks();
    return at_ == text_.size() && has_type_ && has_order_ && has_shape_;
  }

 private:
  bool parse_member(const std::string& key, NpyHeader& header) {
    if (key == "descr") return has_type_ = take_type(header.type);
    if (key == "fortran_order") return has_order_ = take_boolean(header.fortran_order);
    if (key == "shape") return has_shape_ = take_shape(header.shape);
    return false;
  }

  void skip_blanks() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }

  bool peek(char c) {
    skip_blanks();
    return at_ < text_.size() && text_[at_] == c;
  }

  bool take(char c) { return peek(c) && ++at_; }

  bool take_string(std::string& string) {
    if (!peek('\'') && !peek('"')) return false;
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == text_.npos) return false;
    string = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return true;
  }

  // A string, or the list of a structured type, kept as text up to its last bracket.
  bool take_type(std::string& type) {
    if (!peek('[')) return take_string(type);
    const std::size_t begin = at_;
    std::size_t depth = 0;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '[') ++depth;
      if (text_[at_] == ']' && --depth == 0) {
        type = text_.substr(begin, ++at_ - begin);
        return true;
      }
    }
    return false;
  }

  bool take_boolean(bool& value) {
    skip_blanks();
    for (const auto& [word, meaning] : {std::pair<std::string_view, bool>{"True", true}, {"False", false}}) {
      if (!text_.substr(at_).starts_with(word)) continue;
      value = meaning;
      at_ += word.size();
      return true;
    }
    return false;
  }

  bool take_shape(std::vector<std::uint64_t>& shape) {
    if (!take('(')) return false;
    shape.clear();
    while (!take(')')) {
      skip_blanks();
      std::uint64_t length = 0;
      const auto parsed = std::from_chars(text_.data() + at_, text_.data() + text_.size(), length);
      if (parsed.ec != std::errc()) return false;
      at_ = static_cast<std::size_t>(parsed.ptr - text_.data());
      take('L');  // long integers of Python 2
      shape.push_back(length);
      if (!take(',') && !peek(')')) return false;
    }
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool has_type_ = false, has_order_ = false, has_shape_ = false;
};

}  // namespace

std::string NpyHeader::shape_text() const {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) text += (i ? ", " : "") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

Result<NpyHeader> read_npy_header(FileReader& file, const std::filesystem::path& path) {
  const auto fail = [&](const std::string& reason) {
    return file.system_error() ? read_error(path, file.system_error()) : read_error(ErrorCode::malformed, path, reason);
  };
  if (!file.prepare(sizeof(kMagic)) || std::memcmp(file.data(), kMagic, sizeof(kMagic)) != 0) {
    const bool is_archive = file.prepare(2) && std::memcmp(file.data(), "PK", 2) == 0;
    return fail(is_archive ? "it is an archive of arrays (.npz), one array (.npy) is needed"
                           : "it is no NumPy file (.npy)");
  }
  if (!file.prepare(10)) return fail("it is truncated within its header");
  const unsigned char* bytes = file.data();
  const int version = bytes[6];
  if (version < 1 || version > 3 || bytes[7] != 0)
    return fail("its format version " + std::to_string(version) + "." + std::to_string(bytes[7]) +
                " is not 1.0, 2.0 or 3.0");
  std::uint64_t size = bytes[8] | bytes[9] << 8;
  if (version > 1) {
    if (!file.prepare(12)) return fail("it is truncated within its header");
    size |= file.data()[10] << 16 | std::uint64_t{file.data()[11]} << 24;
  }
  file.consume(version > 1 ? 12 : 10);
  if (size > kLongestHeader) return fail("its header has " + std::to_string(size) + " bytes, beyond all measure");
  std::string text;
  for (; text.size() < size; file.consume(1)) {
    if (!file.prepare(1)) return fail("it is truncated within its header");
    text += static_cast<char>(*file.data());
  }
  NpyHeader header;
  if (!DictionaryParser(text).parse(header)) return fail("its header is not one of NumPy's: " + one_line(text));
  return header;
}

std::string make_npy_header(const std::string& type, const std::vector<std::uint64_t>& shape) {
  NpyHeader header;
  header.shape = shape;
  std::string dictionary = "{'descr': " + type + ", 'fortran_order': False, 'shape': " + header.shape_text() + ", }";
  constexpr std::size_t kFront = sizeof(kMagic) + 4;
  while ((kFront + dictionary.size() + 1) % kAlignment != 0) dictionary += ' ';
  dictionary += '\n';
  std::string text(kMagic, sizeof(kMagic));
  text += {'\1', '\0', static_cast<char>(dictionary.size() & 0xff), static_cast<char>(dictionary.size() >> 8)};
  return text + dictionary;
}

}  // namespace boxwood::io
