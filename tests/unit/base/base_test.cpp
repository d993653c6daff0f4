#include "boxwood/base.h"

#include <gtest/gtest.h>

#include <memory>
#include <regex>
#include <set>

namespace boxwood {
namespace {

TEST(Result, HoldsAValueOrAnError) {
  Result<std::unique_ptr<int>> good = std::make_unique<int>(3);
  ASSERT_TRUE(good);
  EXPECT_EQ(**good, 3);
  const std::unique_ptr<int> taken = *std::move(good);
  EXPECT_EQ(*taken, 3);
  const Result<int> bad{ErrorCode::not_found, "no such thing"};
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, ErrorCode::not_found);
  EXPECT_EQ(bad.error().message, "no such thing");
  EXPECT_TRUE(Status{});
  EXPECT_EQ(Status(ErrorCode::unwritable, "full").error().message, "full");
}

TEST(AlignedBuffer, AlignsMovesAndTruncates) {
  AlignedBuffer<float> a(100);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a.data()) % 64, 0u);
  a[99] = 7;
  AlignedBuffer<float> b = std::move(a);
  EXPECT_TRUE(a.empty());
  EXPECT_EQ(b[99], 7);
  const auto c = b.clone();
  EXPECT_EQ(c[99], 7);
  b.truncate(10);
  EXPECT_EQ(b.size(), 10u);
  EXPECT_EQ(b.bytes(), 40u);
  EXPECT_THROW(AlignedBuffer<double>(SIZE_MAX / 4), std::bad_alloc);
  EXPECT_TRUE(AlignedBuffer<int>(0).clone().empty());
}

TEST(Hash, DependsOnEveryByteLengthAndSeed) {
  unsigned char data[41] = {};
  std::set<std::uint64_t> seen{hash_bytes(data, 41)};
  for (auto& byte : data) {
    byte = 1;
    EXPECT_TRUE(seen.insert(hash_bytes(data, 41)).second);
    byte = 0;
  }
  for (std::size_t size = 0; size < 41; ++size) EXPECT_TRUE(seen.insert(hash_bytes(data, size)).second) << size;
  EXPECT_TRUE(seen.insert(hash_bytes(data, 41, 1)).second);
  EXPECT_EQ(hash_bytes(data, 41), hash_bytes(data, 41));
}

TEST(Version, IsThreeNumbers) {
  EXPECT_TRUE(std::regex_match(version(), std::regex("[0-9]+\\.[0-9]+\\.[0-9]+")));
}

}  // namespace
}  // namespace boxwood
