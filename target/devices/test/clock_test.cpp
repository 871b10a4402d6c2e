#include "clock.h"

#include "manual_clock.h"

#include <gtest/gtest.h>

namespace tether::devices {
namespace {

TEST(MonotonicClock, IsTheClockOfVideo4LinuxsTimestamps) {
  const MonotonicClock clock;
  const Duration before = std::chrono::steady_clock::now().time_since_epoch();
  const Duration now = clock.now();
  const Duration after = std::chrono::steady_clock::now().time_since_epoch();
  EXPECT_LE(before, now);
  EXPECT_LE(now, after);
}

TEST(MonotonicClock, DoesNotWaitForWhatIsPast) {
  MonotonicClock clock;
  clock.sleep_until(clock.now());
  clock.sleep_until(Duration::zero());
  clock.sleep_until(Duration::min());
}

TEST(Timeline, BeginsWhereItIsMade) {
  ManualClock clock;
  const Timeline time(clock);
  EXPECT_EQ(time.now(), ExecTime{});
  clock.advance(Duration(1234));
  EXPECT_EQ(time.now(), ExecTime(Duration(1234)));
  EXPECT_EQ(time.at(clock.now()), SimTime(Duration(1234)));
  EXPECT_EQ(time.monotonic(time.now()), clock.now());
}

}  // namespace
}  // namespace tether::devices
