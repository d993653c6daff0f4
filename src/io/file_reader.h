// Reads a file from front to back through one buffer of constant size, so that a reader needs no more memory than what
// it makes of the bytes. Chosen over a memory map because a file that shrinks while it is mapped kills the process, and
// because pipes work too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "boxwood/base.h"
#include "io/file_descriptor.h"

namespace boxwood::io {

class FileReader {
 public:
  /// Opens for reading. Folders are refused.
  static Result<FileReader> open(const std::filesystem::path& path);

  /// Tries to have `size` bytes (at most kLongestPrepare) visible at data(); false when the file ends or fails first.
  bool prepare(std::size_t size) { return available_ >= size || refill(size); }
  static constexpr std::size_t kLongestPrepare = 4096;

  /// The next bytes of the file; available() of them are in the buffer.
  const unsigned char* data() const noexcept { return buffer_.data() + begin_; }
  std::size_t available() const noexcept { return available_; }

  /// Moves on; `size` is at most available().
  void consume(std::size_t size) noexcept {
    begin_ += size;
    available_ -= size;
    position_ += size;
  }

  /// Moves over `size` bytes, buffered or not; false when the file ends or fails before.
  bool skip(std::uint64_t size);

  /// Bytes consumed so far.
  std::uint64_t position() const noexcept { return position_; }

  /// Bytes between here and the end by the size the file had when it was opened; nothing for pipes and devices.
  std::optional<std::uint64_t> bytes_left() const noexcept {
    if (!size_) return std::nullopt;
    return *size_ > position_ ? *size_ - position_ : 0;
  }

  bool is_regular() const noexcept { return size_.has_value(); }

  /// The errno of a failed read; 0 while none failed.
  int system_error() const noexcept { return system_error_; }

 private:
  bool refill(std::size_t size);

  FileDescriptor file_;
  AlignedBuffer<unsigned char> buffer_;
  std::size_t begin_ = 0, available_ = 0;
  std::uint64_t position_ = 0;
  std::optional<std::uint64_t> size_;
  bool at_end_ = false;
  int system_error_ = 0;
};

}  // namespace boxwood::io
