#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sync/clock_plausibility.h>

namespace tether::sync {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kNone{0};

ExecTime et(Duration t) {
  return ExecTime(t);
}
WallTime wt(Duration t) {
  return WallTime(t);
}

TEST(ClockPlausibility, MeasuresHowFarAStampIsAhead) {
  ClockPlausibility clock(wall_bound(1.0), et(seconds(5)), wt(seconds(100)));
  const Duration most = seconds(2) + milliseconds(2) + milliseconds(1);
  EXPECT_EQ(clock.excess(et(seconds(1)), wt(seconds(100))), kNone);
  EXPECT_EQ(clock.excess(et(seconds(5) + most), wt(seconds(102))), kNone);
  EXPECT_EQ(clock.excess(et(seconds(5) + most + Duration(7)), wt(seconds(102))), Duration(7));
  EXPECT_EQ(clock.excess(et(hours(1)), wt(seconds(102))), hours(1) - seconds(5) - most);
  // The time in which it was stopped does not count.
  clock.go_on(et(seconds(7)), wt(seconds(150)));
  EXPECT_EQ(clock.went_on_at(), et(seconds(7)));
  EXPECT_EQ(clock.excess(et(seconds(7) + milliseconds(1)), wt(seconds(150))), kNone);
  EXPECT_EQ(clock.excess(et(seconds(8)), wt(seconds(150))), seconds(1) - milliseconds(1));
}

TEST(ClockPlausibility, DoesNotOverflowForTheGreatestStamp) {
  constexpr auto latest = from_ns<ExecTime>((std::int64_t{1} << 62) - 1);
  const ClockPlausibility clock(wall_bound(1.0), et(kNone), wt(seconds(1)));
  EXPECT_EQ(clock.excess(latest, wt(seconds(1))), latest - et(milliseconds(1)));
  const ClockPlausibility fast(cpu_bound(1e6, kMostCores), et(kNone), wt(kNone));
  EXPECT_EQ(fast.excess(latest, wt(hours(24 * 365))), kNone);
}

TEST(ClockPlausibility, CpuTimeGrowsOnEachCoreAndByATickOfEach) {
  const struct {
    ClockBound bound;
    double rate;
    Duration slack;
  } cases[] = {{cpu_bound(1.0, 2), 2.0, milliseconds(40)},
               {cpu_bound(6.0, 4), 24.0, milliseconds(360)},
               {cpu_bound(1.0, 0), 1024.0, milliseconds(1020)}};  // unknown: any number of cores
  for (const auto& c : cases) {
    EXPECT_EQ(c.bound.rate, c.rate);
    EXPECT_EQ(c.bound.slack, c.slack);
    const ClockPlausibility clock(c.bound, et(seconds(5)), wt(kNone));
    const Duration most = Duration(std::llround(c.rate * 1.001e9)) + c.slack;
    EXPECT_EQ(clock.excess(et(seconds(5) + most), wt(seconds(1))), kNone);
    EXPECT_EQ(clock.excess(et(seconds(5) + most + Duration(7)), wt(seconds(1))), Duration(7));
  }
}

/// Draws of one run.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_({.seed = seed}) {}
  double uniform(double from, double to) { return from + (to - from) * random_.uniform(); }
  Duration up_to(Duration most) { return scaled(most, random_.uniform()); }
  std::size_t below(std::size_t count) { return random_.bits() % count; }
  static Duration scaled(Duration d, double by) {
    return Duration(std::llround(static_cast<double>(d.count()) * by));
  }

 private:
  KeyedRandom random_;
};

// The SUT's clock drifts within its limits, computes and waits in turns; the link delays messages.
// Its correct stamps are accepted, and a stamp that exceeds all tolerances is found.
TEST(ClockPlausibility, AcceptsACorrectClockAndFindsOneThatRunsAhead) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Draws draw(seed);
    const double factor = draw.uniform(0.1, 10.0), drift = draw.uniform(-2e-4, 2e-4);
    Duration now = draw.up_to(hours(1));
    ExecTime reached{};
    ClockPlausibility clock(wall_bound(factor), reached, wt(now));
    for (int i = 0; i < 50; ++i) {
      const Duration computing = draw.up_to(milliseconds(300)), link = draw.up_to(milliseconds(5));
      now += computing + link;
      reached += Draws::scaled(computing, factor * (1.0 + drift));
      ASSERT_EQ(clock.excess(reached, wt(now)), kNone) << "seed " << seed;
      const Duration margin = Draws::scaled(computing + link, factor * 2e-3) +
                              Draws::scaled(link + Duration(1'001'000), factor);
      const Duration ahead = margin + draw.up_to(seconds(1)) + Duration(3);
      ASSERT_GT(clock.excess(reached + ahead, wt(now)), kNone) << "seed " << seed;
      now += draw.up_to(seconds(2));  // held
      clock.go_on(reached, wt(now));
    }
  }
}

/// A process on a kernel that accounts for threads at its ticks: the time of a thread other than
/// the reader is seen only up to its core's last tick.
class TickedProcess {
 public:
  TickedProcess(Draws& draw, std::size_t cores) {
    for (std::size_t i = 0; i < cores; ++i) phase_.push_back(draw.up_to(kTick));
  }
  /// `busy` of its cores compute for that long, the reader's first.
  void go_on(Duration length, std::size_t busy) {
    now_ += length;
    used_ += static_cast<std::int64_t>(busy) * length;
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
  std::vector<Duration> phase_;
  Duration now_{0}, used_{0}, length_{0};
  std::size_t busy_ = 0;
};

// Other threads compute while the calling thread is held, and while it is not. Time that is charged
// after it resumed may have been used before.
TEST(ClockPlausibility, AcceptsCpuTimeThatIsAccountedByTicks) {
  Duration furthest{0};
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Draws draw(seed);
    const std::size_t cores = 1 + seed % 8;
    const double factor = draw.uniform(0.1, 10.0);
    TickedProcess process(draw, cores);
    ExecTime reached{};
    ClockPlausibility clock(cpu_bound(factor, static_cast<int>(cores)), reached, wt(process.now()));
    for (int i = 0; i < 60; ++i) {
      process.go_on(draw.up_to(milliseconds(30)), draw.below(cores + 1));  // held
      clock.go_on(reached, wt(process.now()));
      const Duration before = process.reading(), since = process.now();
      process.go_on(draw.up_to(milliseconds(i % 2 == 0 ? 1 : 30)), draw.below(cores + 1));
      const Duration charged = process.reading() - before;
      const auto most = static_cast<std::int64_t>(cores) * (process.now() - since);
      furthest = std::max(furthest, charged - most);
      reached += Draws::scaled(charged, factor);
      ASSERT_EQ(clock.excess(reached, wt(process.now())), kNone) << "seed " << seed;
    }
  }
  EXPECT_GT(furthest, milliseconds(10));  // so much of the slack was needed
}

}  // namespace
}  // namespace tether::sync
