#include "verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

campaign::MetricValue metric(const std::string& label, const std::string& unit, double value) {
  campaign::MetricValue result;
  result.name = result.kind = label;
  result.label = label;
  result.unit = unit;
  result.value = value;
  return result;
}

campaign::ConditionResults condition(const std::string& name, const std::vector<double>& times) {
  campaign::ConditionResults results;
  results.condition = name;
  results.planned = times.size();
  for (const double time_s : times) {
    campaign::TrialResult trial;
    trial.condition = name;
    trial.seed = results.trials.size() + 1;
    trial.outcome = campaign::Outcome::kGoalReached;
    trial.metrics = {metric("Time required", "s", time_s)};
    results.trials.push_back(trial);
  }
  return results;
}

campaign::ScenarioResults scenario(const std::vector<double>& host,
                                   const std::vector<double>& target) {
  campaign::ScenarioResults results;
  results.scenario = "turn";
  results.metrics = {"Time required"};
  results.conditions = {condition("host", host), condition("target", target)};
  return results;
}

TEST(Verdict, SaysInWhatConditionsDiffer) {
  // Means 2 and 7, sd 0.158 of 5 each: Welch's interval is 5 ± 2.306 · 0.1 = 4.77 to 5.23.
  const std::string text = verdict(scenario({1.8, 1.9, 2.0, 2.1, 2.2}, {6.8, 6.9, 7.0, 7.1, 7.2}));
  EXPECT_EQ(text,
            "The software reached its goal within the limits in 5 of 5 trials on “host” and 5 of 5 "
            "trials on “target”. Compared with “host”, on “target” time required is larger by 5.00 "
            "s (95 % interval 4.77 to 5.23).");
}

TEST(Verdict, TurnsASmallerMeanIntoAPositiveAmount) {
  EXPECT_THAT(verdict(scenario({6.8, 6.9, 7.0, 7.1, 7.2}, {1.8, 1.9, 2.0, 2.1, 2.2})),
              HasSubstr("time required is smaller by 5.00 s (95 % interval 4.77 to 5.23)"));
}

TEST(Verdict, SaysWhatCannotBeToldApart) {
  const std::string text = verdict(scenario({1, 2, 3}, {1.1, 2.1, 3.1}));
  EXPECT_THAT(text, HasSubstr("on “target” time required cannot be told apart by these trials."));
  EXPECT_THAT(text, Not(HasSubstr("larger")));
}

TEST(Verdict, CountsTrialsThatDidNotReachTheGoal) {
  campaign::ScenarioResults results = scenario({1, 2, 3}, {1, 2, 3});
  results.conditions[1].trials[0].outcome = campaign::Outcome::kGoalMissed;
  results.conditions[1].trials.pop_back();
  EXPECT_THAT(verdict(results), HasSubstr("and 1 of 3 trials on “target”"));
}

Comparison comparison(double difference, std::optional<campaign::Interval> interval) {
  Comparison result;
  result.a = "target";
  result.b = "target, no sync";
  result.means.difference = difference;
  result.means.ci95 = interval;
  return result;
}

TEST(Optimism, IsANumberWithItsInterval) {
  EXPECT_EQ(optimism_sentence(comparison(5.263, {{4.69, 5.83}}), metric("Time required", "s", 0)),
            "Without synchronisation the target looks 5.3 s faster than it is (time required; 95 % "
            "interval 4.7 to 5.8).");
  EXPECT_EQ(optimism_sentence(comparison(2.4, {{1.9, 2.9}}), metric("Oscillations", "1", 0)),
            "Without synchronisation the target looks better than it is: oscillations smaller by "
            "2.4 (95 % interval 1.9 to 2.9).");
}

TEST(Optimism, MayBePessimism) {
  EXPECT_EQ(
      optimism_sentence(comparison(-5.263, {{-5.83, -4.69}}), metric("Time required", "s", 0)),
      "Without synchronisation the target looks 5.3 s slower than it is (time required; 95 % "
      "interval 4.7 to 5.8).");
}

TEST(Optimism, ThatTheIntervalDoesNotShowIsNotClaimed) {
  EXPECT_EQ(
      optimism_sentence(comparison(0.012, {{-0.021, 0.045}}), metric("Position error", "m", 0)),
      "In position error, no optimism of the test without synchronisation can be told from "
      "the spread: 0.012 m (95 % interval −0.021 to 0.045).");
  EXPECT_THAT(optimism_sentence(comparison(2.0, std::nullopt), metric("Oscillations", "1", 0)),
              HasSubstr("too few trials for an interval"));
}

TEST(Verdict, NamesThrottledBoards) {
  auto results = scenario({1, 2, 3}, {1, 2, 3});
  EXPECT_THAT(verdict(results), Not(HasSubstr("throttled")));
  auto& target = results.conditions[1].trials[2].this_run.target.emplace();
  target.warnings = {"the target was throttled (under-voltage)"};
  EXPECT_THAT(verdict(results), Not(HasSubstr("throttled")));
  target.is_spoiled = true;
  EXPECT_THAT(verdict(results), HasSubstr("throttled in 1 of 3 trials on “target”"));
}

TEST(Problems, NameWhatTheTargetSuffered) {
  campaign::CampaignResults results;
  results.manifest.seeds = {1, 2};
  results.scenarios = {scenario({1, 2}, {1, 2})};
  results.scenarios[0].conditions[1].trials[0].this_run.target.emplace().warnings = {"it was hot"};
  EXPECT_THAT(problems(results), ElementsAre("turn, target, seed 1: it was hot"));
}

TEST(Problems, NameWhatWasNotedOfARun) {
  campaign::CampaignResults results;
  results.manifest.seeds = {1, 2};
  results.scenarios = {scenario({1, 2}, {1, 2})};
  results.scenarios[0].conditions[1].trials[0].this_run.notes = {"a signal stopped the SUT",
                                                                 "this machine was suspended"};
  EXPECT_THAT(problems(results), ElementsAre("turn, target, seed 1: a signal stopped the SUT",
                                             "turn, target, seed 1: this machine was suspended"));
}

TEST(Problems, AreEachNamed) {
  campaign::CampaignResults results;
  results.manifest.seeds = {1, 2, 3, 4};
  results.scenarios = {scenario({1, 2, 3, 4}, {1, 2})};
  std::vector<campaign::TrialResult>& host = results.scenarios[0].conditions[0].trials;
  host[0].outcome = campaign::Outcome::kFailed;
  host[0].reason = "the SUT was lost";
  host[1].metrics[0].value.reset();
  host[1].metrics[0].missing_because = "it did not finish";
  host[2].audit = campaign::AuditVerdict{false, "a command in the past"};
  host[3].sync.causality_violations = 2;
  results.damaged = {"turn/target/seed-0003/result.json: torn"};
  EXPECT_THAT(problems(results),
              ElementsAre("turn, host, seed 1: failed, and is in no mean: the SUT was lost",
                          "turn, host, seed 2: no time required: it did not finish",
                          "turn, host, seed 3: the audit found: a command in the past",
                          "turn, host, seed 4: 2 causality violations",
                          "turn, target: not run yet, or without a readable result: seeds 3 and 4",
                          "turn/target/seed-0003/result.json: torn"));
}

TEST(Problems, OfASoundCampaignAreNone) {
  campaign::CampaignResults results;
  results.manifest.seeds = {1, 2};
  results.scenarios = {scenario({1, 2}, {1, 2})};
  EXPECT_TRUE(problems(results).empty());
}

}  // namespace
}  // namespace tether::report
