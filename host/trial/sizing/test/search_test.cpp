#include <functional>

#include <gtest/gtest.h>

#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

/// Flies one level over and over.
class SameLevel final : public Axis {
 public:
  std::vector<std::size_t> next_levels(std::size_t most) override {
    asked.push_back(most);
    return std::vector<std::size_t>(most, 7);
  }
  std::string so_far() const override { return ""; }

  std::vector<std::size_t> asked{};
};

/// Batches that were flown, and flights that were taken.
struct Log {
  std::vector<std::vector<Wanted>> batches{};
  std::vector<Wanted> taken{};
  bool is_interrupted = false;

  SearchEnd search(Axis& axis, const TakeOne& outcome, std::uint64_t most = 300,
                   std::size_t at_once = 1, const std::vector<Wanted>& earlier = {}) {
    const auto fly = [this](std::span<const Wanted> batch) {
      batches.emplace_back(batch.begin(), batch.end());
      return !is_interrupted;
    };
    const auto take = [&](const Wanted& wanted) {
      taken.push_back(wanted);
      return outcome(wanted);
    };
    return sizing::search(axis, most, at_once, earlier, fly, take);
  }
};

Flown good(const Wanted&) {
  return {};
}

TEST(Search, GivesEachFlightASeedAndFliesNoMoreThanAllowed) {
  SameLevel axis;
  Log log;
  EXPECT_EQ(log.search(axis, good, 5, 2), SearchEnd::kAnswered);
  EXPECT_EQ(axis.asked, (std::vector<std::size_t>{2, 2, 1, 0}));
  EXPECT_EQ(log.taken, (std::vector<Wanted>{{7, 1}, {7, 2}, {7, 3}, {7, 4}, {7, 5}}));
}

TEST(Search, TakesEarlierFlightsFirstAndGoesOnWithTheNextSeed) {
  SameLevel axis;
  Log log;
  const std::vector<Wanted> earlier = {{3, 1}, {4, 2}};
  log.search(axis, good, 3, 1, earlier);
  EXPECT_EQ(log.batches, (std::vector<std::vector<Wanted>>{{{7, 3}}}));
  EXPECT_EQ(log.taken, (std::vector<Wanted>{{3, 1}, {4, 2}, {7, 3}}));
}

TEST(Search, GivesUpAfterThreeFailuresOfThisCall) {
  SameLevel axis;
  Log log;
  const std::vector<Wanted> earlier = {{7, 1}, {7, 2}, {7, 3}};
  const auto fail = [](const Wanted&) { return Flown{.is_failed = true}; };
  EXPECT_EQ(log.search(axis, fail, 300, 1, earlier), SearchEnd::kFailing);
  EXPECT_EQ(log.batches.size(), 3U);
}

TEST(Search, EndsIfItIsInterruptedOrIfFlightsAreCopies) {
  SameLevel axis;
  Log log;
  const auto copy = [](const Wanted&) { return Flown{.is_copy = true}; };
  EXPECT_EQ(log.search(axis, copy), SearchEnd::kAnswered);
  EXPECT_EQ(log.taken.size(), kMostCopies);
  log.is_interrupted = true;
  EXPECT_EQ(log.search(axis, copy), SearchEnd::kInterrupted);
  EXPECT_EQ(log.taken.size(), kMostCopies) << "what was interrupted is not taken";
}

TEST(Search, IsUndecidableIfNoFlightHasAValue) {
  for (const std::uint64_t last_with_value : {0U, 1U}) {
    SameLevel axis;
    Log log;
    const auto take = [&](const Wanted& wanted) {
      return Flown{.lacks_value = wanted.seed > last_with_value};
    };
    EXPECT_EQ(log.search(axis, take, 4),
              last_with_value == 0 ? SearchEnd::kUndecidable : SearchEnd::kAnswered);
  }
}

TEST(Search, AnswersOnBothAxes) {
  const UavQuestion uavs{.least = 2, .most = 8};
  UavAxis by_uavs(uavs);
  Log log;
  by_uavs.next_levels(1);
  EXPECT_EQ(by_uavs.so_far(), "UAVs that it carries: nothing is known yet");
  const auto fly_uavs = [&](const Wanted& wanted) {
    by_uavs.add(wanted.level, wanted.level <= 3);
    return Flown{};
  };
  EXPECT_EQ(log.search(by_uavs, fly_uavs), SearchEnd::kAnswered);
  EXPECT_EQ(by_uavs.answer().carried, 5U);
  EXPECT_EQ(by_uavs.so_far(), "UAVs that it carries: at least 5, fewer than 6");

  const CurveGrid grid({.interval = 1.6, .least = 1.0, .most = 20.0});
  Sizing by_slowdown(grid, false);
  EXPECT_EQ(by_slowdown.so_far(), "no limit is known yet");
  EXPECT_EQ(by_slowdown.flights_left(), std::nullopt);
  const auto fly_slowed = [&](const Wanted& wanted) {
    const double slowdown = grid.slowdowns()[wanted.level];
    by_slowdown.add({slowdown, slowdown <= 3.0});
    return Flown{};
  };
  EXPECT_EQ(log.search(by_slowdown, fly_slowed, 300, 2), SearchEnd::kAnswered);
  EXPECT_TRUE(by_slowdown.latest().is_narrow);
  EXPECT_NEAR(by_slowdown.latest().threshold.estimate, 3.0, 0.4);
  EXPECT_EQ(by_slowdown.so_far().substr(0, 12), "so far about");
  EXPECT_EQ(by_slowdown.flights_left(), 0U) << "the answer is as narrow as asked";
}

}  // namespace
}  // namespace tether::sizing
