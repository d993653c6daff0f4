#include "parallel/radix_sort.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>
#include <vector>

namespace boxwood {
namespace {

std::vector<KeyedIndex> random_items(std::size_t size, std::uint64_t mask, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  std::vector<KeyedIndex> items(size);
  for (std::size_t i = 0; i < size; ++i) items[i] = {random() & mask, std::uint32_t(i), 0};
  return items;
}

void expect_like_stable_sort(std::vector<KeyedIndex> items, int bits, Executor& executor) {
  AlignedBuffer<KeyedIndex> sorted(items.size());
  std::copy(items.begin(), items.end(), sorted.begin());
  radix_sort(sorted, bits, executor);
  std::stable_sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  ASSERT_EQ(sorted.size(), items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    ASSERT_EQ(sorted[i].key, items[i].key) << i;
    ASSERT_EQ(sorted[i].index, items[i].index) << i;
  }
}

TEST(RadixSort, is_like_stable_sort_for_every_size_around_nothing) {
  SequentialExecutor executor;
  for (std::size_t size = 0; size < 40; ++size) expect_like_stable_sort(random_items(size, 7, 1), 63, executor);
}

TEST(RadixSort, is_like_stable_sort_at_the_edges_of_its_chunks) {
  SequentialExecutor executor;
  for (const std::size_t size : {65'535, 65'536, 65'537, 131'073})
    expect_like_stable_sort(random_items(size, ~0ull >> 1, std::uint32_t(size)), 63, executor);
}

TEST(RadixSort, sorts_by_any_number_of_bits) {
  SequentialExecutor executor;
  for (const int bits : {1, 2, 10, 11, 12, 22, 30, 33, 62, 63, 64}) {
    SCOPED_TRACE(bits);
    expect_like_stable_sort(random_items(5'000, ~0ull >> (64 - bits), std::uint32_t(bits)), bits, executor);
  }
}

TEST(RadixSort, keeps_the_order_of_equal_keys) {
  SequentialExecutor executor;
  expect_like_stable_sort(random_items(100'000, 0, 1), 63, executor);
  expect_like_stable_sort(random_items(100'000, 1ull << 62, 1), 63, executor);  // differ in the last pass only
  expect_like_stable_sort(random_items(100'000, 1, 1), 63, executor);           // differ in the first pass only
}

TEST(RadixSort, sorts_what_is_sorted_and_what_is_reversed) {
  SequentialExecutor executor;
  auto items = random_items(70'000, ~0ull >> 1, 3);
  std::sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  expect_like_stable_sort(items, 63, executor);
  std::reverse(items.begin(), items.end());
  expect_like_stable_sort(items, 63, executor);
}

TEST(RadixSort, sorts_long_keys_whatever_share_of_them_is_alike_in_front) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  ThreadExecutor executor(8);
  std::mt19937 random(5);
  // Of 63 bits 36 are sorted first: here some of the items have them in common, in groups of some size.
  for (const std::size_t group : {2, 30, 33, 300, 3'000, 20'000, 60'000})
    for (const std::size_t every : {1, 3, 12, 100}) {
      SCOPED_TRACE(std::to_string(group) + " alike, in one of " + std::to_string(every) + " places");
      auto items = random_items(60'000, ~0ull >> 1, std::uint32_t(group + every));
      for (std::size_t i = 0; i < items.size(); ++i)
        if (i / group % every == 0) items[i].key = (items[i / group * group].key & ~0ull << 27) | (random() & 0xffff);
      std::shuffle(items.begin(), items.end(), random);
      for (std::size_t i = 0; i < items.size(); ++i) items[i].index = std::uint32_t(i);
      expect_like_stable_sort(items, 63, executor);
    }
}

TEST(RadixSort, does_not_depend_on_the_executor) {
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  for (const int threads : {1, 2, 8}) {
    ThreadExecutor executor(threads);
    expect_like_stable_sort(random_items(700'000, 0xffff'0000'ffff, 9), 48, executor);
  }
}

}  // namespace
}  // namespace boxwood
