// How this stage words its errors: "cannot read 'chair.ply': the file is empty". One sentence, no line breaks.
#pragma once

#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "boxwood/base.h"

namespace boxwood::io {

/// `text` with line breaks and other control characters turned into spaces, no final full stop, at most 300 bytes.
std::string one_line(std::string_view text);

/// The path in single quotes, fit for a sentence.
std::string quoted(const std::filesystem::path& path);

/// "cannot read 'path': reason"
Error read_error(ErrorCode code, const std::filesystem::path& path, std::string_view reason);

/// "cannot write 'path': reason"
Error write_error(ErrorCode code, const std::filesystem::path& path, std::string_view reason);

/// The same for a failed system call; picks the code and the reason by `system_error`, a value of errno.
Error read_error(const std::filesystem::path& path, int system_error);
Error write_error(const std::filesystem::path& path, int system_error);

/// Runs an entry point's body; a failed allocation becomes the error every entry point promises.
template <class Body>
auto guard_memory(std::string_view verb, const std::filesystem::path& path, Body&& body) -> decltype(body()) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory,
                 "cannot " + std::string(verb) + " " + quoted(path) + ": there is not enough memory"};
  }
}

}  // namespace boxwood::io
