// What every sub-command shares: threads, where text goes, the head of reports.
#pragma once

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/builders.h"
#include "boxwood/parallel.h"

namespace boxwood::program {

using Json = nlohmann::ordered_json;

inline constexpr int kMostThreads = 1024;

/// The options every sub-command has.
struct CommonOptions {
  int threads = 0;  ///< 0 = all processors
  bool quiet = false;
  std::string json;  ///< file name, "-" = standard output, empty = none

  void add_to(CLI::App& command);
};

/// One run of the program. Text for people goes to standard output, unless something for programs goes there.
class Session {
 public:
  Session(std::string command, const CommonOptions& options, bool stdout_taken = false);

  /// What was asked for. Not printed when standard output is for programs.
  template <class... Args>
  void result(fmt::format_string<Args...> format, Args&&... args) const {
    if (!stdout_taken_) fmt::print(format, std::forward<Args>(args)...);
  }
  /// What is good to know beside it. Not printed with --quiet either.
  template <class... Args>
  void note(fmt::format_string<Args...> format, Args&&... args) const {
    if (!stdout_taken_ && !options_.quiet) fmt::print(format, std::forward<Args>(args)...);
  }
  /// One line on standard error, always.
  void warn(const std::string& sentence) const;

  bool shows_progress() const { return !options_.quiet; }
  const std::shared_ptr<Executor>& executor() const { return executor_; }
  int threads() const { return executor_->threads(); }
  /// An executor of `threads` threads.
  std::shared_ptr<Executor> make_executor(int threads) const;

  /// The environment as the first keys of a report: command, version, compiler, instruction set, threads. `isa` empty
  /// where no kernel runs.
  Json report(const std::string& isa) const;
  /// The same as a line of text.
  std::string environment_line(const std::string& isa) const;
  /// Writes the report to where --json says, if anywhere.
  Status finish(const Json& report) const;

 private:
  std::string command_;
  CommonOptions options_;
  bool stdout_taken_;
  std::optional<tbb::global_control> thread_limit_;
  std::shared_ptr<Executor> executor_;
};

/// Says early that an output will not be writable, before hours of work go into it. Does not touch the file.
Status check_output_folder(const std::string& path);

/// Resolved options as JSON, numbers as numbers.
Json options_json(const std::vector<std::pair<std::string, std::string>>& echo);
std::string options_line(const std::vector<std::pair<std::string, std::string>>& echo);

/// Largest resident memory of the process so far.
std::size_t peak_memory_bytes();

/// Seconds since the first call of the process; for differences.
double now();

}  // namespace boxwood::program
