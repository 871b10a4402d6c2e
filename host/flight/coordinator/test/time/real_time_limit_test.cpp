#include "time/real_time_limit.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
WallTime wt_ms(std::int64_t ms) {
  return WallTime(milliseconds(ms));
}

TEST(RealTimeLimit, AllowsTimeInProportionToWallTime) {
  RealTimeLimit limit(0.25, milliseconds(100), wt_ms(0));
  EXPECT_EQ(limit.allowance(wt_ms(0)), Duration(0));
  EXPECT_EQ(limit.allowance(wt_ms(40)), milliseconds(10));
  limit.spend(milliseconds(9));
  EXPECT_EQ(limit.allowance(wt_ms(44)), milliseconds(2));
  EXPECT_EQ(limit.wait_for(milliseconds(3)), milliseconds(4));
  EXPECT_EQ(limit.wait_for(milliseconds(1)), Duration(0));
  EXPECT_EQ(limit.allowance(wt_ms(48)), milliseconds(3));
}

TEST(RealTimeLimit, LosesIdleTimeAndTimeAboveTheCredit) {
  RealTimeLimit limit(1.0, milliseconds(20), wt_ms(0));
  EXPECT_EQ(limit.allowance(wt_ms(1'000)), milliseconds(20));
  limit.idle(wt_ms(1'500));
  EXPECT_EQ(limit.allowance(wt_ms(1'501)), milliseconds(1));
}

}  // namespace
}  // namespace tether::coordinator
