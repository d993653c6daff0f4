// Progress and cancellation of one build, shared by its threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>

#include "boxwood/builders.h"

namespace boxwood::builders {

class BuildMonitor {
 public:
  /// `work` is the number of items whose completion means that all is done.
  BuildMonitor(const BuildContext& context, std::size_t work)
      : context_(context), work_(std::max<std::size_t>(work, 1)) {}

  bool cancelled() const { return context_.cancel && context_.cancel->load(std::memory_order_relaxed); }

  /// Adds finished items and tells the listener. To be called rarely: it takes a lock.
  void finish(std::size_t items) {
    if (!context_.progress) return;
    const std::lock_guard lock(mutex_);
    done_ = std::min(done_ + items, work_);
    context_.progress(static_cast<double>(done_) / static_cast<double>(work_));
  }

 private:
  const BuildContext& context_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::size_t work_;
};

/// What a builder returns when it saw the cancel flag.
inline Error cancelled_error() {
  return {ErrorCode::cancelled, "the build was cancelled before it was done"};
}

}  // namespace boxwood::builders
