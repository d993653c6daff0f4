#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "boxwood/parallel.h"

namespace boxwood {
namespace {

template <class F>
void for_each_executor(F&& f) {
  SequentialExecutor one;
  ThreadExecutor all, two(2), single(1);
  for (Executor* executor : std::initializer_list<Executor*>{&one, &all, &two, &single}) f(*executor);
}

TEST(Executor, EveryItemOnceInFixedChunks) {
  for_each_executor([](Executor& executor) {
    for (std::size_t count : {0, 1, 9, 10, 11, 1003}) {
      std::vector<std::atomic<int>> visits(count);
      executor.for_chunks(count, 10, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        EXPECT_EQ(begin, chunk * 10);
        EXPECT_EQ(end, std::min(count, begin + 10));
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      for (auto& v : visits) EXPECT_EQ(v, 1);
    }
  });
}

TEST(Executor, InvokeRunsBothAndNests) {
  for_each_executor([](Executor& executor) {
    std::atomic<int> sum = 0;
    executor.invoke(
        [&] {
          executor.for_chunks(100, 7,
                              [&](std::size_t, std::size_t b, std::size_t e) { sum += static_cast<int>(e - b); });
        },
        [&] { executor.invoke([&] { sum += 1000; }, [&] { sum += 10000; }); });
    EXPECT_EQ(sum, 11100);
  });
}

TEST(Executor, ExceptionsComeBack) {
  for_each_executor([](Executor& executor) {
    EXPECT_THROW(executor.for_chunks(100, 1,
                                     [](std::size_t chunk, std::size_t, std::size_t) {
                                       if (chunk == 50) throw std::runtime_error("x");
                                     }),
                 std::runtime_error);
    EXPECT_THROW(executor.invoke([] { throw std::bad_alloc(); }, [] {}), std::bad_alloc);
  });
}

TEST(Executor, ThreadCount) {
  EXPECT_EQ(SequentialExecutor().threads(), 1);
  EXPECT_EQ(ThreadExecutor(1).threads(), 1);
  EXPECT_GE(ThreadExecutor().threads(), 1);
  // More than the process has: as many as oneTBB's limit allows, without a word on standard error.
  testing::internal::CaptureStderr();
  EXPECT_LE(ThreadExecutor(3).threads(), 3);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  tbb::global_control raised(tbb::global_control::max_allowed_parallelism, 8);
  EXPECT_EQ(ThreadExecutor(8).threads(), 8);
}

}  // namespace
}  // namespace boxwood
