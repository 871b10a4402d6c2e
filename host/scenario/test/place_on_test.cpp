#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using testing::HasSubstr;

Target slow(Clock clock) {
  Target target;
  target.name = "slow";
  target.clock = clock;
  target.cpu_factor = 4.0;
  return target;
}

TEST(PlaceOn, TheTargetSaysHowTimeIsMeasured) {
  Condition condition;
  condition.name = "repeatable";
  condition.clock = Clock::kScripted;
  condition.computing = std::chrono::milliseconds(2);
  condition.real_time_factor = 0.5;
  place_on(condition, slow(Clock::kCpu));
  EXPECT_EQ(condition.clock, Clock::kCpu);
  EXPECT_EQ(condition.cpu_factor, 4.0);
  EXPECT_EQ(condition.computing, Duration(0));
  EXPECT_EQ(condition.real_time_factor, 0.5);
  EXPECT_EQ(condition.target->name, "slow");
}

TEST(PlaceOn, FreeRunningTakesTheWallClockAsItIs) {
  Condition condition;
  condition.name = "no sync";
  condition.policy = Policy::kFreeRunning;
  EXPECT_THAT(error_message(ErrorCode::kUsage, [&] { place_on(condition, slow(Clock::kWall)); }),
              HasSubstr("condition \"no sync\": the target \"slow\" scales the wall clock"));
  EXPECT_FALSE(condition.target);

  place_on(condition, slow(Clock::kCpu));
  EXPECT_TRUE(condition.target) << "CPU time can be stalled for";
  Target board = slow(Clock::kWall);
  board.cpu_factor = 1.0;
  EXPECT_EQ(why_not_on(condition, board), "");
  condition.policy = Policy::kConservativeBarrier;
  EXPECT_EQ(why_not_on(condition, slow(Clock::kWall)), "");
}

}  // namespace
}  // namespace tether::scenario
