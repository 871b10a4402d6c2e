#include "answers/flights.h"

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Verdict, OfACrashOnABusyMachineIsNotUndecided) {
  campaign::ScenarioResults scenario = flights(0, 1);
  campaign::TrialResult& trial = scenario.conditions[0].trials[0];
  trial.contacts = {{.uav = "uav1", .count = 1, .hard = 1}};
  trial.this_run.doubts = {{campaign::Doubt::Kind::kBusyMachine, "", 3.0}};
  EXPECT_EQ(ruling_of(scenario), Ruling::kGoalMissed);
}

// The closest limit has 20 % left, and is missed by 20 %.
TEST(Verdict, OfABusyMachineHoldsIfItsSpreadCannotChangeIt) {
  for (const std::size_t reached : {0U, 1U}) {
    campaign::ScenarioResults scenario = flights(reached, 1 - reached);
    std::vector<campaign::Doubt>& doubts = scenario.conditions[0].trials[0].this_run.doubts;
    const Ruling before = ruling_of(scenario);
    doubts = {{campaign::Doubt::Kind::kBusyMachine, "", 0.15}};
    EXPECT_EQ(ruling_of(scenario), before);
    EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest,
                HasSubstr(" The machine was busy or uneven: its times may be off by about 15 %."));
    doubts[0].amount = 0.3;
    EXPECT_EQ(ruling_of(scenario), Ruling::kUndecided);
    EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest, HasSubstr("within the spread"));
    EXPECT_EQ(verdict_of(scenario).advice[0].kind, Advice::Kind::kQuietMachine);
  }
}

TEST(Verdict, SaysHowOftenSetpointsWereLost) {
  for (const std::size_t reached : {0U, 1U}) {
    Pace pace{.uav = "uav1", .setpoint_hz = 10.0, .setpoint_gap_s = 2.5};
    const auto answer = [&] {
      return answers_of({verdict_of(flights(reached, 1 - reached), {pace})})[0].rest;
    };
    EXPECT_THAT(answer(), HasSubstr("10 times a second (but for up to 2500 ms not at all)"));
    pace.setpoint_gap_s = 37.9;
    EXPECT_THAT(answer(), HasSubstr("(but for up to 38 s not at all)"));
    pace.setpoint_gap_s = 0.2;
    pace.unqueued = {{"uav1", "imu", 12}};
    EXPECT_THAT(answer(), HasSubstr("12 measurements of “imu” of uav1 had no place in its queue"));
    EXPECT_THAT(answer(), testing::Not(HasSubstr("not at all")));
    pace.losses = {2, SimTime(std::chrono::milliseconds(3201)), "uav1", "hover"};
    // Of a flight that reached the goal, campaign makes a doubt of it.
    EXPECT_EQ(
        answer().find("UAV 'uav1' had no new set-point for too long 2 times, first at ST 3.201 "
                      "s") != std::string::npos,
        reached == 0);
  }
}

TEST(Verdict, NamesOnlyWhatDiffersBetweenFlights) {
  campaign::ScenarioResults scenario = flights(2, 0);
  auto& trials = scenario.conditions[0].trials;
  for (std::size_t i = 0; i < 2; ++i)
    trials[i].varied = {{"a", "mass_factor", 1.5}, {"b", "start_x_m", static_cast<double>(i)}};
  EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest,
              HasSubstr(" The flights differ in start_x_m."));
}

TEST(Verdict, OfFlightsThatBeginAlikeNamesMeasuredTimesOnlyIfThereAreAny) {
  Pace pace{.uav = "uav1"};
  for (const auto kind : {computer::ClockKind::kScripted, computer::ClockKind::kCpu}) {
    pace.speed.programs = {{.uav = "uav1", .clock = {kind}}};
    EXPECT_THAT(answers_of({verdict_of(flights(3, 0), {pace})})[0].rest,
                HasSubstr(kind == computer::ClockKind::kCpu
                              ? "differ only in noise and measured times."
                              : "no time is measured: they differ in noise, or because"));
  }
}

