#include <gtest/gtest.h>

#include <tether/os/machine.h>

namespace tether::os {
namespace {

TEST(Clock, MeasuresWhatTheThreadComputes) {
  const Duration begin = read_clock(CLOCK_THREAD_CPUTIME_ID);
  Duration last = begin;
  while (last - begin < std::chrono::milliseconds(2)) {  // ends only if the time grows
    const Duration now = read_clock(CLOCK_THREAD_CPUTIME_ID);
    ASSERT_GE(now, last);
    last = now;
  }
}

TEST(Clock, SleepsUntilAnInstantAndNotForOneThatIsPast) {
  const Duration begin = read_clock(CLOCK_MONOTONIC);
  sleep_until(begin + std::chrono::milliseconds(2));
  EXPECT_GE(read_clock(CLOCK_MONOTONIC), begin + std::chrono::milliseconds(2));
  sleep_until(Duration(-1));
  sleep_until(begin);
}

}  // namespace
}  // namespace tether::os
