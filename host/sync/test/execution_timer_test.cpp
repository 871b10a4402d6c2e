#include <gtest/gtest.h>

#include <tether/sync/execution_timer.h>

namespace tether::sync {
namespace {

ExecTime et(std::int64_t ns) {
  return from_ns<ExecTime>(ns);
}
WallTime wt(std::int64_t ns) {
  return from_ns<WallTime>(ns);
}

TEST(ExecutionTimer, RunsWithTheWallClockAndPausesWhileHeld) {
  ExecutionTimer timer(et(100), wt(5'000));
  EXPECT_EQ(timer.read(wt(5'030)), et(130));
  EXPECT_EQ(timer.pause(wt(5'040)), et(140));
  EXPECT_EQ(timer.read(wt(6'000)), et(140));
  EXPECT_EQ(timer.pause(wt(6'500)), et(140));
  timer.resume(wt(7'000), et(155));
  EXPECT_EQ(timer.read(wt(7'000)), et(155));
  EXPECT_EQ(timer.read(wt(7'007)), et(162));
}

}  // namespace
}  // namespace tether::sync
