#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace boxwood::program {
namespace {

constexpr std::chrono::milliseconds kDelay{1000}, kInterval{250};
constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(std::string label, bool shown) : label_(std::move(label)) {
  if (shown && isatty(STDERR_FILENO)) thread_ = std::thread([this] { draw_until_stopped(); });
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_one();
  thread_.join();
}

void Progress::label(std::string text) {
  const std::lock_guard lock(mutex_);
  label_ = std::move(text);
}

void Progress::draw_until_stopped() {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  if (stopped_.wait_for(lock, kDelay, [this] { return stop_; })) return;
  do draw(std::chrono::steady_clock::now() - start);
  while (!stopped_.wait_for(lock, kInterval, [this] { return stop_; }));
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

void Progress::draw(std::chrono::duration<double> elapsed) {
  const double share = share_.load(std::memory_order_relaxed);
  std::string bar(kBarWidth, ' ');
  if (share >= 0) {
    const int done = std::clamp(static_cast<int>(share * kBarWidth), 0, kBarWidth);
    std::fill_n(bar.begin(), done, '#');
  } else {
    const int at = static_cast<int>(elapsed.count() * 8) % (2 * (kBarWidth - 3));
    std::fill_n(bar.begin() + (at < kBarWidth - 3 ? at : 2 * (kBarWidth - 3) - at), 3, '#');
  }
  const std::string percent = share >= 0 ? fmt::format("{:3.0f} %", 100 * std::min(share, 1.0)) : "     ";
  fmt::print(stderr, "\r[{}] {} {:4.0f} s  {}\033[K", bar, percent, elapsed.count(), label_);
  std::fflush(stderr);
}

}  // namespace boxwood::program
