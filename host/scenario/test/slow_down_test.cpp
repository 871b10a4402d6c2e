#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

TEST(SlowDown, MultipliesTheFactorOfAClockAndNamesTheCondition) {
  for (const Clock clock : {Clock::kCpu, Clock::kWall}) {
    Condition condition;
    condition.name = "target";
    condition.clock = clock;
    condition.cpu_factor = 6.0;
    slow_down(condition, 2.5);
    EXPECT_DOUBLE_EQ(condition.cpu_factor, 15.0);
    EXPECT_EQ(condition.name, "target, 2.5 x slower");
    EXPECT_EQ(condition.slowed_from, "target");
    EXPECT_EQ(condition.slowdown, 2.5);
  }
}

TEST(SlowDown, MultipliesTheComputingTimeOfAScriptedClock) {
  Condition condition;
  condition.clock = Clock::kScripted;
  condition.computing = std::chrono::milliseconds(20);
  slow_down(condition, 1.5);
  EXPECT_EQ(condition.computing, std::chrono::milliseconds(30));
  EXPECT_EQ(condition.cpu_factor, 1.0);
}

TEST(SlowDown, MultipliesTheCostsOfACountedClock) {
  Condition condition;
  condition.clock = Clock::kCounted;
  condition.target.emplace().emulator.emplace().cost_units = {3, 0, 10};
  slow_down(condition, 1.5);
  EXPECT_THAT(condition.target->emulator->cost_units,
              testing::ElementsAre(5, 0, 15, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_EQ(condition.cpu_factor, 1.0);
}

TEST(SlowDown, LeavesDrawnTimesToTheirReplay) {
  Condition condition;
  condition.clock = Clock::kReplayed;
  condition.replay.emplace().mode = timing::Mode::kResampled;
  slow_down(condition, 1.5);
  EXPECT_EQ(condition.slowdown, 1.5);
  EXPECT_EQ(condition.cpu_factor, 1.0);
}

TEST(SlowDown, RefusesWhatCannotBeStretched) {
  Condition board, unstamped, free_wall, exact;
  exact.clock = Clock::kReplayed;
  exact.replay.emplace().mode = timing::Mode::kExact;
  board.target.emplace().ssh.emplace();
  unstamped.clock = Clock::kUnstamped;
  free_wall.clock = Clock::kWall;
  free_wall.policy = Policy::kFreeRunning;
  for (Condition condition : {board, unstamped, free_wall, exact}) {
    condition.name = "c";
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { slow_down(condition, 2.0); }).subject(), "c");
    EXPECT_EQ(condition.name, "c");
  }
}

}  // namespace
}  // namespace tether::scenario
