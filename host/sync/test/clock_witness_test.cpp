#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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
  const ClockWitness witness(wall_bound(1.0), et(seconds(5)), wt(seconds(100)));
  const Duration most = seconds(2) + milliseconds(2) + milliseconds(1);
  EXPECT_EQ(witness.excess(et(seconds(5) + most), wt(seconds(102))), Duration(0));
  EXPECT_EQ(witness.excess(et(seconds(5) + most + Duration(7)), wt(seconds(102))), Duration(7));
  EXPECT_EQ(witness.excess(et(hours(1)), wt(seconds(102))), hours(1) - seconds(5) - most);
}

TEST(ClockWitness, StandingStillEarnsNothing) {
  ClockWitness witness(wall_bound(1.0), et(seconds(0)), wt(seconds(0)));
  witness.go_on(et(seconds(3)), wt(seconds(50)));
  EXPECT_EQ(witness.went_on_at(), et(seconds(3)));
  EXPECT_EQ(witness.excess(et(seconds(3) + milliseconds(1)), wt(seconds(50))), Duration(0));
  EXPECT_EQ(witness.excess(et(seconds(4)), wt(seconds(50))), seconds(1) - milliseconds(1));
}

TEST(ClockWitness, WhatIsBehindIsNotAhead) {
  const ClockWitness witness(wall_bound(1.0), et(seconds(5)), wt(seconds(0)));
  EXPECT_EQ(witness.excess(et(seconds(1)), wt(seconds(0))), Duration(0));
}

TEST(ClockWitness, HoldsForTheGreatestStampsThatThereAre) {
  constexpr auto latest = from_ns<ExecTime>((std::int64_t{1} << 62) - 1);
  const ClockWitness witness(wall_bound(1.0), et(Duration(0)), wt(seconds(1)));
  EXPECT_EQ(witness.excess(latest, wt(seconds(1))), latest - et(milliseconds(1)));
  const ClockWitness fast(cpu_bound(1e6, kMostCores), et(Duration(0)), wt(Duration(0)));
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
    ClockWitness witness(wall_bound(factor), reached, wt(now));
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

// ---- CPU time

TEST(ClockWitness, CpuTimeGrowsOnEachCoreAndByATickOfEach) {
  const ClockWitness witness(cpu_bound(1.0, 2), et(seconds(5)), wt(seconds(0)));
  const Duration most = 2 * (seconds(1) + milliseconds(1)) + milliseconds(20);
  EXPECT_EQ(witness.excess(et(seconds(5) + most), wt(seconds(1))), Duration(0));
  EXPECT_EQ(witness.excess(et(seconds(5) + most + Duration(7)), wt(seconds(1))), Duration(7));
}

TEST(ClockWitness, AFactorStretchesCpuTimeAndItsSlack) {
  const ClockBound one = cpu_bound(1.0, 4), six = cpu_bound(6.0, 4);
  EXPECT_EQ(one.rate, 4.0);
  EXPECT_EQ(one.slack, milliseconds(40));
  EXPECT_EQ(six.rate, 24.0);
  EXPECT_EQ(six.slack, milliseconds(240));
}

TEST(ClockWitness, WhereTheCoresAreNotKnownAnyNumberIsBelieved) {
  EXPECT_EQ(cpu_bound(1.0, 0).rate, 1024.0);
  EXPECT_EQ(cpu_bound(1.0, 0).slack, seconds(1));
}

/// A process on a kernel that accounts threads at its ticks: one that computes besides the reader
/// is seen only as far as its core's last tick.
class TickedProcess {
 public:
  TickedProcess(KeyedRandom& random, int cores) : random_(&random) {
    for (int i = 0; i < cores; ++i) phase_.push_back(part_of(kTick));
  }
  Duration part_of(Duration whole) {
    return Duration(std::llround(random_->uniform() * static_cast<double>(whole.count())));
  }
  /// `busy` of its cores compute for that long, its reader's first.
  void go_on(Duration length, std::size_t busy) {
    now_ += length;
    for (std::size_t i = 0; i < busy; ++i) used_ += length;
    busy_ = busy;
    length_ = length;
  }
  /// CPU time as its first core reads it.
  Duration reading() const {
    Duration late{0};
    for (std::size_t i = 1; i < busy_; ++i) late += std::min(length_, (now_ + phase_[i]) % kTick);
    return used_ - late;
  }
  Duration now() const { return now_; }

 private:
  static constexpr Duration kTick = milliseconds(10);  // the slowest that kernels have
  KeyedRandom* random_;
  std::vector<Duration> phase_;
  Duration now_{0}, used_{0}, length_{0};
  std::size_t busy_ = 0;
};

// Threads beside the one that calls compute on while it is held, and while it is not. What is
// charged for a time in which it was not held may have been used before.
TEST(ClockWitness, NeverDoubtsCpuTimeThatIsAccountedByTicks) {
  Duration furthest{0};
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    KeyedRandom random({.seed = seed});
    const int cores = 1 + static_cast<int>(seed % 8);
    const double factor = 0.1 + 9.9 * random.uniform();
    const auto some = [&] { return random.bits() % (static_cast<std::size_t>(cores) + 1); };
    TickedProcess process(random, cores);
    ExecTime reached{};
    ClockWitness witness(cpu_bound(factor, cores), reached, wt(process.now()));
    for (int i = 0; i < 60; ++i) {
      process.go_on(process.part_of(milliseconds(30)), some());  // held
      witness.go_on(reached, wt(process.now()));
      const Duration before = process.reading(), since = process.now();
      process.go_on(process.part_of(milliseconds(i % 2 == 0 ? 1 : 30)), some());
      const Duration charged = process.reading() - before;
      furthest = std::max(furthest, charged - cores * (process.now() - since));
      reached += Duration(std::llround(static_cast<double>(charged.count()) * factor));
      ASSERT_EQ(witness.excess(reached, wt(process.now())), Duration(0)) << "seed " << seed;
    }
  }
  EXPECT_GT(furthest, milliseconds(10));  // so much of the slack was needed
}

TEST(ClockWitness, FindsCpuTimeThatRunsAheadOfEveryCore) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    KeyedRandom random({.seed = seed});
    const int cores = 1 + static_cast<int>(seed % 16);
    const double factor = 0.1 + 9.9 * random.uniform();
    const Duration elapsed(std::llround(random.uniform() * 1e9));
    const double most_ns = factor * cores * (static_cast<double>(elapsed.count()) * 1.001 + 10e6);
    const ClockWitness witness(cpu_bound(factor, cores), et(seconds(7)), wt(seconds(3)));
    const Duration ahead = milliseconds(1);
    const Duration lie = Duration(std::llround(most_ns)) + ahead;
    const Duration found = witness.excess(et(seconds(7) + lie), wt(seconds(3) + elapsed));
    ASSERT_NEAR(static_cast<double>(found.count()), 1e6, 10.0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tether::sync
