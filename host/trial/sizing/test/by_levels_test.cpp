#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

const Question kQuestion{.success = 0.9, .interval = 1.3, .least = 1.0, .most = 4.0};

void add(std::vector<Flight>& flights, double slowdown, int reached, int missed) {
  flights.insert(flights.end(), static_cast<std::size_t>(reached), {slowdown, true});
  flights.insert(flights.end(), static_cast<std::size_t>(missed), {slowdown, false});
}

Level level_at(double slowdown) {
  const std::vector<Flight> one = {{slowdown, true}};
  for (const Level& level : levels_of(kQuestion, one, 0.95))
    if (level.flights > 0) return level;
  return {};
}

TEST(ByLevels, SlowdownsHaveThreeDigitsAndStayInTheRange) {
  const std::vector<double> slowdowns = slowdowns_of({.least = 0.5, .most = 40.0});
  EXPECT_DOUBLE_EQ(slowdowns.front(), 0.501);
  EXPECT_DOUBLE_EQ(slowdowns[1], 0.508);
  EXPECT_DOUBLE_EQ(slowdowns.back(), 39.8);
  EXPECT_DOUBLE_EQ(slowdowns_of({.least = 1.0, .most = 10.0}).front(), 1.0);
}

// Clopper & Pearson by the method 5 of Newcombe, Statistics in Medicine 17 (1998), Table I.
TEST(ByLevels, ExactIntervalIsThatOfNewcombesTable) {
  const Share share = exact_share(81, 263, 0.95);
  EXPECT_NEAR(share.low, 0.2527, 5e-5);
  EXPECT_NEAR(share.high, 0.3676, 5e-5);
  EXPECT_NEAR(exact_share(0, 20, 0.95).high, 0.1684, 5e-5);
  EXPECT_EQ(exact_share(0, 20, 0.95).low, 0.0);
}

TEST(ByLevels, FlightsAtNearSlowdownsCountTogether) {
  std::vector<Flight> flights;
  for (const double slowdown : level_at(2.0).slowdowns) add(flights, slowdown, 1, 1);
  for (const Level& level : levels_of(kQuestion, flights, 0.95)) {
    if (level.flights == 0) continue;
    EXPECT_EQ(level.flights, flights.size());
    EXPECT_EQ(level.reached, flights.size() / 2);
    EXPECT_LT(2.5 * std::log(level.slowdowns.back() / level.slowdowns.front()), std::log(1.3));
    EXPECT_GT(level.slowdowns.size(), 3U);
  }
}

TEST(ByLevels, IntervalIsBetweenTheLastSufficientAndTheFirstInsufficientLevel) {
  std::vector<Flight> flights;
  add(flights, 1.12, 100, 0);
  add(flights, 1.26, 100, 1);
  add(flights, 1.41, 20, 20);
  add(flights, 2.0, 100, 0);  // beyond a level that is not sufficient
  const LevelAnswer answer = answer_by_levels(kQuestion, flights);
  EXPECT_EQ(answer.threshold.low, level_at(1.26).middle());
  EXPECT_EQ(answer.threshold.high, level_at(1.41).slowdowns.back());
  EXPECT_EQ(answer.threshold.estimate, answer.threshold.low);
  EXPECT_TRUE(answer.is_done);
}

TEST(ByLevels, NothingIsKnownWithoutDecidedLevels) {
  std::vector<Flight> flights;
  add(flights, 1.41, 9, 1);
  const LevelAnswer answer = answer_by_levels(kQuestion, flights);
  EXPECT_EQ(answer.threshold.low, 0.0);
  EXPECT_TRUE(std::isinf(answer.threshold.high));
  EXPECT_FALSE(answer.is_done);
}

TEST(ByLevels, FliesTheMiddleOfWhatIsOpenUnlessALowerLevelIsInDoubt) {
  std::vector<Flight> flights;
  add(flights, 1.12, 100, 0);
  add(flights, 2.51, 0, 20);
  LevelAnswer answer = answer_by_levels(kQuestion, flights);
  EXPECT_FALSE(answer.is_done);
  EXPECT_NEAR(answer.next.middle(), 1.7, 0.15);
  add(flights, 1.0, 1, 1);
  answer = answer_by_levels(kQuestion, flights);
  EXPECT_EQ(answer.next.slowdowns.front(), 1.0);
}

}  // namespace
}  // namespace tether::sizing
