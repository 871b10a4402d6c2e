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

TEST(ExecutionTimer, RunsWithTheWallClock) {
  const ExecutionTimer timer(et(100), wt(5'000));
  EXPECT_EQ(timer.read(wt(5'000)), et(100));
  EXPECT_EQ(timer.read(wt(5'030)), et(130));
}

TEST(ExecutionTimer, StandsStillWhileHeldAndResumesAtTheReplysTimestamp) {
  ExecutionTimer timer(et(0), wt(0));
  EXPECT_EQ(timer.pause(wt(10)), et(10));
  EXPECT_EQ(timer.read(wt(1'000)), et(10));
  timer.resume(wt(2'000), et(25));
  EXPECT_EQ(timer.read(wt(2'000)), et(25));
  EXPECT_EQ(timer.read(wt(2'007)), et(32));
}

TEST(ExecutionTimer, PausingTwiceChargesOnce) {
  ExecutionTimer timer(et(0), wt(0));
  EXPECT_EQ(timer.pause(wt(10)), et(10));
  EXPECT_EQ(timer.pause(wt(50)), et(10));
}

}  // namespace
}  // namespace tether::sync
