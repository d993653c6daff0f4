#include "io/sentence.h"

#include <cerrno>
#include <system_error>

namespace boxwood::io {
namespace {

constexpr std::size_t kLongestReason = 300;

std::string reason_of(int system_error) {
  switch (system_error) {
    case ENOENT:
      return "there is no such file or folder";
    case ENOTDIR:
      return "a part of the path is not a folder";
    case EACCES:
    case EPERM:
      return "permission denied";
    case EISDIR:
      return "it is a folder";
    case ENOSPC:
      return "no space is left on the device";
    case EDQUOT:
      return "the disk quota is used up";
    case EROFS:
      return "the file system is read-only";
    case ENAMETOOLONG:
      return "the name is too long";
    case ELOOP:
      return "the path has too many symbolic links";
    case EPIPE:
      return "the reader at the other end is gone";
    default:
      return std::generic_category().message(system_error);
  }
}

ErrorCode read_code(int system_error) {
  return system_error == ENOENT || system_error == ENOTDIR ? ErrorCode::not_found : ErrorCode::unreadable;
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string line;
  for (const char c : text.substr(0, kLongestReason)) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    if (control && (line.empty() || line.back() == ' ')) continue;
    line += control ? ' ' : c;
  }
  if (text.size() > kLongestReason) return line + "...";
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

std::string quoted(const std::filesystem::path& path) {
  std::string name = path.string();
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return "'" + name + "'";
}

Error read_error(ErrorCode code, const std::filesystem::path& path, std::string_view reason) {
  return {code, "cannot read " + quoted(path) + ": " + std::string(reason)};
}

Error write_error(ErrorCode code, const std::filesystem::path& path, std::string_view reason) {
  return {code, "cannot write " + quoted(path) + ": " + std::string(reason)};
}

Error read_error(const std::filesystem::path& path, int system_error) {
  return read_error(read_code(system_error), path, reason_of(system_error));
}

Error write_error(const std::filesystem::path& path, int system_error) {
  return write_error(ErrorCode::unwritable, path, reason_of(system_error));
}

}  // namespace boxwood::io
