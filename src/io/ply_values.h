// The numbers in the body of a PLY file, one after the other, as doubles (every PLY type fits into one exactly).
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>

#include "io/file_reader.h"
#include "io/ply_header.h"
#include "io/sentence.h"

namespace boxwood::io {

/// Binary bodies. `kSwapped`: the file's byte order is not this machine's.
template <bool kSwapped>
class BinaryPlyValues {
 public:
  explicit BinaryPlyValues(FileReader& file) : file_(file) {}

  bool next(PlyType type, double& value) {
    const std::size_t size = size_of(type);
    if (!file_.prepare(size)) return false;
    unsigned char bytes[8];
    std::memcpy(bytes, file_.data(), size);
    file_.consume(size);
    if constexpr (kSwapped) std::reverse(bytes, bytes + size);
    switch (type) {
      case PlyType::int8:
        value = as<std::int8_t>(bytes);
        break;
      case PlyType::uint8:
        value = as<std::uint8_t>(bytes);
        break;
      case PlyType::int16:
        value = as<std::int16_t>(bytes);
        break;
      case PlyType::uint16:
        value = as<std::uint16_t>(bytes);
        break;
      case PlyType::int32:
        value = as<std::int32_t>(bytes);
        break;
      case PlyType::uint32:
        value = as<std::uint32_t>(bytes);
        break;
      case PlyType::float32:
        value = as<float>(bytes);
        break;
      case PlyType::float64:
        value = as<double>(bytes);
        break;
    }
    return true;
  }

  bool skip(PlyType type, std::uint64_t count) { return file_.skip(count * size_of(type)); }

  /// Why next() or skip() failed.
  std::string problem() const { return "the file ends"; }

  /// The fewest bytes `count` values take.
  static std::uint64_t least_size(PlyType type) { return size_of(type); }

 private:
  template <class T>
  static T as(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  FileReader& file_;
};

/// ASCII bodies: numbers between blanks and line breaks, whatever their grouping into lines.
class AsciiPlyValues {
 public:
  explicit AsciiPlyValues(FileReader& file) : file_(file) {}

  bool next(PlyType type, double& value) {
    if (!next_word()) return false;
    if (parse(type, value)) return true;
    problem_ = "'" + one_line({word_, word_size_}) + "' is not a number";
    return false;
  }

  bool skip(PlyType, std::uint64_t count) {
    for (; count; --count)
      if (!next_word()) return false;
    return true;
  }

  std::string problem() const { return problem_; }

  /// One digit and the blank behind it.
  static std::uint64_t least_size(PlyType) { return 2; }

 private:
  static constexpr std::size_t kLongestWord = FileReader::kLongestPrepare - 1;

  static bool is_space(unsigned char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  // Finds the next word; it stays valid until the following call. The whole word is in the buffer, so that parsing
  // needs no copy.
  bool next_word() {
    for (;;) {
      if (!file_.prepare(1)) return problem_ = "the file ends", false;
      const unsigned char* bytes = file_.data();
      const std::size_t size = file_.available();
      std::size_t blanks = 0;
      while (blanks < size && is_space(bytes[blanks])) ++blanks;
      file_.consume(blanks);
      if (blanks < size) break;
    }
    std::size_t size = 0;
    const auto scan = [&] {
      while (size < file_.available() && !is_space(file_.data()[size])) ++size;
      return size < file_.available();
    };
    if (!scan() && size <= kLongestWord) {
      file_.prepare(kLongestWord + 1);  // false near the end of the file; what is there is visible all the same
      scan();
    }
    word_ = reinterpret_cast<const char*>(file_.data());
    word_size_ = size;
    if (size > kLongestWord) return problem_ = "a number has more than 4095 characters", false;
    file_.consume(size);
    return true;
  }

  bool parse(PlyType type, double& value) const {
    const char* begin = word_;
    const char* end = word_ + word_size_;
    if (word_size_ > 1 && *begin == '+' && begin[1] != '-') ++begin;
    if (is_integer(type)) {
      std::int64_t integer = 0;
      const auto parsed = std::from_chars(begin, end, integer);
      if (parsed.ec == std::errc() && parsed.ptr == end) return value = static_cast<double>(integer), true;
    }
    // Straight to float where the file says float: by way of a double it would be rounded twice.
    if (type == PlyType::float32) {
      float single = 0;
      const auto parsed = std::from_chars(begin, end, single);
      if (parsed.ec == std::errc()) return value = single, parsed.ptr == end;
    }
    const auto parsed = std::from_chars(begin, end, value);
    if (parsed.ec == std::errc::result_out_of_range) value = out_of_range_value({begin, parsed.ptr});
    return parsed.ec != std::errc::invalid_argument && parsed.ptr == end;
  }

  // What a number beyond the range of double rounds to: its exponent tells which end it is beyond. Without an exponent
  // it has hundreds of digits, before the point when it is large.
  static double out_of_range_value(std::string_view number) {
    const std::size_t exponent = number.find_first_of("eE");
    const bool tiny = exponent != number.npos ? number.substr(exponent + 1).starts_with('-')
                                              : number.find_first_of("123456789") > number.find('.');
    const double magnitude = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    return number.starts_with('-') ? -magnitude : magnitude;
  }

  FileReader& file_;
  const char* word_ = nullptr;
  std::size_t word_size_ = 0;
  std::string problem_;
};

}  // namespace boxwood::io
