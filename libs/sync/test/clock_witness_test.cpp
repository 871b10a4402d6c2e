#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sync/clock_witness.h>

namespace tether::sync {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

ExecTime et(Duration t) {
  return ExecTime(t);
}
WallTime wt(Duration t) {
  return WallTime(t);
}

TEST(ClockWitness, NamesTheSizeOfWhatIsAhead) {
  const ClockWitness witness(1.0, et(seconds(5)), wt(seconds(100)));
  const Duration most = seconds(2) + milliseconds(2) + milliseconds(1);
  EXPECT_EQ(witness.excess(et(seconds(5) + most), wt(seconds(102))), Duration(0));
  EXPECT_EQ(witness.excess(et(seconds(5) + most + Duration(7)), wt(seconds(102))), Duration(7));
  EXPECT_EQ(witness.excess(et(hours(1)), wt(seconds(102))), hours(1) - seconds(5) - most);
}

TEST(ClockWitness, StandingStillEarnsNothing) {
  ClockWitness witness(1.0, et(seconds(0)), wt(seconds(0)));
  witness.go_on(et(seconds(3)), wt(seconds(50)));
  EXPECT_EQ(witness.went_on_at(), et(seconds(3)));
  EXPECT_EQ(witness.excess(et(seconds(3) + ClockWitness::kJitter), wt(seconds(50))), Duration(0));
  EXPECT_EQ(witness.excess(et(seconds(4)), wt(seconds(50))), seconds(1) - ClockWitness::kJitter);
}

TEST(ClockWitness, WhatIsBehindIsNotAhead) {
  const ClockWitness witness(1.0, et(seconds(5)), wt(seconds(0)));
  EXPECT_EQ(witness.excess(et(seconds(1)), wt(seconds(0))), Duration(0));
}

TEST(ClockWitness, HoldsForTheGreatestStampsThatThereAre) {
  constexpr auto latest = from_ns<ExecTime>((std::int64_t{1} << 62) - 1);
  const ClockWitness witness(1.0, et(Duration(0)), wt(seconds(1)));
  EXPECT_EQ(witness.excess(latest, wt(seconds(1))), latest - et(ClockWitness::kJitter));
  const ClockWitness fast(1e12, et(Duration(0)), wt(Duration(0)));
  EXPECT_EQ(fast.excess(latest, wt(hours(24 * 365))), Duration(0));
}

// A run seen from outside: the SUT's clock drifts within bounds, computes and waits in turns; the
// link delays what either side hears. Its honest stamps are never doubted, and one that is ahead of
// everything that has gone by is found out by as much as it exceeds the tolerances.
TEST(ClockWitness, NeverDoubtsAnHonestClockAndFindsOneThatRunsAhead) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    KeyedRandom random({.seed = seed});
    const auto up_to = [&](Duration most) {
      return Duration(std::llround(random.uniform() * static_cast<double>(most.count())));
    };
    const double factor = 0.1 + 9.9 * random.uniform();
    const double drift = 2e-4 * (2.0 * random.uniform() - 1.0);
    Duration now = up_to(hours(1));
    ExecTime reached{};
    ClockWitness witness(factor, reached, wt(now));
    for (int i = 0; i < 50; ++i) {
      const Duration computing = up_to(milliseconds(300));
      const Duration link = up_to(milliseconds(5));
      now += computing + link;
      const auto grown =
          Duration(std::llround(static_cast<double>(computing.count()) * factor * (1.0 + drift)));
      reached += grown;
      ASSERT_EQ(witness.excess(reached, wt(now)), Duration(0)) << "seed " << seed;
      const double margin_ns =
          factor * (static_cast<double>((computing + link).count()) * 2e-3 + 1.001e6) +
          factor * static_cast<double>(link.count());
      const Duration lie = Duration(std::llround(margin_ns)) + up_to(seconds(1)) + Duration(1);
      ASSERT_GT(witness.excess(reached + lie, wt(now)), Duration(0)) << "seed " << seed;
      now += up_to(seconds(2));  // held
      witness.go_on(reached, wt(now));
    }
  }
}

}  // namespace
}  // namespace tether::sync