// How far the flight would have gone beyond it is not known, and what came after was not flown.
TEST(Verdict, AClauseThatEndsTheFlightIsTheOnlyOneToNameAndNoNearMiss) {
  campaign::ScenarioResults scenario = flights(0, 1);
  campaign::TrialResult& trial = scenario.conditions[0].trials[0];
  trial.metrics.clear();
  trial.end = campaign::kEndKilled;
  trial.clauses = {{.uav = "uav1", .name = "late"},
                   {.uav = "uav1", .name = "fence", .margin = -0.002, .unit = "m", .limit = 0.2}};
  trial.this_run.doubts = {{campaign::Doubt::Kind::kBusyMachine, "", 0.5}};
  EXPECT_EQ(ruling_of(scenario), Ruling::kGoalMissed);
  EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest,
              HasSubstr("the flight does not meet “fence”. "));
}

// The closest limit has 20 % left.
TEST(Verdict, OfAProgramThatWaitedALittleHoldsIfThatCannotChangeIt) {
  campaign::ScenarioResults scenario = flights(1, 0);
  std::vector<campaign::Doubt>& doubts = scenario.conditions[0].trials[0].this_run.doubts;
  doubts = {{campaign::Doubt::Kind::kSlightWait, "uav1", 0.03}};
  EXPECT_EQ(ruling_of(scenario), Ruling::kFastEnoughSoFar);
  EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest, testing::Not(HasSubstr("waited")));
  doubts[0].amount = 0.26;
  EXPECT_EQ(ruling_of(scenario), Ruling::kUndecided);
  EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest,
              testing::AllOf(HasSubstr("within the spread"),
                             HasSubstr("waited 26.0 % of its time on something that Tether")));
  EXPECT_EQ(verdict_of(scenario).advice[0].kind, Advice::Kind::kShowWaits);
  doubts = {{campaign::Doubt::Kind::kSlightWait, "uav1", 0.03},
            {campaign::Doubt::Kind::kBusyMachine, "", 0.3}};
  EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest, testing::Not(HasSubstr("waited")));
}

TEST(Verdict, AdvisesAProgramAsItIsNothingThatOnlyProgramsWithTheLibraryCanDo) {
  campaign::ScenarioResults scenario = flights(1, 0);
  campaign::TrialResult& trial = scenario.conditions[0].trials[0];
  using Kind = campaign::Doubt::Kind;
  for (const Kind kind : {Kind::kUnseenWait, Kind::kParallelThreads, Kind::kStretchedWait})
    trial.this_run.doubts.push_back({kind, "uav1", 4.86});
  const auto advice = [&] {
    return fmt::format("{}", fmt::join(advice_of({verdict_of(scenario)}), ""));
  };
  const testing::Matcher<std::string> needs_library =
      testing::AnyOf(HasSubstr("client library"), HasSubstr("concurrent"));
  EXPECT_THAT(advice(), needs_library);
  trial.suts.resize(1);
  trial.suts[0].as_is = true;
  EXPECT_THAT(advice(),
              testing::AllOf(HasSubstr("all_processes = true"), testing::Not(needs_library)));
}

TEST(Verdict, OfReplayedTimesHasTheDoubtsOfTheirMeasurement) {
  campaign::ScenarioResults scenario = flights(1, 0);
  std::vector<campaign::Doubt>& doubts = scenario.conditions[0].trials[0].this_run.doubts;
  doubts = {{campaign::Doubt::Kind::kBusyMachine, "pi", 0.3, "a.timing"}};
  EXPECT_EQ(ruling_of(scenario), Ruling::kUndecided);
  EXPECT_EQ(verdict_of(scenario).advice[0].kind, Advice::Kind::kRecordAgain);
  doubts = {{campaign::Doubt::Kind::kUnseenWait, "uav1", 0.4, "a.timing"}};
  EXPECT_EQ(answers_of({verdict_of(scenario)})[0].rest.substr(0, 68),
            ": when “a.timing” was recorded, the program of uav1 waited up to");
  EXPECT_THAT(advice_of({verdict_of(scenario)}),
              testing::Contains(HasSubstr("Measure the times of “a.timing” again")));
}

