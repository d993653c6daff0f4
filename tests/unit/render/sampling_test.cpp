#include "render/sampling.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <vector>

namespace boxwood::render {
namespace {

constexpr std::size_t kSamples = 200000;
constexpr std::size_t kSide = 16;

/// Pearson's statistic of counts that should be equal; its mean is cells - 1, its deviation sqrt(2 * (cells - 1)).
double chi_square(const std::vector<std::size_t>& counts, std::size_t total) {
  const double expected = static_cast<double>(total) / static_cast<double>(counts.size());
  double sum = 0;
  for (const std::size_t count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

/// Six deviations either way: too even is as wrong as too uneven.
void expect_uniform(const std::vector<std::size_t>& counts, std::size_t total) {
  const auto freedom = static_cast<double>(counts.size() - 1);
  EXPECT_NEAR(chi_square(counts, total), freedom, 6 * std::sqrt(2 * freedom));
}

std::size_t cell(double x, double y) {
  const auto index = [](double v) { return std::min(static_cast<std::size_t>(v * kSide), kSide - 1); };
  return index(x) * kSide + index(y);
}

/// The angle around the z axis as a share of the full turn.
double turn(Vector v) {
  return std::atan2(v.y, v.x) / (2 * 3.14159265358979323846) + 0.5;
}

TEST(RandomPair, UniformInTheOpenSquareForSeveralSeeds) {
  for (const std::uint64_t seed : {0ull, 1ull, 2ull, 0xffffffffffffffffull}) {
    std::vector<std::size_t> counts(kSide * kSide);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const Sample2 sample = random_pair(seed, i, 0);
      ASSERT_GT(sample.x, 0);
      ASSERT_LT(sample.x, 1);
      ASSERT_GT(sample.y, 0);
      ASSERT_LT(sample.y, 1);
      ++counts[cell(sample.x, sample.y)];
    }
    expect_uniform(counts, kSamples);
  }
}

TEST(RandomPair, NeighboursInIndexSeedAndDimensionAreIndependent) {
  std::vector<std::size_t> by_index(kSide * kSide), by_seed(kSide * kSide), by_dimension(kSide * kSide);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double x = random_pair(5, i, 0).x;
    ++by_index[cell(x, random_pair(5, i + 1, 0).x)];
    ++by_seed[cell(x, random_pair(6, i, 0).x)];
    ++by_dimension[cell(x, random_pair(5, i, 1).x)];
  }
  expect_uniform(by_index, kSamples);
  expect_uniform(by_seed, kSamples);
  expect_uniform(by_dimension, kSamples);
}

TEST(RandomBits, EveryBitIsSetHalfTheTimeAndNothingRepeats) {
  std::vector<std::size_t> set_bits(64);
  std::set<std::uint64_t> seen;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random_bits(7, i, 3);
    seen.insert(bits);
    for (int bit = 0; bit < 64; ++bit) set_bits[bit] += bits >> bit & 1;
  }
  EXPECT_EQ(seen.size(), 20000u);
  for (const std::size_t count : set_bits) EXPECT_NEAR(static_cast<double>(count), 10000, 6 * std::sqrt(5000.0));
}

TEST(SphereDirection, UniformOnTheSphere) {
  // Equal areas: the height along any axis and the angle around it are uniform and independent (Archimedes).
  std::vector<std::size_t> around_z(kSide * kSide), around_x(kSide * kSide);
  Vector mean;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vector d = sphere_direction(random_pair(11, i, 0));
    ASSERT_NEAR(length(d), 1, 1e-8);
    ++around_z[cell((d.z + 1) / 2, turn(d))];
    ++around_x[cell((d.x + 1) / 2, turn({d.y, d.z, 0}))];
    mean = mean + d * (1.0 / kSamples);
  }
  expect_uniform(around_z, kSamples);
  expect_uniform(around_x, kSamples);
  EXPECT_LT(length(mean), 6 / std::sqrt(static_cast<double>(kSamples)));
}

TEST(CosineDirection, DensityIsTheCosine) {
  // Under a cosine density the squared cosine is uniform, and so is the angle around the normal.
  std::vector<std::size_t> counts(kSide * kSide);
  double mean_cosine = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vector d = cosine_direction(random_pair(13, i, 0), {0, 0, 1});
    ASSERT_NEAR(length(d), 1, 1e-12);
    ++counts[cell(d.z * d.z, turn(d))];
    mean_cosine += d.z / kSamples;
  }
  expect_uniform(counts, kSamples);
  EXPECT_NEAR(mean_cosine, 2.0 / 3, 0.003);
}

TEST(CosineDirection, LeavesEveryPlaneEvenAfterRounding) {
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vector normal = sphere_direction(random_pair(17, i, 0));
    const Vec3 d = cosine_direction(random_pair(17, i, 1), normal).rounded();
    ASSERT_GT(dot(Vector(d), normal), 0) << "sample " << i;
  }
}

TEST(CosineDirection, CornersOfTheSquareAndAxisNormals) {
  const double low = 0x1p-33, high = 1 - 0x1p-33;
  for (const Vector normal : {Vector{1, 0, 0}, Vector{0, -1, 0}, Vector{0, 0, 1}, Vector{0, 0, -1}})
    for (const Sample2 sample : {Sample2{low, low}, Sample2{low, high}, Sample2{high, low}, Sample2{high, high},
                                 Sample2{0.5, 0.5}, Sample2{0.5, low}, Sample2{high, 0.5}}) {
      const Vector d = cosine_direction(sample, normal);
      EXPECT_NEAR(length(d), 1, 1e-12);
      EXPECT_GT(dot(Vector(d.rounded()), normal), 0);
    }
  EXPECT_NEAR(cosine_direction({0.5, 0.5}, {0, 1, 0}).y, 1, 1e-12);
}

}  // namespace
}  // namespace boxwood::render
