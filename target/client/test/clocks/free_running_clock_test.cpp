#include "clocks/free_running_clock.h"

#include "clocks/fake_wall_timer.h"

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
    source_.advance(Duration(std::int64_t(source_.clock().factor) * cpu.count()));
    wall_.advance(cpu);
  }
  FakeWallTimer wall_;
  ManualTimeSource source_{computer::ClockKind::kCpu, 4.0};
  FreeRunningClock clock_{source_, wall_, from_ns<ExecTime>(100), 1.0};
};

TEST_F(FreeRunning, FollowsSimulatedTimeAtTheRealTimeFactorFromTheLastReplyOn) {
  FreeRunningClock clock(source_, wall_, from_ns<ExecTime>(100), 0.3);
  EXPECT_EQ(to_ns(clock.now()), 100);
  wall_.advance(10ms);
  EXPECT_EQ(clock.now(), from_ns<ExecTime>(100) + 3ms);
  const ExecTime stamp = clock.begin();
  wall_.advance(10ms);  // waiting for a reply is not held
  EXPECT_EQ(clock.now(), from_ns<ExecTime>(100) + 6ms);
  EXPECT_EQ(clock.begin(), stamp) << "of the same call";
  clock.end(ExecTime(7ms));
  EXPECT_EQ(clock.now(), ExecTime(7ms));
  wall_.advance(10ms);
  EXPECT_EQ(clock.now(), ExecTime(10ms));
}

TEST_F(FreeRunning, StandsStillWhileSimulatedTimeIsBehindIt) {
  wall_.advance(10ms);
  const ExecTime shown = clock_.now();
  clock_.begin();
  clock_.end(ExecTime(4ms));
  EXPECT_EQ(clock_.now(), shown);
  wall_.advance(6ms);
  EXPECT_EQ(clock_.now(), shown);
  wall_.advance(2ms);
  EXPECT_EQ(clock_.now(), ExecTime(12ms));
}

TEST_F(FreeRunning, StallsOnceForWhatTheSlowerTargetNeedsLonger) {
  compute(10ms);
  EXPECT_EQ(clock_.begin(), from_ns<ExecTime>(100) + 40ms);
  EXPECT_EQ(wall_.slept(), 30ms);
  compute(10ms);  // the library, which does not count
  clock_.begin();
  clock_.end(clock_.now());
  clock_.begin();
  EXPECT_EQ(wall_.slept(), 30ms);
}

TEST_F(FreeRunning, WaitingForACoreOfThisMachineIsPartOfTheStall) {
  compute(10ms);
  wall_.advance(25ms);  // another process had the core
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 40ms);
  EXPECT_EQ(clock_.begin(), from_ns<ExecTime>(100) + 40ms);
  EXPECT_EQ(wall_.slept(), 5ms);
  clock_.end(clock_.now());
  compute(10ms);
  wall_.advance(40ms);  // longer than the target computes
  EXPECT_EQ(clock_.begin(), from_ns<ExecTime>(100) + 90ms);
  EXPECT_EQ(wall_.slept(), 5ms);
}

TEST_F(FreeRunning, EtIncludesThePendingStall) {
  compute(10ms);
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 40ms);
  compute(1ms);
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 44ms);
  EXPECT_EQ(wall_.slept(), 0ms);
  EXPECT_EQ(clock_.begin(), from_ns<ExecTime>(100) + 44ms);
  compute(1ms);  // the library at work
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 45ms);
  clock_.end(clock_.now());
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 45ms);
  compute(2ms);
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 53ms);
}

TEST_F(FreeRunning, ShowsTheSameTimeBeforeDuringAndAfterAStall) {
  compute(10ms);
  int stalls = 0;
  wall_.during_sleep([&] {
    EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 40ms);
    wall_.advance(20ms);
    EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 40ms);
    ++stalls;
  });
  clock_.begin();
  EXPECT_EQ(stalls, 1);
  EXPECT_EQ(clock_.now(), from_ns<ExecTime>(100) + 40ms);
}

TEST_F(FreeRunning, DoesNotStallWithoutAFactor) {
  ManualTimeSource source(computer::ClockKind::kWall);
  FreeRunningClock clock(source, wall_, ExecTime{}, 1.0);
  source.advance(5ms);
  wall_.advance(5ms);
  EXPECT_EQ(clock.now(), ExecTime(5ms));
  EXPECT_EQ(clock.begin(), ExecTime(5ms));
  EXPECT_EQ(wall_.slept(), 0ms);
}

TEST_F(FreeRunning, SendsHeartbeatsExceptWhileAReplyIsPending) {
  compute(10ms);
  EXPECT_EQ(clock_.while_computing(), from_ns<ExecTime>(100) + 40ms);
  int sleeps = 0;
  wall_.during_sleep([&] {
    EXPECT_TRUE(clock_.while_computing().has_value());
    ++sleeps;
  });
  clock_.begin();
  EXPECT_EQ(sleeps, 1);  // the stall
  EXPECT_FALSE(clock_.while_computing().has_value());
  clock_.end(clock_.now());
  EXPECT_EQ(clock_.while_computing(), clock_.now());
}

}  // namespace
}  // namespace tether::client
