#include "free_running_clock.h"

#include "fake_wall_timer.h"

#include <gtest/gtest.h>

#include <tether/client_testing/manual_time_source.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;
using client_testing::ManualTimeSource;

class FreeRunning : public testing::Test {
 protected:
  /// `cpu` of CPU time, during which as much wall time goes by.
  void compute(Duration cpu) {
    source_.advance(Duration(std::int64_t(source_.factor()) * cpu.count()));
    wall_.advance(cpu);
  }
  FakeWallTimer wall_;
  ManualTimeSource source_{link::ClockKind::kCpu, 4.0};
  FreeRunningClock clock_{source_, wall_, from_ns<ExecTime>(100)};
};

TEST_F(FreeRunning, ShowsTheWallTimeSinceTheStart) {
  EXPECT_EQ(to_ns(clock_.now()), 100);
  wall_.advance(5ms);
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 5ms);
  clock_.begin();
  wall_.advance(3ms);  // waiting for a reply is not held
  clock_.end(from_ns<ExecTime>(0));
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 8ms);
}

TEST_F(FreeRunning, StallsForWhatTheSlowerTargetNeedsLonger) {
  compute(10ms);
  EXPECT_EQ(clock_.begin(), from_ns<ExecTime>(100) + 40ms);
  EXPECT_EQ(wall_.slept(), 30ms);
}

TEST_F(FreeRunning, DoesNotStallForTheTimeOfACall) {
  clock_.begin();
  compute(10ms);  // the library at work
  clock_.end(ExecTime{});
  clock_.begin();
  EXPECT_EQ(wall_.slept(), 0ms);
}

TEST_F(FreeRunning, StallsOnceForTheSameComputing) {
  compute(1ms);
  clock_.begin();
  clock_.begin();
  clock_.end(ExecTime{});
  clock_.begin();
  EXPECT_EQ(wall_.slept(), 3ms);
}

TEST_F(FreeRunning, SleepsOnTheWallClockAfterStalling) {
  compute(1ms);
  clock_.sleep_until(from_ns<ExecTime>(100) + 20ms);
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 20ms);
  clock_.sleep_until(from_ns<ExecTime>(0));
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 20ms);
}

TEST_F(FreeRunning, ReportsNoProgress) {
  EXPECT_FALSE(clock_.while_computing().has_value());
}

}  // namespace
}  // namespace tether::client
