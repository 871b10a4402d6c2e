#include "flight.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include <tether/judge/judge.h>

namespace tether::judge {
namespace {

using ::testing::HasSubstr;

struct Case {
  const char* clause;
  bool met;
  std::optional<double> margin;
  std::optional<double> decided_s;
  const char* limited_by;
};

void expect(const Flight& flight, const Case& c) {
  const ClauseVerdict verdict = flight.verdict(c.clause);
  EXPECT_EQ(verdict.met, c.met) << c.clause;
  ASSERT_EQ(verdict.margin.has_value(), c.margin.has_value()) << c.clause << verdict.limited_by;
  EXPECT_NEAR(verdict.margin.value_or(0), c.margin.value_or(0), 1e-9) << c.clause;
  ASSERT_EQ(verdict.decided_at.has_value(), c.decided_s.has_value()) << c.clause;
  const double decided_s = to_seconds(verdict.decided_at.value_or(SimTime{}));
  EXPECT_NEAR(decided_s, c.decided_s.value_or(0), 1e-9) << c.clause;
  EXPECT_THAT(verdict.limited_by, HasSubstr(c.limited_by)) << c.clause;
}

Flight mission() {
  Flight flight;
  flight.task("a", 1, 3).task("b", 3, 6).task("c", 6, 8).finish(8);
  return flight;
}

TEST(Judge, ConditionsOnSignals) {
  for (const Case& c : std::vector<Case>{
           {R"(always = "altitude <= 9 m")", true, 1.0, 8.0, "8 m at ST 8.000 s"},
           {R"(always = "altitude <= 5 m")", false, -3.0, 5.1, "8 m at ST 8.000 s"},
           {R"(never = "altitude >= 5 m")", false, -3.0, 5.0, "8 m"},
           {R"(never = "altitude >= 900 cm")", true, 100.0, 8.0, "800 cm"},
           {R"(eventually = "altitude >= 5 m")", true, 3.0, 5.0, "8 m"},
           {R"(eventually = "altitude >= 9 m")", false, -1.0, 8.0, "8 m"},
           {"eventually = \"altitude >= 5 m\"\nfor_s = 2", true, 1.0, 7.0, "6 m"},
           {"eventually = \"altitude >= 5 m\"\nfor_s = 2\nbefore_s = 6", false, -1.0, 6.0, "4 m"},
           {"eventually = \"altitude >= 2 m\"\nwithin_s = 4", true, 2.0, 2.0, "4 m"},
           {"during = [\"b\"]\neventually = \"altitude >= 5.5 m\"\nwithin_s = 2", false, -0.5, 5.0,
            "5 m"},
           {"during = [\"b\"]\nalways = \"altitude <= 7 m\"", true, 1.0, 6.0, "6 m"},
           {"during = [\"a\", \"b\"]\nalways = \"altitude >= 1 m\"", true, 0.0, 6.0, "1 m"},
           {"after = \"b\"\nalways = \"altitude >= 5 m\"", true, 1.0, 8.0, "6 m"},
           {"during = [\"c\"]\neventually = \"altitude >= 1 m\"\nfor_s = 3",
            false,
            {},
            8.0,
            "hold that long"},
           {R"(always = "altitude <= 7.2 m in 90 %")", true, 0.0, 8.0, "7.2 m"},
           {R"(always = "speed <= 1.5 m/s")", true, 0.5, 8.0, "1 m/s"},
           {R"(always = "distance <= 4 m")", true, 1.0, 8.0, "3 m"},
           {R"(eventually = "separation <= 3.5 m")", true, 0.5, 0.0, "3 m at ST 0.000 s"},
           {R"(always = "separation <= 6 m")", false, 6.0 - std::hypot(3.0, 8.0), 5.2, "8.54"},
           {R"(always = "x <= 2 m")", true, 2.0, 8.0, "0 m"},
           {R"(always = "y >= -1 m")", true, 1.0, 8.0, "0 m"},
           {R"(always = "bearing_error <= 10 deg")", true, 10.0, 8.0, "0 deg"},
           {R"(always = "yaw_rate <= 10 deg/s")", true, 10.0, 8.0, "0 deg/s"},
           {R"(always = "clearance >= 1 m")", false, {}, {}, "clearance"}})
    expect(mission(), c);
}

// A bound belongs to its condition.
TEST(Judge, NeverIsMissedAtItsBoundAndEveryOtherClauseIsMet) {
  Flight flight = mission().image(1.0, 1.009, 1.0).command(1.009, 1.018);
  for (const Case& c :
       std::vector<Case>{{R"(never = "altitude >= 8 m")", false, 0.0, 8.0, "8 m at ST 8.000 s"},
                         {R"(never = "altitude <= 0 m")", false, 0.0, 0.0, "0 m at ST 0.000 s"},
                         {R"(never = "altitude >= 800 cm")", false, 0.0, 8.0, "800 cm"},
                         {R"(always = "altitude <= 8 m")", true, 0.0, 8.0, "8 m"},
                         {R"(eventually = "altitude >= 8 m")", true, 0.0, 8.0, "8 m"},
                         {"during = [\"a\"]\nwithin_s = 2", true, 0.0, 3.0, ""},
                         {R"(never = "data_age >= 9 ms")", false, 0.0, 1.009, "9 ms"},
                         {R"(always = "data_age <= 9 ms")", true, 0.0, 8.0, "9 ms"},
                         {R"(always = "data_age >= 9 ms")", true, 0.0, 8.0, "9 ms"}})
    expect(flight, c);
}

TEST(Judge, NamesTheDigitsInWhichAValueDiffersFromItsBound) {
  Flight flight = mission().image(1.0, 1.009, 1.0).command(1.0090001, 1.018);
  expect(flight, {R"(always = "data_age <= 9 ms")", false, -0.0001, 1.0090001, "9.0001 ms at ST"});
}

TEST(Judge, EnergyCountsFromTheStartOfTheClause) {
  const Flight flight = mission().battery();
  for (const Case& c : std::vector<Case>{
           {R"(always = "energy_j <= 900 J")", true, 100.0, 8.0, "800 J at ST 8.000 s"},
           {"during = [\"b\"]\nalways = \"energy_j <= 0.25 kJ\"", false, -0.05, 5.6, "0.3 kJ"},
           {"during = [\"b\"]\nnever = \"energy_j >= 400 J\"", true, 100.0, 6.0, "300 J"},
           {R"(always = "charge_left >= 50 %")", true, 10.0, 8.0, "60 % at ST 8.000 s"}})
    expect(flight, c);
  EXPECT_THAT(mission().verdict(R"(always = "energy_j <= 900 J")").limited_by,
              HasSubstr("does not have energy_j"));
}

TEST(Judge, FollowsTheMarginOverTime) {
  const Flight flight = mission();
  const auto always = flight.verdict(R"(always = "altitude <= 9 m")").margins;
  ASSERT_GT(always.size(), 20U);
  EXPECT_LE(always.size(), 42U);
  EXPECT_EQ(always.front(), (MarginAt{st(0), 9.0}));
  EXPECT_EQ(always.back().at, st(8));
  EXPECT_NEAR(always.back().margin, 1.0, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(always, std::greater<>(), &MarginAt::margin));
  const auto eventually = flight.verdict(R"(eventually = "altitude >= 5 m")").margins;
  EXPECT_TRUE(std::ranges::is_sorted(eventually, {}, &MarginAt::margin));
  const ClauseVerdict deadline = flight.verdict("during = [\"a\"]\nwithin_s = 5");
  EXPECT_EQ(deadline.margins, (std::vector<MarginAt>{{st(1), 5.0}, {st(3), 3.0}}));
  EXPECT_EQ(deadline.limit, 5.0);
}

// Clauses share their work, but not their verdicts.
TEST(Judge, ClausesThatShareWorkAreJudgedAsAlone) {
  const std::vector<std::string> clauses = {"always = \"altitude <= 9 m\"",
                                            "always = \"altitude <= 8 m\"",
                                            "never = \"altitude <= 1 m\"",
                                            "always = \"altitude <= 5 m in 80 %\"",
                                            "eventually = \"altitude <= 5 m\"",
                                            "eventually = \"altitude >= 5 m\"\nfor_s = 2",
                                            "eventually = \"altitude >= 6 m\"\nfor_s = 2",
                                            "during = [\"b\"]\nalways = \"altitude <= 8 m\"",
                                            "always = \"reaction_time <= 150 ms in 95 %\"",
                                            "always = \"reaction_time <= 120 ms\"",
                                            "never = \"reaction_time <= 100 ms\"",
                                            "within_s = 7"};
  Flight flight = mission().image(1.0, 1.05, 1.0).command(1.1, 1.12).image(2.0, 2.1, 2.0);
  flight.command(2.15, 2.16);
  std::string all;
  for (const std::string& clause : clauses) all += "[[clause]]\n" + clause + "\n";
  const auto together = flight.verdicts(all).clauses;
  ASSERT_EQ(together.size(), clauses.size());
  for (std::size_t i = 0; i < clauses.size(); ++i)
    EXPECT_EQ(together[i], flight.verdict(clauses[i])) << clauses[i];
}

TEST(Judge, ClearanceOfEachInstant) {
  Flight flight = mission();
  for (auto& logged : flight.record().ground_truth)
    logged.message.clearance_m = 10.0 - to_seconds(logged.at);
  expect(flight, {R"(always = "clearance >= 1 m")", true, 1.0, 8.0, "2 m at ST 8.000 s"});
}

TEST(Judge, YawRateIsAboutTheVertical) {
  Flight flight = mission();
  for (auto& logged : flight.record().ground_truth) {
    logged.message.q_WB[0] = logged.message.q_WB[1] = std::sqrt(0.5);  // rolled by 90 degrees
    logged.message.w_WB_B_rad_s[1] = -0.5;
  }
  expect(flight, {R"(always = "yaw_rate <= 1 rad/s")", true, 0.5, 8.0, "0.5 rad/s"});
}

TEST(Judge, Deadlines) {
  Flight unreached;
  unreached.task("a", 1, 3).task("b", 3, 6, "not_reached").finish(6);
  Flight cut;
  cut.task("a", 1, 3).note(3, R"({"task":"b","event":"start"})").cut(9);
  struct Deadline {
    Flight flight;
    Case expected;
  };
  for (const auto& [flight, c] : std::vector<Deadline>{
           {mission(), {"within_s = 9", true, 1.0, 8.0, "computing 8 s"}},
           {mission(), {"within_s = 7", false, -1.0, 7.0, "computing 8 s"}},
           {mission(), {"during = [\"b\"]\nwithin_s = 4", true, 1.0, 6.0, "computing 3 s"}},
           {mission(), {"during = [\"b\", \"c\"]\nbefore_s = 8", true, 0.0, 8.0, ""}},
           {mission(), {"after = \"a\"\nwithin_s = 6", true, 1.0, 8.0, ""}},
           {unreached, {"during = [\"b\"]\nwithin_s = 9", false, {}, 6.0, "not_reached: so"}},
           {unreached, {"during = [\"b\"]\nwithin_s = 2", false, -1.0, 5.0, "not_reached: so"}},
           {unreached, {"during = [\"c\"]\nwithin_s = 2", false, {}, {}, "did not run"}},
           {unreached, {"within_s = 9", false, {}, 6.0, "'b' ended not_reached"}},
           {cut, {"during = [\"b\"]\nwithin_s = 4", false, -2.0, 7.0, "unfinished"}},
           {cut, {"after = \"b\"\nwithin_s = 4", false, {}, {}, "did not end"}}})
    expect(flight, c);
}

TEST(Judge, ReactionsAgesAndLoops) {
  Flight flight = mission();
  flight.image(3.0, 3.2, 3.1).command(3.3, 3.4).command(3.5, 3.6);
  flight.image(4.0, 4.2, 4.1).command(5.1, 5.1).image(5.5, 5.5, 5.4);
  for (
      const Case& c : std::vector<Case>{
          {R"(always = "reaction_time <= 600 ms")", false, -400.0, 5.1,
           "1000 ms at ST 5.100 s: 100 ms from the measurement's instant until the program had it, "
           "900 ms until its command"},
          {R"(always = "reaction_time of eye <= 0.6 s in 66 %")", true, 0.1, 8.0, "0.5 s"},
          {"during = [\"a\"]\nalways = \"reaction_time <= 1 s\"", false, {}, {}, "no such command"},
          {R"(never = "data_age >= 2 s")", true, 1.0, 8.0, "1 s at ST 5.100 s"},
          {R"(always = "loop_period of eye <= 1.2 s")", false, -0.3, 5.5, "1.5 s"},
          {R"(always = "loop_period <= 2 s")", true, 0.4, 8.0, "1.6 s"},
          {R"(always = "loop_jitter of eye <= 0.3 s")", true, 0.05, 8.0, "0.25 s"},
          {R"(always = "reaction_time of nose <= 1 s")", false, {}, {}, "no such command"}})
    expect(flight, c);
  const ClauseVerdict times = flight.verdict(R"(always = "reaction_time <= 600 ms in 50 %")");
  ASSERT_EQ(times.quantiles.size(), 21U);
  EXPECT_NEAR(times.quantiles[0], 300.0, 1e-9);
  EXPECT_NEAR(times.quantiles[10], 500.0, 1e-9);
  EXPECT_NEAR(times.quantiles[20], 1000.0, 1e-9);
  EXPECT_EQ(times.limit, 600.0);
  flight.setpoint(5.6).setpoint(5.8);
  expect(flight, {R"(always = "loop_period <= 300 ms in 40 %")", true, 100.0, 8.0, "200 ms"});
  const ClauseVerdict none = flight.verdict(R"(always = "reaction_time of nose <= 1 s")");
  EXPECT_TRUE(none.quantiles.empty());
  EXPECT_EQ(none.limit, 1.0);
}

TEST(Judge, ASetPointByMavlinkIsACommand) {
  Flight flight = mission();
  flight.image(3.0, 3.2, 3.1).setpoint(3.3, 3.4);
  EXPECT_NEAR(*flight.verdict(R"(always = "reaction_time <= 1 s")").margin, 0.7, 1e-9);
  EXPECT_NEAR(*flight.verdict(R"(always = "data_age of eye <= 1 s")").margin, 0.8, 1e-9);
}

TEST(Judge, ComputingOfAReactionIsWithoutWaitsForOtherCalls) {
  Flight flight = mission();
  flight.image(3.0, 3.2, 3.1).image(3.25, 3.45, 3.05).command(3.5, 3.6);
  const ClauseVerdict times = flight.verdict(R"(always = "reaction_time <= 600 ms")");
  EXPECT_NEAR(*times.least_without_computing, 400.0, 1e-9);
  EXPECT_NEAR(*times.median_of_computing, 100.0, 1e-9);
  const ClauseVerdict ages = flight.verdict(R"(always = "data_age of eye <= 600 ms")");
  EXPECT_NEAR(*ages.least_without_computing, 300.0, 1e-9) << "the same until the command";
  EXPECT_NEAR(*ages.median_of_computing, 100.0, 1e-9);
}

TEST(Judge, ReactionsInFreeRunningAreInSt) {
  Flight flight = mission();
  flight.image(3.0, 3.2, 3.1).command(3.3, 3.4);
  flight.record().header.policy = record::kFreeRunning;
  for (auto& logged : flight.record().interactions)
    logged.message.request_at = logged.message.reply_at = ExecTime{};
  EXPECT_NEAR(*flight.verdict(R"(always = "reaction_time <= 1 s")").margin, 0.7, 1e-9);
}

TEST(Judge, AnImageThatWasReadAfterACommandIsNotItsImage) {
  Flight flight = mission();
  flight.image(3.0, 3.0, 3.0).command(3.4, 3.4).image(3.4, 3.4, 3.4).command(3.9, 3.9);
  EXPECT_NEAR(flight.verdict(R"(always = "reaction_time <= 1 s")").quantiles.at(0), 0.4, 1e-9);
  EXPECT_NEAR(flight.verdict(R"(always = "data_age <= 1 s")").quantiles.at(20), 0.5, 1e-9);
}

TEST(Judge, RadioNeedsMessages) {
  Flight flight = mission();
  const auto expect_unknown = [&](const char* clause) {
    const ClauseVerdict verdict = flight.verdict(clause);
    EXPECT_FALSE(verdict.met || verdict.margin) << clause;
    EXPECT_THAT(verdict.limited_by, testing::HasSubstr("no message")) << clause;
  };
  const char* const ratio = "always = \"delivery_ratio >= 95 %\"";
  const char* const age = "always = \"information_age <= 20 s\"";
  const char* const soon = "eventually = \"delivery_ratio >= 95 %\"\nwithin_s = 4";
  expect_unknown(ratio);
  expect_unknown(age);
  flight.message("uav1", 5.0, "noise").message("uav1", 6.0, record::kDelivered);
  expect_unknown(soon);
  expect_unknown(age);
  expect_unknown("during = [\"a\"]\nalways = \"delivery_ratio >= 0 %\"");
  expect(flight, {ratio, false, -95.0, 5.0, "0 % at ST 5.000 s"});
  expect(flight, {"eventually = \"delivery_ratio >= 50 %\"", true, 0.0, 6.0, "50 %"});
  flight.message("uav2", 7.0, record::kDelivered);
  expect(flight, {age, true, 13.1, 8.0, "6.9 s"});
}

TEST(Judge, NeedsGroundTruth) {
  Flight flight = mission();
  flight.record().ground_truth.clear();
  EXPECT_FALSE(flight.verdict(R"(always = "altitude <= 9 m")").margin);
}

}  // namespace
}  // namespace tether::judge