// One more would be beyond the limit.
TEST(Verdict, OfACountAtItsLimitIsUndecidedOnABusyMachine) {
  campaign::ScenarioResults scenario = flights(1, 0);
  campaign::TrialResult& trial = scenario.conditions[0].trials[0];
  campaign::MetricValue count = trial.metrics[0];
  count.label = "Oscillations";
  count.unit = "1";
  count.value = count.max = 1.0;
  trial.metrics.push_back(count);
  EXPECT_EQ(ruling_of(scenario), Ruling::kFastEnoughSoFar);
  trial.this_run.doubts = {{campaign::Doubt::Kind::kBusyMachine, "", 0.15}};
  EXPECT_EQ(ruling_of(scenario), Ruling::kUndecided);
  EXPECT_THAT(answers_of({verdict_of(scenario)})[0].rest,
              HasSubstr("The closest limit (oscillations, at the limit) is within the spread"));
  trial.metrics.back().value = 0.0;
  EXPECT_EQ(ruling_of(scenario), Ruling::kFastEnoughSoFar);
}

TEST(RulingsTable, SaysThatOneFlightIsAllThatIsKnown) {
  EXPECT_EQ(rulings_table({verdict_of(flights(1, 0))}).rows[0][1], "fast enough in this flight");
}

// As a program that crashed at its start, and flew when it was started again.
TEST(Verdict, IsDoubtfulForWhatFlightsThatReachedTheGoalHaveOnly) {
  const Warning doubt{Consequence::kDoubtful, {}, "a program", "failed in a first attempt"};
  campaign::ScenarioResults scenario = flights(40, 1);
  auto& trials = scenario.conditions[0].trials;
  const auto missed =
      std::ranges::find(trials, campaign::Outcome::kGoalMissed, &campaign::TrialResult::outcome);
  ASSERT_NE(missed, trials.end());
  missed->warnings = {doubt};
  EXPECT_EQ(name(verdict_of(scenario).first()), name(verdict_of(flights(40, 1)).first()))
      << "it can be why that one missed the goal";
  for (campaign::TrialResult& trial : trials) trial.warnings = {doubt};
  scenario.swept_from = "turn";
  scenario.settings = {{"world", "\"yard\""}};
  trials.erase(missed);
  const Verdict verdict = verdict_of(scenario);
  EXPECT_THAT(name(verdict.first()), StartsWith("doubtful whether fast enough"));
  EXPECT_THAT(answers_of({verdict})[0].lead, StartsWith("Doubtful whether fast enough"));
}

// One that just reached it among nine that clearly missed it changes nothing.
TEST(Verdict, IsUndecidedOnABusyMachineOnlyIfItsSpreadCouldChangeTheRuling) {
  campaign::ScenarioResults scenario = flights(1, 9);
  for (campaign::TrialResult& trial : scenario.conditions[0].trials) {
    trial.this_run.doubts = {{campaign::Doubt::Kind::kBusyMachine, "", 0.2}};
    trial.metrics.resize(1);
    const bool is_reached = trial.outcome == campaign::Outcome::kGoalReached;
    trial.metrics[0].value = is_reached ? 2.9 : 6.0;
    trial.metrics[0].max = 3.0;
  }
  EXPECT_EQ(verdict_of(scenario).first().ruling, Ruling::kGoalMissed);
  for (campaign::TrialResult& trial : scenario.conditions[0].trials)
    trial.metrics[0].value = trial.outcome == campaign::Outcome::kGoalReached ? 2.9 : 3.1;
  EXPECT_EQ(verdict_of(scenario).first().ruling, Ruling::kUndecided);
}

}  // namespace
}  // namespace tether::report
