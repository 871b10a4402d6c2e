#include "clocks.h"

#include <gtest/gtest.h>

namespace tether::as_is {
namespace {

using std::chrono::milliseconds;

TEST(AsIsClocks, ShowEtFromTheirBeginning) {
  const ExecTime et = ExecTime(milliseconds(1500));
  EXPECT_EQ(shown(CLOCK_MONOTONIC, et).tv_sec, kUptime_s + 1);
  EXPECT_EQ(shown(CLOCK_MONOTONIC, et).tv_nsec, 500'000'000);
  EXPECT_EQ(shown(CLOCK_REALTIME, et).tv_sec, kEpoch_s + 1);
  EXPECT_FALSE(is_ours(CLOCK_PROCESS_CPUTIME_ID));
  EXPECT_FALSE(is_ours(CLOCK_THREAD_CPUTIME_ID));
}

TEST(AsIsClocks, AnInstantThatTheyShowIsItsEt) {
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME, CLOCK_BOOTTIME, CLOCK_TAI})
    for (const int ms : {0, 1, 999, 1000, 123'456})
      EXPECT_EQ(et_of(clock, shown(clock, ExecTime(milliseconds(ms)))), ExecTime(milliseconds(ms)));
}

TEST(AsIsClocks, InstantsOutsideOfARunAreItsEnds) {
  EXPECT_EQ(et_of(CLOCK_MONOTONIC, {0, 0}), ExecTime{});
  EXPECT_EQ(et_of(CLOCK_REALTIME, {kEpoch_s - 1, 999'999'999}), ExecTime{});
  EXPECT_GT(et_of(CLOCK_MONOTONIC, {INT64_MAX, 0}), ExecTime(std::chrono::hours(24)));
}

TEST(AsIsClocks, DurationsThatAreNoneAreRefused) {
  EXPECT_FALSE(duration_of({-1, 0}));
  EXPECT_FALSE(duration_of({0, 1'000'000'000}));
  EXPECT_FALSE(duration_of({0, -1}));
  // A date is one as well: since 1970.
  EXPECT_EQ(duration_of({2'000'000'000, 0}), std::chrono::seconds(2'000'000'000));
  EXPECT_EQ(duration_of({2, 5}), std::chrono::seconds(2) + Duration(5));
}

}  // namespace
}  // namespace tether::as_is
