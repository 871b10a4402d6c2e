#include "statistics.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <tether/base/random.h>

namespace tether::calibration {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Times about a median, with a long tail above, as interrupts make it.
std::vector<double> times(double median_ms, double scatter, std::uint64_t stream, int rounds = 30) {
  std::vector<double> values;
  for (int i = 0; i < rounds; ++i) {
    KeyedRandom random({.seed = 7, .stream = stream, .index = static_cast<std::uint64_t>(i)});
    const double tail = random.uniform() < 0.1 ? 1.0 : 0.0;
    values.push_back(median_ms * std::exp(scatter * (random.normal() + tail)));
  }
  return values;
}

Calibration machine(const std::vector<std::pair<std::string, std::vector<double>>>& blocks) {
  Calibration calibration;
  for (const auto& [name, values] : blocks) calibration.blocks.push_back({name, values, values});
  return calibration;
}

Calibration steady(double prefilter_ms, double tracking_ms, double whole_ms) {
  return machine({{"prefilter", std::vector<double>(20, prefilter_ms)},
                  {"tracking", std::vector<double>(20, tracking_ms)},
                  {kWholeStep, std::vector<double>(20, whole_ms)}});
}

TEST(Quartiles, LieBetweenTheTimes) {
  const Quartiles of = quartiles({4.0, 1.0, 3.0, 2.0, 5.0});
  EXPECT_EQ(of.lower, 2.0);
  EXPECT_EQ(of.median, 3.0);
  EXPECT_EQ(of.upper, 4.0);
  EXPECT_DOUBLE_EQ(of.spread(), 2.0 / 3.0);
  EXPECT_EQ(quartiles({1.0, 2.0}).median, 1.5);
  EXPECT_EQ(quartiles({7.0}).spread(), 0.0);
}

// Ranks from the binomial distribution: of 30 values the 9th and the 22nd, P(X <= 8) = 0.0081.
TEST(MedianInterval, IsTakenFromTheRanks) {
  std::vector<double> values;
  for (int i = 1; i <= 30; ++i) values.push_back(i);
  const Interval of = median_interval(values);
  EXPECT_EQ(of.low, 9.0);
  EXPECT_EQ(of.high, 22.0);
  // Of ten the 2nd and the 9th: P(X <= 1) = 0.0107, P(X <= 2) = 0.055.
  values.resize(10);
  EXPECT_EQ(median_interval(values).low, 2.0);
  EXPECT_EQ(median_interval(values).high, 9.0);
}

TEST(Compare, GivesTheFactorOfEachBlockAndTheirMean) {
  const auto of = compare(steady(10.0, 1.0, 11.0), steady(40.0, 9.0, 49.5));
  ASSERT_TRUE(of) << of.failure().message;
  ASSERT_EQ(of->blocks.size(), 3u);
  EXPECT_DOUBLE_EQ(of->blocks[0].value, 4.0);
  EXPECT_DOUBLE_EQ(of->blocks[1].value, 9.0);
  EXPECT_DOUBLE_EQ(of->whole.value, 4.5);
  EXPECT_DOUBLE_EQ(of->overall.value, 6.0) << "without the whole step, which has them in it";
  EXPECT_EQ(of->least().block, "prefilter");
  EXPECT_EQ(of->greatest().block, "tracking");
}

TEST(Compare, FindsAFactorThatIsThere) {
  for (const double factor : {0.2, 1.0, 6.5, 80.0}) {
    const Calibration here =
        machine({{"x", times(8.0, 0.03, 1)}, {kWholeStep, times(8.0, 0.03, 2)}});
    const Calibration there =
        machine({{"x", times(8.0 * factor, 0.03, 3)}, {kWholeStep, times(8.0 * factor, 0.03, 4)}});
    const auto of = compare(here, there);
    ASSERT_TRUE(of);
    EXPECT_NEAR(of->whole.value / factor, 1.0, 0.03);
    EXPECT_LE(of->whole.interval.low, factor);
    EXPECT_GE(of->whole.interval.high, factor);
    EXPECT_LT(of->whole.interval.high / of->whole.interval.low, 1.15);
    const auto back = compare(there, here);
    EXPECT_NEAR(of->whole.value * back->whole.value, 1.0, 1e-12);
    EXPECT_NEAR(of->whole.interval.low * back->whole.interval.high, 1.0, 1e-12);
  }
}

TEST(Compare, RefusesFewRoundsAndDifferentBlocks) {
  const Calibration whole = steady(1.0, 1.0, 1.0);
  Calibration renamed = whole, shorter = whole, few = whole;
  renamed.blocks[0].name = "another";
  shorter.blocks.pop_back();
  few.blocks[1].cpu_ms.resize(9);
  for (const auto& comparison : {compare(whole, renamed), compare(whole, shorter),
                                 compare(shorter, shorter), compare(whole, few)}) {
    ASSERT_FALSE(comparison);
    EXPECT_EQ(comparison.failure().kind, Failure::Kind::kInvalid);
  }
}

TEST(Doubts, ReportLoadDriftScatterAndChangedClockRate) {
  Calibration calibration = machine({{kWholeStep, times(8.0, 0.01, 1)}});
  calibration.machine.mhz_before = 1500.0;
  calibration.machine.mhz_after = 1510.0;
  EXPECT_THAT(doubts(calibration), IsEmpty());
  calibration.machine.mhz_after = 0.0;  // not known
  EXPECT_THAT(doubts(calibration), IsEmpty());
  calibration.machine.mhz_after = 600.0;
  EXPECT_THAT(doubts(calibration), ElementsAre(AllOf(HasSubstr("1500"), HasSubstr("600"))));

  Calibration loaded = steady(1.0, 1.0, 8.0);
  for (double& wall_ms : loaded.blocks.back().wall_ms) wall_ms = 12.0;
  EXPECT_THAT(doubts(loaded), ElementsAre(HasSubstr("50 %")));

  Calibration drifting = steady(1.0, 1.0, 8.0);
  auto& cpu_ms = drifting.blocks.back().cpu_ms;
  for (std::size_t i = 14; i < cpu_ms.size(); ++i) cpu_ms[i] = 9.6;
  drifting.blocks.back().wall_ms = cpu_ms;
  const auto slower = doubts(drifting);
  EXPECT_THAT(slower, Contains(HasSubstr("20 %")));
  std::reverse(cpu_ms.begin(), cpu_ms.end());
  drifting.blocks.back().wall_ms = cpu_ms;
  EXPECT_THAT(doubts(drifting), AllOf(Contains(HasSubstr("20 %")), Not(Contains(slower.front()))));

  EXPECT_THAT(doubts(machine({{kWholeStep, times(8.0, 0.3, 1)}})), Contains(HasSubstr("scatter")));
}

}  // namespace
}  // namespace tether::calibration
