#include <cmath>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

using Fly = std::function<Flight(double slowdown, double uniform)>;

constexpr std::size_t kMost = 200;

Answer size(Sizing& sizing, std::uint64_t seed, const Fly& fly) {
  KeyedRandom random({seed, 1, 2});
  for (;;) {
    const bool is_last = sizing.flights().size() >= kMost;
    const Answer answer = sizing.answer(is_last);
    if (answer.is_narrow || is_last) return answer;
    for (const double slowdown : sizing.next(2)) sizing.add(fly(slowdown, random.uniform()));
  }
}

Answer size(const CurveGrid& grid, std::uint64_t seed, const Fly& fly) {
  Sizing sizing(grid, false);
  return size(sizing, seed, fly);
}

Fly curve(double threshold, double width, double lapses) {
  return [=](double slowdown, double uniform) {
    const double logit = std::log(0.9 / (1.0 - lapses) / (1.0 - 0.9 / (1.0 - lapses)));
    const double z = std::log(threshold / slowdown) / width + logit;
    return Flight{slowdown, uniform < (1.0 - lapses) / (1.0 + std::exp(-z))};
  };
}

// How often the interval holds the threshold, of 60 experiments.
int covered(double confidence) {
  const CurveGrid grid({.confidence = confidence, .interval = 1.6, .least = 1.0, .most = 20.0});
  int covered = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    KeyedRandom random({i, 3, 4});
    const double threshold = 2.0 * std::pow(5.0, random.uniform());
    const double width = 0.1 + 0.2 * random.uniform(), lapses = 0.03 * random.uniform();
    const Answer answer = size(grid, i, curve(threshold, width, lapses));
    if (answer.threshold.low <= threshold && threshold <= answer.threshold.high) ++covered;
  }
  return covered;
}

// bench/sizing_bench has 10,000. If the chance were 0.85, this would pass once in 50 times.
TEST(Sizing, IntervalCoversTheThresholdAsOftenAsItSays) {
  EXPECT_GE(covered(0.95), 56);
}

// An interval that always covers would be no statement.
TEST(Sizing, IntervalOfLittleConfidenceMissesTheThresholdOften) {
  const int half = covered(0.5);
  EXPECT_GE(half, 20);
  EXPECT_LE(half, 48);
}

TEST(Sizing, SameFlightsGiveTheSameAnswer) {
  const CurveGrid grid({});
  const Fly fly = curve(3.0, 0.1, 0.0);
  Sizing one(grid, false), other(grid, false);
  const Answer answer = size(one, 1, fly);
  for (const Flight& flight : one.flights()) other.add(flight);
  const Answer again = other.answer();
  EXPECT_EQ(again.threshold.low, answer.threshold.low);
  EXPECT_EQ(again.threshold.high, answer.threshold.high);
  EXPECT_TRUE(again.is_narrow);
}

TEST(Sizing, SaysThatTheThresholdIsOutsideTheRange) {
  const CurveGrid grid({.least = 1.0, .most = 8.0});
  const Answer above = size(grid, 1, [](double x, double) { return Flight{x, true}; });
  EXPECT_TRUE(above.is_above && above.is_narrow && !above.is_below);
  EXPECT_EQ(above.threshold.estimate, 8.0);
  const Answer below = size(grid, 1, [](double x, double) { return Flight{x, false}; });
  EXPECT_TRUE(below.is_below && below.is_narrow && !below.is_above);
  EXPECT_EQ(below.threshold.high, 1.0);
}

// Success returns after a gap, as where a loop misses one camera period, but not the next.
TEST(Sizing, IsNotFooledByAGap) {
  const CurveGrid grid({.interval = 1.6, .least = 1.0, .most = 20.0});
  int before_gap = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Answer answer = size(grid, i, [](double x, double uniform) {
      return Flight{x, uniform < (x <= 3.0 ? 0.99 : x <= 5.0 ? 0.2 : x <= 9.0 ? 0.97 : 0.0)};
    });
    if (answer.threshold.low <= 3.2) ++before_gap;
  }
  EXPECT_GE(before_gap, 9);
}

TEST(Sizing, FliesAgainWhereAFlightBelowTheThresholdFailed) {
  const CurveGrid grid({.interval = 1.6, .least = 1.0, .most = 20.0});
  Sizing sizing(grid, false);
  for (std::size_t i = 0; i < grid.slowdowns().size(); i += 2)
    sizing.add({grid.slowdowns()[i], true});
  sizing.add({2.0, false});
  while (sizing.flights().size() % 4 != 0) sizing.add({20.0, true});
  EXPECT_NEAR(sizing.next(4).back(), 2.0, 0.4);
}

