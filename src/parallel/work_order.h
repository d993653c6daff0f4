// Tells ThreadSanitizer what oneTBB orders. The system's oneTBB is not instrumented, so without this every hand-over of
// work would look like a race. Only what is true is told: the start comes before each piece of work and each piece
// before the end. Pieces stay unordered among each other: a race between two of them is still reported.
#pragma once

#ifdef BOXWOOD_THREAD_SANITIZER  // defined for executor.cpp alone, which is not instrumented, like oneTBB
#include <sanitizer/tsan_interface.h>
#endif

namespace boxwood {

/// One parallel call. Without ThreadSanitizer it does nothing.
class WorkOrder {
 public:
#ifdef BOXWOOD_THREAD_SANITIZER
  WorkOrder() {
    __tsan_release(&start_);
  }
  ~WorkOrder() {
    __tsan_acquire(&end_);
  }
  void begin_piece() {
    __tsan_acquire(&start_);
  }
  void end_piece() {
    __tsan_release(&end_);
  }

 private:
  char start_ = 0, end_ = 0;
#else
  void begin_piece() {}
  void end_piece() {}
#endif
};

}  // namespace boxwood
