// Large blocks serve again; what is kept can be given back.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

#include "boxwood/base.h"
#include "support/effort.h"

namespace boxwood {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

std::uintptr_t allocate_and_release(std::size_t bytes) {
  void* const block = memory::allocate(bytes, 64);
  std::memset(block, 1, bytes);
  memory::release(block, bytes, 64);
  return reinterpret_cast<std::uintptr_t>(block);
}

TEST(Memory, ALargeBlockServesTheNextArrayOfItsSize) {
  if (test::kInstrumented) GTEST_SKIP() << "a sanitizer must see every release";
  memory::give_back_unused();
  const std::uintptr_t block = allocate_and_release(3 * kMiB);
  EXPECT_EQ(allocate_and_release(3 * kMiB), block);
  EXPECT_EQ(allocate_and_release(3 * kMiB - 100), block) << "nearly the size";
  void* const larger = memory::allocate(5 * kMiB, 64);
  EXPECT_NE(reinterpret_cast<std::uintptr_t>(larger), block);
  EXPECT_EQ(allocate_and_release(3 * kMiB), block);
  memory::release(larger, 5 * kMiB, 64);
  memory::give_back_unused();
}

TEST(Memory, SoDoesOneOfMiddleSize) {
  if (test::kInstrumented) GTEST_SKIP() << "a sanitizer must see every release";
  memory::give_back_unused();
  const std::uintptr_t block = allocate_and_release(kMiB / 8);
  EXPECT_EQ(allocate_and_release(kMiB / 8 - 100), block) << "nearly the size";
  void* const taken = memory::allocate(kMiB / 8, 64);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(taken), block);
  void* const other = memory::allocate(kMiB / 8, 64);
  EXPECT_NE(other, taken);
  memory::release(other, kMiB / 8, 64);
  memory::release(taken, kMiB / 8, 64);
  memory::give_back_unused();
}

TEST(Memory, BlocksInUseAreNeverShared) {
  std::vector<AlignedBuffer<std::uint8_t>> buffers;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 40; ++i) {
      const std::size_t size = kMiB / 4 + std::size_t(i) * (kMiB / 8);
      buffers.emplace_back(size);
      std::memset(buffers.back().begin(), i, size);
    }
    for (int i = 0; i < 40; ++i) {
      EXPECT_EQ(buffers[i][0], i);
      EXPECT_EQ(buffers[i][buffers[i].size() - 1], i);
    }
    buffers.clear();
  }
  memory::give_back_unused();
}

TEST(Memory, MoreThanIsKeptIsGivenBackAndCanBeTakenAgain) {
  std::vector<AlignedBuffer<std::uint8_t>> buffers;
  for (int i = 0; i < 12; ++i) buffers.emplace_back(32 * kMiB);  // 384 MiB, three times what is kept
  buffers.clear();
  AlignedBuffer<std::uint8_t> next(32 * kMiB);
  next[next.size() - 1] = 1;
  memory::give_back_unused();
  EXPECT_EQ(next[next.size() - 1], 1) << "what is in use is not given back";
}

TEST(Memory, WhatIsKeptStaysWhenMoreIsGivenBack) {
  if (test::kInstrumented) GTEST_SKIP() << "a sanitizer must see every release";
  memory::give_back_unused();
  std::vector<void*> blocks(6);  // half as many again as are kept
  for (void*& block : blocks) block = memory::allocate(32 * kMiB, 64);
  for (void* block : blocks) memory::release(block, 32 * kMiB, 64);
  std::set<void*> again;
  for (int i = 0; i < 4; ++i) again.insert(memory::allocate(32 * kMiB, 64));
  EXPECT_EQ(again, std::set<void*>(blocks.begin(), blocks.begin() + 4))
      << "the first four, that the next build wants first";
  for (void* block : again) memory::release(block, 32 * kMiB, 64);
  memory::give_back_unused();
}

TEST(Memory, ManySmallBlocksDriveOutNoLargeOne) {
  if (test::kInstrumented) GTEST_SKIP() << "a sanitizer must see every release";
  memory::give_back_unused();
  for (int build = 0; build < 3; ++build) {  // a build's large array, then hundreds of small ones
    auto* const large = static_cast<std::uint8_t*>(memory::allocate(20 * kMiB, 64));
    if (build > 0) {
      EXPECT_EQ(large[7 * kMiB], 77) << "not fresh from the system, which would have cleared it";
    }
    large[7 * kMiB] = 77;
    memory::release(large, 20 * kMiB, 64);
    std::vector<AlignedBuffer<std::uint8_t>> pieces;
    for (int i = 0; i < 600; ++i) pieces.emplace_back(kMiB / 16 + 4096 * std::size_t(i % 8));
  }
  memory::give_back_unused();
}

TEST(Memory, ServesSeveralThreads) {
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([t, &wrong] {
      for (int round = 0; round < 50; ++round) {
        const std::size_t size = kMiB + std::size_t(round % 3) * kMiB;
        AlignedBuffer<std::uint8_t> buffer(size);
        std::memset(buffer.begin(), t, size);
        if (round % 10 == 9) memory::give_back_unused();
        for (std::size_t i = 0; i < size; i += 4096) wrong[t] += buffer[i] != t;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::accumulate(wrong.begin(), wrong.end(), 0), 0);
  memory::give_back_unused();
}

}  // namespace
}  // namespace boxwood
