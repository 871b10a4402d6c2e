#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

TEST(SlowDown, MultipliesTheFactorOfAClockAndNamesTheCondition) {
  for (const computer::ClockKind clock : {computer::ClockKind::kCpu, computer::ClockKind::kWall}) {
    Condition condition;
    condition.name = "target";
    condition.computers[0].clock.kind = clock;
    condition.computers[0].clock.factor = 6.0;
    slow_down(condition, 2.5);
    EXPECT_DOUBLE_EQ(condition.computers[0].clock.factor, 15.0);
    EXPECT_EQ(condition.name, "target, 2.5 × slower");
    EXPECT_EQ(condition.slowed_from, "target");
    EXPECT_EQ(condition.slowdown, 2.5);
  }
}

TEST(SlowDown, MultipliesTheComputingTimeOfAScriptedClock) {
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kScripted;
  condition.computers[0].clock.computing = std::chrono::milliseconds(20);
  slow_down(condition, 1.5);
  EXPECT_EQ(condition.computers[0].clock.computing, std::chrono::milliseconds(30));
  EXPECT_EQ(condition.computers[0].clock.factor, 1.0);
}

TEST(SlowDown, MultipliesTheCostsOfACountedClock) {
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kCounted;
  condition.computers[0].target.emplace().emulator.emplace().cost_units = {3, 0, 10};
  slow_down(condition, 1.5);
  EXPECT_THAT(condition.computers[0].target->emulator->cost_units,
              testing::ElementsAre(5, 0, 15, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_EQ(condition.computers[0].clock.factor, 1.0);
}

TEST(SlowDown, LeavesDrawnTimesToTheirReplay) {
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kReplayed;
  condition.replay.emplace().mode = computer::ReplayMode::kResampled;
  slow_down(condition, 1.5);
  EXPECT_EQ(condition.slowdown, 1.5);
  EXPECT_EQ(condition.computers[0].clock.factor, 1.0);
}

TEST(SlowDown, RefusesWhatCannotBeStretched) {
  Condition board, unstamped, free_wall, exact;
  exact.computers[0].clock.kind = computer::ClockKind::kReplayed;
  exact.replay.emplace().mode = computer::ReplayMode::kExact;
  board.computers[0].target.emplace().ssh.emplace();
  unstamped.computers[0].clock.kind = computer::ClockKind::kUnstamped;
  free_wall.computers[0].clock.kind = computer::ClockKind::kWall;
  free_wall.policy = Policy::kFreeRunning;
  for (Condition condition : {board, unstamped, free_wall, exact}) {
    condition.name = "c";
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { slow_down(condition, 2.0); }).subject(), "c");
    EXPECT_EQ(condition.name, "c");
  }
}

}  // namespace
}  // namespace tether::scenario
