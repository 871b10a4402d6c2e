#include "time/execution_timer.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

ExecTime et_ns(std::int64_t ns) {
  return from_ns<ExecTime>(ns);
}
WallTime wt_ns(std::int64_t ns) {
  return from_ns<WallTime>(ns);
}

TEST(ExecutionTimer, RunsWithTheWallClockAndPausesWhileHeld) {
  ExecutionTimer timer(et_ns(100), wt_ns(5'000));
  EXPECT_EQ(timer.read(wt_ns(5'030)), et_ns(130));
  EXPECT_EQ(timer.pause(wt_ns(5'040)), et_ns(140));
  EXPECT_EQ(timer.read(wt_ns(6'000)), et_ns(140));
  EXPECT_EQ(timer.pause(wt_ns(6'500)), et_ns(140));
  timer.resume(wt_ns(7'000), et_ns(155));
  EXPECT_EQ(timer.read(wt_ns(7'000)), et_ns(155));
  EXPECT_EQ(timer.read(wt_ns(7'007)), et_ns(162));
}

}  // namespace
}  // namespace tether::coordinator
