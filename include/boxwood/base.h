// Errors and memory: what every other stage returns and stores its data in.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace boxwood {

/// Version of the library, "major.minor.patch".
const char* version() noexcept;

/// What kind of thing went wrong. The sentence that says it is in `Error::message`.
enum class ErrorCode {
  invalid_argument,  ///< a value that can never be right (malformed number, contradictory options)
  out_of_range,      ///< a value of the right kind outside its valid range
  unknown_name,      ///< a builder, scene, layout or option that does not exist
  not_found,         ///< a file that does not exist
  unreadable,        ///< a file that exists and can't be read
  malformed,         ///< a file or mesh whose content contradicts itself (truncated, index out of range)
  unsupported,       ///< right, but not something this build or machine can do
  unwritable,        ///< an output that can't be written (no permission, no space)
  out_of_memory,     ///< an allocation failed
  cancelled,         ///< the caller asked for an early end
  too_large,         ///< more elements than the format or the algorithm can hold
};

/// One failure: a code for programs and one sentence for people that names the value and the place.
struct Error {
  ErrorCode code = ErrorCode::invalid_argument;
  std::string message;
};

/// Either a value or an `Error`. Test it with `if (result)`; then `*result` and `result->` are the value.
/// Reading the value of a failed result is a mistake of the caller (asserted in debug builds).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}
  Result(ErrorCode code, std::string message) : content_(std::in_place_index<1>, Error{code, std::move(message)}) {}

  explicit operator bool() const noexcept { return content_.index() == 0; }
  bool has_value() const noexcept { return content_.index() == 0; }

  T& value() & { return assert(has_value()), *std::get_if<0>(&content_); }
  const T& value() const& { return assert(has_value()), *std::get_if<0>(&content_); }
  T&& value() && { return assert(has_value()), std::move(*std::get_if<0>(&content_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return assert(!has_value()), *std::get_if<1>(&content_); }

 private:
  std::variant<T, Error> content_;
};

/// A result without a value: success, or an `Error`.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}
  Result(ErrorCode code, std::string message) : error_(Error{code, std::move(message)}) {}

  explicit operator bool() const noexcept { return !error_; }
  bool has_value() const noexcept { return !error_; }
  const Error& error() const { return assert(error_), *error_; }

 private:
  std::optional<Error> error_;
};

using Status = Result<void>;

namespace memory {
/// Uninitialised memory for `AlignedBuffer`; large blocks lie in huge pages where the system has them (Linux). Throws
/// std::bad_alloc. `alignment` is a power of two, at least that of operator new.
void* allocate(std::size_t bytes, std::size_t alignment);
/// Gives back what `allocate` gave for the same two numbers; null is allowed.
void release(void* block, std::size_t bytes, std::size_t alignment) noexcept;
/// `release` keeps blocks of 8 KiB and more, at most 128 MiB of them in a process, for the next arrays of their size,
/// so that a tree that is built again and again takes its memory from the system once. This gives them to the system.
/// From any thread.
void give_back_unused() noexcept;

/// For standard containers whose memory shall come from `allocate`.
template <class T>
struct Allocator {
  using value_type = T;

  Allocator() = default;
  template <class U>
  Allocator(const Allocator<U>&) noexcept {}
  T* allocate(std::size_t count) {
    if (count > SIZE_MAX / sizeof(T)) throw std::bad_alloc();
    return static_cast<T*>(memory::allocate(count * sizeof(T), kAlignment));
  }
  void deallocate(T* block, std::size_t count) noexcept { memory::release(block, count * sizeof(T), kAlignment); }
  friend bool operator==(const Allocator&, const Allocator&) { return true; }

 private:
  static constexpr std::size_t kAlignment = alignof(T) > 64 ? alignof(T) : 64;
};
}  // namespace memory

/// A std::vector that lies in huge pages when it is large.
template <class T>
using LargeVector = std::vector<T, memory::Allocator<T>>;

/// A fixed-size array aligned to a cache line (64 bytes), uninitialised unless said otherwise. Moves, never copies.
/// Throws std::bad_alloc, which every public entry point of the library turns into `ErrorCode::out_of_memory`.
template <class T>
class AlignedBuffer {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  static constexpr std::size_t kAlignment = alignof(T) > 64 ? alignof(T) : 64;

  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t size) : size_(size), capacity_(size) {
    if (size > SIZE_MAX / sizeof(T)) throw std::bad_alloc();
    if (size) data_ = static_cast<T*>(memory::allocate(size * sizeof(T), kAlignment));
  }
  AlignedBuffer(AlignedBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  AlignedBuffer& operator=(AlignedBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }
  ~AlignedBuffer() { memory::release(data_, capacity_ * sizeof(T), kAlignment); }

  T* data() noexcept { return data_; }
  const T* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  std::size_t bytes() const noexcept { return size_ * sizeof(T); }
  T* begin() noexcept { return data_; }
  T* end() noexcept { return data_ + size_; }
  const T* begin() const noexcept { return data_; }
  const T* end() const noexcept { return data_ + size_; }
  T& operator[](std::size_t i) noexcept { return data_[i]; }
  const T& operator[](std::size_t i) const noexcept { return data_[i]; }
  std::span<T> span() noexcept { return {data_, size_}; }
  std::span<const T> span() const noexcept { return {data_, size_}; }

  /// Keeps the first `size` elements; the memory stays as it is.
  void truncate(std::size_t size) noexcept { size_ = size < size_ ? size : size_; }

  AlignedBuffer clone() const {
    AlignedBuffer copy(size_);
    if (size_) std::memcpy(static_cast<void*>(copy.data_), data_, bytes());
    return copy;
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

/// 8-bit RGB, row by row from the top, 3 * width * height bytes.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// 64-bit hash of a byte range, chained through `seed`. Stable across machines of one byte order; not cryptographic.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0) noexcept;

}  // namespace boxwood
