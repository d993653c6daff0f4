// Writing files so that nobody ever sees half of one: into a temporary beside the target, then a rename over it.
// Devices, pipes and the streams of this process have no "old content" to keep and are written directly.
#include <fcntl.h>
#include <sys/stat.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <optional>

#include "boxwood/io.h"
#include "io/file_descriptor.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as the Linux kernel
constexpr int kTemporaryTries = 100;
constexpr std::size_t kLongestStem = 180;  // leaves room for the suffix in a file name of 255 bytes

// The number of "/dev/stdout", "/dev/stderr", "/dev/fd/N" or "/proc/self/fd/N". Such names are followed to the open
// file itself: opening them again would restart at its beginning and overwrite what was printed before.
std::optional<int> stream_number(const fs::path& path) {
  const std::string name = path.string();
  if (name == "/dev/stdout") return 1;
  if (name == "/dev/stderr") return 2;
  for (const std::string_view prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!name.starts_with(prefix)) continue;
    int number = -1;
    const char* end = name.data() + name.size();
    const auto parsed = std::from_chars(name.data() + prefix.size(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number >= 0) return number;
  }
  return std::nullopt;
}

// Follows symbolic links by hand, so that the rename replaces the file and not the link, also when the link's target
// does not exist yet. Stops at a stream of this process.
Result<fs::path> follow_links(const fs::path& path) {
  fs::path target = path;
  for (int i = 0; i < kMostLinks; ++i) {
    std::error_code failure;
    if (stream_number(target) || !fs::is_symlink(fs::symlink_status(target, failure))) return target;
    const fs::path link = fs::read_symlink(target, failure);
    if (failure) return write_error(path, failure.value());
    target = link.is_absolute() ? link : target.parent_path() / link;
  }
  return write_error(path, ELOOP);
}

Status write_all(int file, const fs::path& path, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size) {
    const ssize_t written = ::write(file, next, size);
    if (written > 0) {
      next += written;
      size -= static_cast<std::size_t>(written);
    } else if (written == 0 || errno != EINTR) {
      return write_error(path, written == 0 ? EIO : errno);
    }
  }
  return {};
}

// Runs the caller's function on an open file. A sink that failed once stays failed, so an ignored status does not turn
// into a file with a hole.
Status run(const std::function<Status(const Sink&)>& write, FileDescriptor& file, const fs::path& path) {
  Status first_failure;
  const Sink sink = [&](const void* data, std::size_t size) -> Status {
    if (first_failure) first_failure = write_all(file.number(), path, data, size);
    return first_failure;
  };
  if (Status status = write(sink); !status) return status;
  if (!first_failure) return first_failure;
  if (!file.close()) return write_error(path, errno);
  return {};
}

Status write_directly(const fs::path& path, FileDescriptor file, const std::function<Status(const Sink&)>& write) {
  if (!file.is_open()) return write_error(path, errno);
  return run(write, file, path);
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : folder_(target.parent_path()) {
    static std::atomic<std::uint64_t> counter{0};
    const std::string stem =
        "." + target.filename().string().substr(0, kLongestStem) + "." + std::to_string(::getpid()) + ".";
    for (int i = 0; i < kTemporaryTries; ++i) {
      const std::uint64_t seed[] = {
          static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()), counter.fetch_add(1),
          reinterpret_cast<std::uintptr_t>(this)};
      char digits[17] = {};
      std::to_chars(digits, digits + 16, hash_bytes(seed, sizeof(seed)), 16);
      path_ = folder_ / (stem + digits + ".tmp");
      file_ = FileDescriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
      system_error_ = file_.is_open() ? 0 : errno;
      if (system_error_ != EEXIST) return;
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (system_error_ == 0 && !kept_) ::unlink(path_.c_str());
  }

  FileDescriptor& file() { return file_; }
  int system_error() const { return system_error_; }
  bool rename_to(const fs::path& target) { return kept_ = ::rename(path_.c_str(), target.c_str()) == 0; }

 private:
  fs::path folder_, path_;
  FileDescriptor file_;
  int system_error_ = 0;
  bool kept_ = false;
};

Status replace(const fs::path& path, const fs::path& target, const struct stat* old,
               const std::function<Status(const Sink&)>& write) {
  // A rename would replace a write-protected file without asking.
  if (old && ::access(target.c_str(), W_OK) != 0) return write_error(path, errno);
  TemporaryFile temporary(target);
  if (const int failure = temporary.system_error()) {
    if (failure == ENOENT)
      return write_error(
          ErrorCode::unwritable, path,
          "the folder " + quoted(target.parent_path().empty() ? "." : target.parent_path()) + " does not exist");
    if (failure == EACCES || failure == EROFS)
      return write_error(
          ErrorCode::unwritable, path,
          "the folder " + quoted(target.parent_path().empty() ? "." : target.parent_path()) + " can't be written to");
    return write_error(path, failure);
  }
  // The new file keeps the old one's permissions; failing at that is no reason to lose the content.
  if (old && ::fchmod(temporary.file().number(), old->st_mode & 07777) != 0) errno = 0;
  if (Status status = run(write, temporary.file(), path); !status) return status;
  if (!temporary.rename_to(target)) return write_error(path, errno);
  return {};
}

}  // namespace

Status write_file(const fs::path& path, const std::function<Status(const Sink&)>& write) {
  return guard_memory("write", path, [&]() -> Status {
    if (path.empty()) return {ErrorCode::invalid_argument, "cannot write a file without a name"};
    if (!write) return write_error(ErrorCode::invalid_argument, path, "the function that gives its content is empty");
    const Result<fs::path> target = follow_links(path);
    if (!target) return target.error();
    if (const auto number = stream_number(*target))
      return write_directly(path, FileDescriptor(::fcntl(*number, F_DUPFD_CLOEXEC, 0)), write);
    struct stat info {};
    const bool exists = ::stat(target->c_str(), &info) == 0;
    if (!exists && errno != ENOENT) return write_error(path, errno);
    if ((exists && S_ISDIR(info.st_mode)) || !target->has_filename()) return write_error(path, EISDIR);
    if (exists && !S_ISREG(info.st_mode))
      return write_directly(path, FileDescriptor(::open(target->c_str(), O_WRONLY | O_CLOEXEC)), write);
    return replace(path, *target, exists ? &info : nullptr, write);
  });
}

Status write_file(const fs::path& path, std::string_view content) {
  return write_file(path, [&](const Sink& sink) { return sink(content.data(), content.size()); });
}

}  // namespace boxwood::io
