#include "io/file_reader.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cassert>
#include <cerrno>
#include <cstring>

#include "io/sentence.h"

namespace boxwood::io {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;

}  // namespace

Result<FileReader> FileReader::open(const std::filesystem::path& path) {
  if (path.empty()) return Error{ErrorCode::invalid_argument, "cannot read a file without a name"};
  FileReader reader;
  reader.file_ = FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat info {};
  if (!reader.file_.is_open() || ::fstat(reader.file_.number(), &info) != 0) return read_error(path, errno);
  if (S_ISDIR(info.st_mode)) return read_error(path, EISDIR);
  if (S_ISREG(info.st_mode)) reader.size_ = static_cast<std::uint64_t>(info.st_size);
  reader.buffer_ = AlignedBuffer<unsigned char>(kBufferSize);
  return reader;
}

bool FileReader::refill(std::size_t size) {
  assert(size <= kLongestPrepare);
  // Nothing to move when the buffer is used up, the common case with rows that divide it.
  if (available_) std::memmove(buffer_.data(), data(), available_);
  begin_ = 0;
  while (available_ < size && !at_end_) {
    const ssize_t got = ::read(file_.number(), buffer_.data() + available_, buffer_.size() - available_);
    if (got > 0) {
      available_ += static_cast<std::size_t>(got);
    } else if (got == 0 || errno != EINTR) {
      if (got < 0) system_error_ = errno;
      at_end_ = true;
    }
  }
  return available_ >= size;
}

bool FileReader::skip(std::uint64_t size) {
  while (size > available_) {
    size -= available_;
    consume(available_);
    if (!refill(1)) return false;
  }
  consume(static_cast<std::size_t>(size));
  return true;
}

}  // namespace boxwood::io
