#include "session.h"

#include <oneapi/tbb/info.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "boxwood/io.h"
#include "text.h"

namespace boxwood::program {
namespace {

std::string compiler() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

}  // namespace

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--threads", threads, "Threads to use; 0 = all processors")
      ->check(CLI::Range(0, kMostThreads).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--json", json, "Write the report as JSON to FILE, or '-' for standard output")->type_name("FILE");
  command.add_flag("-q,--quiet", quiet, "Print the result only: no progress bar, no notes");
}

Session::Session(std::string command, const CommonOptions& options, bool stdout_taken)
    : command_(std::move(command)), options_(options), stdout_taken_(stdout_taken || options.json == "-") {
  // oneTBB makes no more threads than processors unless told so; the process is ours, so we may.
  if (options.threads > tbb::info::default_concurrency())
    thread_limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  executor_ = make_executor(options.threads);
}

std::shared_ptr<Executor> Session::make_executor(int threads) const {
  if (threads == 1) return std::make_shared<SequentialExecutor>();
  return std::make_shared<ThreadExecutor>(threads);
}

void Session::warn(const std::string& sentence) const {
  std::fflush(stdout);
  fmt::print(stderr, "boxwood: warning: {}\n", one_line(sentence));
}

Json Session::report(const std::string& isa) const {
  Json report;
  report["command"] = command_;
  report["version"] = version();
  report["compiler"] = compiler();
  if (!isa.empty()) report["isa"] = isa;
  report["threads"] = threads();
  return report;
}

std::string Session::environment_line(const std::string& isa) const {
  return fmt::format("boxwood {}, {}{}{}, {} {}", version(), compiler(), isa.empty() ? "" : ", ", isa, threads(),
                     threads() == 1 ? "thread" : "threads");
}

Status Session::finish(const Json& report) const {
  if (options_.json.empty()) return {};
  // File names need not be UTF-8, JSON must be.
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (options_.json != "-") return io::write_file(options_.json, text);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

Status check_output_folder(const std::string& path) {
  if (path.empty() || path == "-") return {};
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(path, error).parent_path();
  if (error) return {ErrorCode::unwritable, fmt::format("{} can't be written: {}", path, error.message())};
  if (!std::filesystem::is_directory(folder, error))
    return {ErrorCode::unwritable, fmt::format("{} can't be written: there is no folder {}", path, folder.string())};
  if (std::filesystem::is_directory(path, error))
    return {ErrorCode::unwritable, fmt::format("{} can't be written: it is a folder", path)};
  const bool is_special = std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error);
  if (!is_special && access(folder.c_str(), W_OK) != 0)
    return {ErrorCode::unwritable,
            fmt::format("{} can't be written: no permission to write in the folder {}", path, folder.string())};
  return {};
}

Json options_json(const std::vector<std::pair<std::string, std::string>>& echo) {
  Json json = Json::object();
  for (const auto& [key, value] : echo) {
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (end == value.c_str() + value.size() && !value.empty())
      json[key] = number == static_cast<double>(static_cast<long long>(number)) && value.find('.') == std::string::npos
                      ? Json(static_cast<long long>(number))
                      : Json(number);
    else
      json[key] = value;
  }
  return json;
}

std::string options_line(const std::vector<std::pair<std::string, std::string>>& echo) {
  std::string line;
  for (const auto& [key, value] : echo) line += (line.empty() ? "" : " ") + key + "=" + value;
  return line;
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

double now() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace boxwood::program
