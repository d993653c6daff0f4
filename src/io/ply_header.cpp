#include "io/ply_header.h"

#include <array>
#include <charconv>
#include <utility>

#include "io/sentence.h"

namespace boxwood::io {
namespace {

// Real headers have some hundred bytes; the limits only stop a wrong file from being read as one endless header.
constexpr std::size_t kLongestLine = 2048;
constexpr std::size_t kMostLines = 100000;
constexpr std::size_t kMostEntries = 4096;  // elements, and properties of one; searched linearly

constexpr std::pair<std::string_view, PlyType> kTypeNames[] = {
    {"char", PlyType::int8},       {"uchar", PlyType::uint8},    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},   {"int", PlyType::int32},      {"uint", PlyType::uint32},
    {"float", PlyType::float32},   {"double", PlyType::float64}, {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},     {"int16", PlyType::int16},    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},     {"uint32", PlyType::uint32},  {"float32", PlyType::float32},
    {"float64", PlyType::float64},
};

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_blank(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    if (i > begin) words.push_back(line.substr(begin, i - begin));
  }
  return words;
}

class HeaderParser {
 public:
  HeaderParser(FileReader& file, const std::filesystem::path& path) : file_(file), path_(path) {}

  Result<PlyHeader> parse() {
    if (!file_.prepare(4) || !begins_like_ply({reinterpret_cast<const char*>(file_.data()), 4}))
      return fail("it does not begin with the line 'ply'");
    // A header of old Macintosh lines has to be told from CR LF before its end: data may follow the last CR.
    const unsigned char* first = file_.data();
    terminator_ = first[3] == '\r' && !(file_.prepare(5) && file_.data()[4] == '\n') ? '\r' : '\n';
    for (line_number_ = 1; line_number_ <= kMostLines; ++line_number_) {
      if (!next_line()) return fail_at_end();
      if (line_number_ == 1) continue;
      const auto words = split_words(line_);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return finish();
      if (Status status = parse_line(words); !status) return status.error();
    }
    return fail("its header has more than " + std::to_string(kMostLines) + " lines");
  }

 private:
  bool next_line() {
    line_.clear();
    while (file_.prepare(1) && line_.size() <= kLongestLine) {
      const char c = static_cast<char>(*file_.data());
      file_.consume(1);
      if (c == terminator_) {
        if (!line_.empty() && line_.back() == '\r') line_.pop_back();
        return true;
      }
      line_ += c;
    }
    return false;
  }

  Status parse_line(const std::vector<std::string_view>& words) {
    if (words[0] == "format") return parse_format(words);
    if (words[0] == "element") return parse_element(words);
    if (words[0] == "property") return parse_property(words);
    return fail_in_line("begins with '" + one_line(words[0]) + "', which no PLY header line does");
  }

  Status parse_format(const std::vector<std::string_view>& words) {
    constexpr std::array<std::string_view, 3> kNames{"ascii", "binary_little_endian", "binary_big_endian"};
    if (has_format_) return fail_in_line("names the format a second time");
    if (words.size() != 3 || words[2] != "1.0") return fail_in_line("does not name format and version 1.0");
    for (std::size_t i = 0; i < kNames.size(); ++i)
      if (words[1] == kNames[i]) header_.format = static_cast<PlyFormat>(i), has_format_ = true;
    if (!has_format_) return fail_in_line("names the unknown format '" + one_line(words[1]) + "'");
    return {};
  }

  Status parse_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) return fail_in_line("does not have the form 'element NAME COUNT'");
    PlyElement element{std::string(words[1]), 0, {}};
    const char* end = words[2].data() + words[2].size();
    const auto parsed = std::from_chars(words[2].data(), end, element.count);
    if (parsed.ec != std::errc() || parsed.ptr != end)
      return fail_in_line("gives the count '" + one_line(words[2]) + "', which is no number from 0 to 2^64 - 1");
    if (header_.elements.size() >= kMostEntries) return fail_in_line("has one element too many, 4096 are the limit");
    if (header_.find(words[1])) return fail_in_line("names the element '" + one_line(words[1]) + "' a second time");
    header_.elements.push_back(std::move(element));
    return {};
  }

  Status parse_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) return fail_in_line("has a property before any element");
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (!property.is_list && words.size() != 3)
      return fail_in_line("has neither the form 'property TYPE NAME' nor 'property list TYPE TYPE NAME'");
    if (property.is_list) {
      if (!parse_type(words[2], property.count_type)) return fail_type(words[2]);
      if (!is_integer(property.count_type)) return fail_in_line("has a list whose length is not an integer");
    }
    if (!parse_type(words[words.size() - 2], property.type)) return fail_type(words[words.size() - 2]);
    property.name = words.back();
    PlyElement& element = header_.elements.back();
    if (element.properties.size() >= kMostEntries) return fail_in_line("has one property too many, 4096 are the limit");
    if (element.find(property.name))
      return fail_in_line("names the property '" + one_line(property.name) + "' a second time");
    element.properties.push_back(std::move(property));
    return {};
  }

  static bool parse_type(std::string_view name, PlyType& type) {
    for (const auto& [known, value] : kTypeNames)
      if (name == known) return type = value, true;
    return false;
  }

  Result<PlyHeader> finish() {
    if (!has_format_) return fail("its header has no format line");
    return std::move(header_);
  }

  Error fail(const std::string& reason) const { return read_error(ErrorCode::malformed, path_, reason); }
  Status fail_in_line(const std::string& reason) const {
    return fail("line " + std::to_string(line_number_) + " of its header " + reason);
  }
  Status fail_type(std::string_view name) const {
    return fail_in_line("has the unknown type '" + one_line(name) + "'");
  }
  Error fail_at_end() const {
    if (file_.system_error()) return read_error(path_, file_.system_error());
    if (line_.size() > kLongestLine)
      return fail("line " + std::to_string(line_number_) + " of its header is longer than " +
                  std::to_string(kLongestLine) + " bytes");
    return fail("it is truncated: the header has no end_header line");
  }

  FileReader& file_;
  const std::filesystem::path& path_;
  PlyHeader header_;
  std::string line_;
  std::size_t line_number_ = 0;
  char terminator_ = '\n';
  bool has_format_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

const PlyProperty* PlyElement::find(std::string_view property) const {
  for (const PlyProperty& p : properties)
    if (p.name == property) return &p;
  return nullptr;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& e : elements)
    if (e.name == element) return &e;
  return nullptr;
}

bool begins_like_ply(std::string_view bytes) {
  return bytes.size() >= 4 && bytes.substr(0, 3) == "ply" && (bytes[3] == '\n' || bytes[3] == '\r');
}

Result<PlyHeader> read_ply_header(FileReader& file, const std::filesystem::path& path) {
  return HeaderParser(file, path).parse();
}

}  // namespace boxwood::io
