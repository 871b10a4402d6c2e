#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tether/sizing/by_levels.h>

namespace tether::sizing {
namespace {

const Question kQuestion{.success = 0.9, .interval = 1.3, .least = 1.0, .most = 4.0};
const std::vector<double> kLevels = {1.0, 1.12, 1.26, 1.41, 1.58, 1.78,
                                     2.0, 2.24, 2.51, 2.82, 3.16};

void add(std::vector<Flight>& flights, double slowdown, int reached, int missed) {
  flights.insert(flights.end(), static_cast<std::size_t>(reached), {slowdown, true});
  flights.insert(flights.end(), static_cast<std::size_t>(missed), {slowdown, false});
}

// Newcombe, Statistics in Medicine 17 (1998), Table I, method 3.
TEST(ByLevels, WilsonsIntervalIsThatOfNewcombesTable) {
  const Share share = wilson(81, 263, 0.95);
  EXPECT_NEAR(share.low, 0.2553, 5e-5);
  EXPECT_NEAR(share.high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(0, 20, 0.95).high, 0.1611, 5e-5);
  EXPECT_EQ(wilson(0, 20, 0.95).low, 0.0);
}

TEST(ByLevels, IntervalIsBetweenTheLastSufficientAndTheFirstInsufficientLevel) {
  std::vector<Flight> flights;
  add(flights, 1.12, 100, 0);
  add(flights, 1.26, 100, 1);
  add(flights, 1.41, 20, 20);
  add(flights, 2.0, 100, 0);  // beyond a level that is not sufficient
  const LevelAnswer answer = answer_by_levels(kQuestion, kLevels, flights);
  EXPECT_EQ(answer.threshold.low, 1.26);
  EXPECT_EQ(answer.threshold.high, 1.41);
  EXPECT_EQ(answer.threshold.estimate, 1.26);
  EXPECT_TRUE(answer.is_done);
}

TEST(ByLevels, NothingIsKnownWithoutDecidedLevels) {
  std::vector<Flight> flights;
  add(flights, 1.41, 9, 1);
  const LevelAnswer answer = answer_by_levels(kQuestion, kLevels, flights);
  EXPECT_EQ(answer.threshold.low, 0.0);
  EXPECT_TRUE(std::isinf(answer.threshold.high));
  EXPECT_FALSE(answer.is_done);
}

TEST(ByLevels, FliesTheMiddleOfWhatIsOpenUnlessALowerLevelIsInDoubt) {
  std::vector<Flight> flights;
  add(flights, 1.12, 100, 0);
  add(flights, 2.51, 0, 20);
  LevelAnswer answer = answer_by_levels(kQuestion, kLevels, flights);
  EXPECT_FALSE(answer.is_done);
  EXPECT_EQ(kLevels[answer.next], 1.78);
  add(flights, 1.0, 1, 1);
  answer = answer_by_levels(kQuestion, kLevels, flights);
  EXPECT_EQ(kLevels[answer.next], 1.0);
}

}  // namespace
}  // namespace tether::sizing
