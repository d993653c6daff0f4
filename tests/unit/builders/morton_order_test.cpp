#include "builders/parts/morton_order.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "math/morton.h"

namespace boxwood {
namespace {

std::uint64_t interleaved_bit_by_bit(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint64_t code = 0;
  for (int bit = 20; bit >= 0; --bit)
    code = code << 3 | std::uint64_t(x >> bit & 1) << 2 | std::uint64_t(y >> bit & 1) << 1 | (z >> bit & 1);
  return code;
}

TEST(Morton, interleaves_all_bits) {
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const std::uint32_t x = random() >> 11, y = random() >> 11, z = random() >> 11;
    ASSERT_EQ(morton_code(x, y, z), interleaved_bit_by_bit(x, y, z));
  }
  for (int bit = 0; bit < 21; ++bit) {
    EXPECT_EQ(morton_code(1u << bit, 0, 0), 4ull << (3 * bit));
    EXPECT_EQ(morton_code(0, 1u << bit, 0), 2ull << (3 * bit));
    EXPECT_EQ(morton_code(0, 0, 1u << bit), 1ull << (3 * bit));
  }
  EXPECT_EQ(morton_code(0x1fffff, 0x1fffff, 0x1fffff), ~0ull >> 1);
}

TEST(Morton, ignores_bits_above_the_grid) {
  EXPECT_EQ(spread_bits(0xffe00000), 0u);
}

TEST(Morton, corners_of_the_box_are_the_first_and_the_last_cell) {
  for (const int bits : {1, 10, 21}) {
    const MortonGrid grid({{-3, -2, 5}, {7, 40, 5.5f}}, bits);
    EXPECT_EQ(grid.code({-3, -2, 5}), 0u);
    EXPECT_EQ(grid.code({7, 40, 5.5f}), ~0ull >> (64 - 3 * bits));
    EXPECT_EQ(grid.code({-100, -100, -100}), 0u) << "outside counts to the nearest cell";
    EXPECT_EQ(grid.code({100, 100, 100}), ~0ull >> (64 - 3 * bits));
  }
}

TEST(Morton, eight_octants_in_order) {
  const MortonGrid grid({{0, 0, 0}, {2, 2, 2}}, 1);
  std::uint64_t expected = 0;
  for (const float x : {0.5f, 1.5f})
    for (const float y : {0.5f, 1.5f})
      for (const float z : {0.5f, 1.5f}) EXPECT_EQ(grid.code({x, y, z}), expected++);
}

TEST(Morton, boxes_without_extent_and_of_extreme_size) {
  EXPECT_EQ(MortonGrid({{1, 1, 1}, {1, 1, 1}}, 21).code({1, 1, 1}), 0u);
  const std::uint64_t last = ~0ull >> 1;
  for (const float size : {1e-45f, 1e-38f, 1e18f, 2e18f}) {
    const MortonGrid grid({{-size, -size, -size}, {size, size, size}}, 21);
    EXPECT_EQ(grid.code({-size, -size, -size}), 0u);
    EXPECT_EQ(grid.code({size, size, size}), last);
    EXPECT_EQ(grid.code({size, -size, size}), morton_code(0x1fffff, 0, 0x1fffff));
  }
}

TEST(MortonOrder, is_a_permutation_in_the_order_of_the_codes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> position(-50, 50);
  AlignedBuffer<refs::Reference> references(10'000);
  for (std::size_t r = 0; r < references.size(); ++r) {
    const Vec3 p{position(random), position(random), r % 3 ? position(random) : 0};
    references[r] = {p, std::uint32_t(r), p + Vec3{1, 2, 3}, 0};
  }
  SequentialExecutor executor;
  const auto order = builders::morton_order(references.span(), 10, executor);
  std::set<std::uint32_t> seen;
  Box centroids;
  for (const auto& reference : references) centroids.grow(reference.centroid2());
  const MortonGrid grid(centroids, 10);
  for (std::size_t i = 0; i < order.size(); ++i) {
    seen.insert(order[i].index);
    ASSERT_EQ(order[i].key, grid.code(references[order[i].index].centroid2()));
    if (i == 0) continue;
    ASSERT_LE(order[i - 1].key, order[i].key);
    ASSERT_TRUE(order[i - 1].key != order[i].key || order[i - 1].index < order[i].index);
  }
  EXPECT_EQ(seen.size(), references.size());
}

TEST(MortonOrder, FollowsTheCurve) {
  AlignedBuffer<refs::Reference> references(3);
  references[0] = {{5, 0, 0}, 70, {5, 0, 0}, 0};
  references[1] = {{1, 0, 0}, 71, {1, 0, 0}, 0};
  references[2] = {{3, 0, 0}, 72, {3, 0, 0}, 0};
  SequentialExecutor executor;
  const auto order = builders::morton_order(references.span(), 21, executor);
  std::vector<std::uint32_t> primitives;
  for (const auto& item : order) primitives.push_back(references[item.index].primitive);
  EXPECT_EQ(primitives, (std::vector<std::uint32_t>{71, 72, 70}));
}

}  // namespace
}  // namespace boxwood
