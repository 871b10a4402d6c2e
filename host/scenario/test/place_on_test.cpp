#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

Target slow(Clock clock) {
  Target target;
  target.name = "slow";
  target.clock = clock;
  target.cpu_factor = 4.0;
  return target;
}

TEST(PlaceOn, TheTargetsClockReplacesTheConditions) {
  Condition condition;
  condition.clock = Clock::kScripted;
  condition.real_time_factor = 0.5;
  condition.computing = std::chrono::milliseconds(2);
  place_on(condition, slow(Clock::kCpu));
  EXPECT_EQ(condition.clock, Clock::kCpu);
  EXPECT_EQ(condition.cpu_factor, 4.0);
  EXPECT_EQ(condition.computing, Duration(0));
  EXPECT_EQ(condition.real_time_factor, 0.5);
  EXPECT_EQ(condition.target->name, "slow");
}

TEST(PlaceOn, RefusesAScaledWallClockAndCountedWorkInFreeRunning) {
  Condition condition;
  condition.name = "no sync";
  condition.policy = Policy::kFreeRunning;
  for (const Clock clock : {Clock::kWall, Clock::kCounted}) {
    const auto place = [&] { place_on(condition, slow(clock)); };
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, place).subject(), "no sync");
    EXPECT_FALSE(condition.target);
  }
  EXPECT_EQ(why_not_on(condition, slow(Clock::kCpu)), "");
  Target board = slow(Clock::kWall);
  board.cpu_factor = 1.0;
  EXPECT_EQ(why_not_on(condition, board), "");
  condition.policy = Policy::kConservativeBarrier;
  EXPECT_EQ(why_not_on(condition, slow(Clock::kWall)), "");
}

}  // namespace
}  // namespace tether::scenario
