#include "io/stl_check.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "io/sentence.h"

namespace boxwood::io {
namespace {

constexpr std::uint64_t kHeader = 84, kFacet = 50;
constexpr std::uint64_t kTail = 1024;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

Status check_stl(FileReader& file, const std::filesystem::path& path) {
  const std::uint64_t size = file.bytes_left().value_or(0);
  const bool has_header = file.prepare(kHeader);
  const unsigned char* bytes = file.data();
  const std::uint64_t facets =
      has_header ? bytes[80] | bytes[81] << 8 | bytes[82] << 16 | std::uint64_t{bytes[83]} << 24 : 0;
  if (has_header && size == kHeader + kFacet * facets) return {};
  std::string front =
      lower_case({reinterpret_cast<const char*>(bytes), std::min<std::size_t>(file.available(), kHeader)});
  front.erase(0, front.find_first_not_of(" \t\r\n"));
  if (!front.starts_with("solid")) {
    if (has_header && size > kHeader + kFacet * facets) return {};
    return read_error(ErrorCode::malformed, path,
                      "it is truncated, or no STL: a binary file of " + std::to_string(facets) + " triangles needs " +
                          std::to_string(kHeader + kFacet * facets) + " bytes and it has " + std::to_string(size));
  }
  if (!file.skip(size - std::min(size, kTail)) || !file.prepare(std::min(size, kTail)))
    return file.system_error() ? Status(read_error(path, file.system_error())) : Status();
  // Between the last triangle and the end there must be the word that closes a solid.
  const std::string tail = lower_case({reinterpret_cast<const char*>(file.data()), file.available()});
  const std::size_t last_facet = tail.rfind("facet"), last_end = tail.rfind("endsolid");
  if (last_end != tail.npos && (last_facet == tail.npos || last_facet < last_end)) return {};
  return read_error(ErrorCode::malformed, path, "it is truncated: no 'endsolid' is at its end");
}

}  // namespace boxwood::io
