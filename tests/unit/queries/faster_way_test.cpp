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

TEST(FasterWay, TriesBothAtOnceAndThenRarely) {
  FasterWay way;
  EXPECT_TRUE(way.try_both(512));
  int trials = 0;
  for (int i = 0; i < 1024; ++i) trials += way.try_both(512);
  EXPECT_GE(trials, 512 * 1024 / 32768);
  EXPECT_LE(trials, 512 * 1024 / 8192);

  for (int i = 0; i < 20; ++i) way.record(1, 2);
  int clear_trials = 0;
  for (int i = 0; i < 1024; ++i) clear_trials += way.try_both(512);
  EXPECT_GE(clear_trials, 1);
  EXPECT_LT(2 * clear_trials, trials);
}

}  // namespace
}  // namespace boxwood::queries
