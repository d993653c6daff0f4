// When a call's incoherent rays go both ways, and what it makes of the times.
#include <gtest/gtest.h>

#include "queries/batch.h"

namespace boxwood::queries {
namespace {

TEST(FasterWay, StartsInFlightAndGoesWhereItIsFaster) {
  FasterWay way;
  EXPECT_TRUE(way.is_in_flight());
  for (int i = 0; i < 8; ++i) way.record(2, 1);
  EXPECT_FALSE(way.is_in_flight());
  for (int i = 0; i < 8; ++i) way.record(1, 2);
  EXPECT_TRUE(way.is_in_flight());
}

TEST(FasterWay, OneDisturbedTrialDecidesNothing) {
  FasterWay way;
  for (int i = 0; i < 20; ++i) way.record(2, 3);
  way.record(1000, 1);
  EXPECT_TRUE(way.is_in_flight());
  for (int i = 0; i < 20; ++i) way.record(3, 2);
  way.record(1, 1000);
  EXPECT_FALSE(way.is_in_flight());
  way.record(1, 0);  // a clock that stands still says nothing
  EXPECT_FALSE(way.is_in_flight());
}

TEST(FasterWay, TheFirstTrialDecides) {
  FasterWay way;
  way.record(1.1, 1);
  EXPECT_FALSE(way.is_in_flight());
  FasterWay other;
  other.record(1, 1.1);
  EXPECT_TRUE(other.is_in_flight());
}

int trials_of(FasterWay& way, int pieces) {
  int trials = 0;
  for (int i = 0; i < pieces; ++i) trials += way.try_both(512);
  return trials;
}

TEST(FasterWay, TriesBothAtOnceAndThenRarely) {
  FasterWay way;
  EXPECT_TRUE(way.try_both(512));
  const int trials = trials_of(way, 1024);
  EXPECT_GE(trials, 512 * 1024 / 65536);
  EXPECT_LE(trials, 512 * 1024 / 8192);

  for (int i = 0; i < 20; ++i) way.record(1, 2);
  const int clear_trials = trials_of(way, 1024);
  EXPECT_GE(clear_trials, 1);
  EXPECT_LT(2 * clear_trials, trials);
}

TEST(FasterWay, LongCallsAskAgainAtOnceAndShortOnesDoNot) {
  FasterWay way;
  trials_of(way, 1024);
  for (int i = 0; i < 20; ++i) way.record(1, 2);
  trials_of(way, 1024);
  while (!way.try_both(512)) {
  }
  way.begin_call(1000);
  EXPECT_FALSE(way.try_both(512));
  way.begin_call(1000000);
  EXPECT_TRUE(way.try_both(512));
  // Their rays may be of another kind, so two trials turn the decision that many had made.
  way.record(2, 1);
  way.record(2, 1);
  EXPECT_FALSE(way.is_in_flight());
}

TEST(FasterWay, ADisturbedTrialAtALongCallsBeginningIsSoonMadeGood) {
  FasterWay way;
  for (int i = 0; i < 20; ++i) way.record(1, 1.3);
  trials_of(way, 1024);
  way.begin_call(1000000);
  ASSERT_TRUE(way.try_both(512));
  way.record(1000, 1);
  EXPECT_FALSE(way.is_in_flight());
  int pieces = 0;
  for (; !way.is_in_flight() && pieces < 1000; ++pieces)
    if (way.try_both(512)) way.record(1, 1.3);
  EXPECT_LE(512 * pieces, 16384);
}

}  // namespace
}  // namespace boxwood::queries