TEST(Sizing, AnswersByLevelsWhereNoCurveFits) {
  const CurveGrid grid({.interval = 1.6, .least = 1.0, .most = 20.0});
  Sizing sizing(grid, false);
  for (const double level : grid.slowdowns()) {
    for (int i = 0; i < 3; ++i) sizing.add({level, level < 3.0 || (level > 4.5 && level < 9.0)});
  }
  const Answer answer = sizing.answer(true);
  EXPECT_EQ(answer.basis, Basis::kLevels);
  EXPECT_LT(answer.fit, 0.01);
  EXPECT_LT(answer.threshold.high, 4.5);
  const double next = sizing.next(1).front();
  EXPECT_LT(next, answer.threshold.high);
}

TEST(Sizing, LeavesMarginsThatDoNotFit) {
  const CurveGrid grid({.interval = 1.6, .least = 1.0, .most = 20.0});
  Sizing sizing(grid, true);
  KeyedRandom random({1, 1, 1});
  for (int i = 0; i < 200; ++i) {
    const double level = grid.slowdowns()[static_cast<std::size_t>(i) % grid.slowdowns().size()];
    const bool reached = random.uniform() < 1.0 / (1.0 + std::pow(level / 5.0, 6.0));
    sizing.add({level, reached, reached ? 0.4 * random.uniform() : -0.004 * random.uniform()});
  }
  EXPECT_EQ(sizing.answer(true).basis, Basis::kCurve);
}

// Programs that fail at random, whatever the computer.
TEST(Sizing, LeavesMarginsIfMostMissesHaveNone) {
  const CurveGrid grid({.success = 0.7, .interval = 1.6, .least = 1.0, .most = 20.0});
  Sizing sizing(grid, true);
  KeyedRandom random({1, 1, 2});
  for (std::size_t i = 0; i < 60; ++i) {
    const double level = grid.slowdowns()[7 * i % grid.slowdowns().size()];
    const bool reached = random.uniform() < 0.4;
    sizing.add({level, reached, reached ? std::optional(0.5) : std::nullopt});
  }
  const Answer answer = sizing.answer(true);
  EXPECT_NE(answer.basis, Basis::kMargins);
  EXPECT_EQ(answer.threshold.low, 0.0) << "no slowdown is known to do";
}

// One slowdown where all succeed, between others where they do not, is not an answer.
TEST(Sizing, SpreadsFlightsAlsoAtTheEndsOfTheRange) {
  const CurveGrid grid({.least = 1.0, .most = 20.0});
  for (const bool reached : {false, true}) {
    Sizing sizing(grid, false);
    for (int i = 0; i < 30; ++i)
      for (const double slowdown : sizing.next(2)) sizing.add({slowdown, reached});
    std::set<double> near_end;
    for (const Flight& flight : sizing.flights()) {
      EXPECT_GE(flight.slowdown, 1.0);
      EXPECT_LE(flight.slowdown, 20.0);
      const double from_end = reached ? 20.0 / flight.slowdown : flight.slowdown / 1.0;
      if (from_end < 1.12) near_end.insert(flight.slowdown);
    }
    EXPECT_GE(near_end.size(), 5U) << reached;
  }
}

TEST(Sizing, IsNotFooledByOneGoodSlowdownAtTheEnd) {
  const CurveGrid grid({.least = 1.0, .most = 20.0});
  for (std::uint64_t i = 0; i < 3; ++i) {
    const Answer answer = size(grid, i, [](double x, double uniform) {
      return Flight{x, x < 8.0 || x >= 19.9 || uniform < 0.7};
    });
    EXPECT_FALSE(answer.is_above) << i;
  }
}

TEST(Sizing, AnswersByLevelsWhereNeighboursDisagree) {
  const CurveGrid grid({.interval = 1.6, .least = 1.0, .most = 20.0});
  Sizing sizing(grid, false);
  for (const double slowdown : grid.slowdowns()) {
    const double tooth = std::log(slowdown) / 0.07;
    for (int i = 0; i < 2; ++i)
      sizing.add({slowdown, slowdown < 5.0 || tooth - std::floor(tooth) < 0.6});
  }
  EXPECT_EQ(sizing.answer(true).basis, Basis::kLevels);
}

}  // namespace
}  // namespace tether::sizing
