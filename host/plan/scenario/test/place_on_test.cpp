#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

Target slow(computer::ClockKind clock) {
  Target target;
  target.name = "slow";
  target.clock.kind = clock;
  target.clock.factor = 4.0;
  return target;
}

TEST(PlaceOn, TheTargetsClockReplacesTheConditions) {
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kScripted;
  condition.real_time_factor = 0.5;
  condition.computers[0].clock.computing = std::chrono::milliseconds(2);
  place_on(condition, slow(computer::ClockKind::kCpu));
  EXPECT_EQ(condition.computers[0].clock.kind, computer::ClockKind::kCpu);
  EXPECT_EQ(condition.computers[0].clock.factor, 4.0);
  EXPECT_EQ(condition.computers[0].clock.computing, Duration(0));
  EXPECT_EQ(condition.real_time_factor, 0.5);
  EXPECT_EQ(condition.computers[0].target->name, "slow");
}

TEST(PlaceOn, RefusesAScaledWallClockAndCountedWorkInFreeRunning) {
  Condition condition;
  condition.name = "no sync";
  condition.policy = Policy::kFreeRunning;
  for (const computer::ClockKind clock :
       {computer::ClockKind::kWall, computer::ClockKind::kCounted}) {
    const auto place = [&] { place_on(condition, slow(clock)); };
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, place).subject(), "no sync");
    EXPECT_FALSE(condition.computers[0].target);
  }
  EXPECT_EQ(why_not_on(condition, slow(computer::ClockKind::kCpu)), "");
  Target board = slow(computer::ClockKind::kWall);
  board.clock.factor = 1.0;
  EXPECT_EQ(why_not_on(condition, board), "");
  condition.policy = Policy::kConservativeBarrier;
  EXPECT_EQ(why_not_on(condition, slow(computer::ClockKind::kWall)), "");
}

}  // namespace
}  // namespace tether::scenario
