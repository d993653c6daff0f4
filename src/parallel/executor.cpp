// Executors over oneTBB and over nothing.
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "boxwood/parallel.h"
#include "parallel/work_order.h"

namespace boxwood {

void SequentialExecutor::for_chunks(std::size_t count, std::size_t chunk_size,
                                    FunctionRef<void(std::size_t, std::size_t, std::size_t)> f) {
  for (std::size_t chunk = 0, begin = 0; begin < count; ++chunk, begin += chunk_size)
    f(chunk, begin, std::min(count, begin + chunk_size));
}

void SequentialExecutor::invoke(FunctionRef<void()> a, FunctionRef<void()> b) {
  a();
  b();
}

namespace {

// An arena above oneTBB's limit would make it print a warning, and the library never prints.
int allowed(int threads) {
  const auto limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return threads > 0 ? std::min(threads, static_cast<int>(limit)) : tbb::task_arena::automatic;
}

}  // namespace

struct ThreadExecutor::Arena {
  tbb::task_arena arena;
  explicit Arena(int threads) : arena(allowed(threads)) { arena.initialize(); }
};

ThreadExecutor::ThreadExecutor(int threads) : arena_(std::make_unique<Arena>(threads)) {}
ThreadExecutor::~ThreadExecutor() = default;

int ThreadExecutor::threads() const noexcept {
  return arena_->arena.max_concurrency();
}

void ThreadExecutor::for_chunks(std::size_t count, std::size_t chunk_size,
                                FunctionRef<void(std::size_t, std::size_t, std::size_t)> f) {
  const std::size_t chunks = (count + chunk_size - 1) / chunk_size;
  if (chunks == 0) return;
  if (chunks == 1 || threads() == 1) {
    SequentialExecutor().for_chunks(count, chunk_size, f);
    return;
  }
  WorkOrder order;
  arena_->arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1), [&](const tbb::blocked_range<std::size_t>& range) {
      order.begin_piece();
      for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk)
        f(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
      order.end_piece();
    });
  });
}

void ThreadExecutor::invoke(FunctionRef<void()> a, FunctionRef<void()> b) {
  if (threads() == 1) {
    a();
    b();
    return;
  }
  WorkOrder order;
  const auto piece = [&](FunctionRef<void()> work) {
    order.begin_piece();
    work();
    order.end_piece();
  };
  arena_->arena.execute([&] { tbb::parallel_invoke([&] { piece(a); }, [&] { piece(b); }); });
}

}  // namespace boxwood
