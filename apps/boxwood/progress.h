// A progress bar on standard error for work that takes more than a second, on a terminal only.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace boxwood::program {

/// Lives as long as the work. A thread of its own draws it a few times a second, so that work which can't say how far
/// it is still shows that it runs; the line is wiped at the end.
class Progress {
 public:
  /// `shown` false makes it do nothing at all.
  Progress(std::string label, bool shown);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Share done, 0 to 1. Any thread may call it.
  void update(double share) { share_.store(share, std::memory_order_relaxed); }
  /// Names the step that runs now.
  void label(std::string text);

 private:
  void draw_until_stopped();
  void draw(std::chrono::duration<double> elapsed);

  std::mutex mutex_;
  std::condition_variable stopped_;
  std::string label_;
  std::atomic<double> share_{-1};  // negative: unknown
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace boxwood::program
