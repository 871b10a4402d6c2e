#include "answers/comparisons.h"

#include "sample_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::ElementsAre;

campaign::ScenarioResults scenario(const std::vector<double>& host,
                                   const std::vector<double>& target) {
  return sample_results({{"host", host}, {"target", target}});
}

const std::vector<double> kFast = {1.8, 1.9, 2.0, 2.1, 2.2}, kSlow = {6.8, 6.9, 7.0, 7.1, 7.2};

// Means 2 and 7, sd 0.158 of 5 each: Welch's interval is 5 ± 2.306 · 0.1 = 4.77 to 5.23.
TEST(Differences, AreAmountsWithTheirIntervals) {
  const std::string larger =
      "“target” differs significantly from “host” in time required (larger by 5.00 s, 95 % "
      "interval 4.77 to 5.23).";
  const std::string smaller =
      "“target” differs significantly from “host” in time required (smaller by 5.00 s, 95 % "
      "interval 4.77 to 5.23).";
  EXPECT_THAT(difference_sentences(scenario(kFast, kSlow)), ElementsAre(larger));
  EXPECT_THAT(difference_sentences(scenario(kSlow, kFast)), ElementsAre(smaller));
  EXPECT_THAT(difference_sentences(scenario({1, 2, 3}, {1.1, 2.1, 3.1})),
              ElementsAre("“target” does not differ significantly from “host” in time required."));
}

std::string sentence(double difference, std::optional<campaign::Interval> interval,
                     const std::string& label, const std::string& unit,
                     const std::string& kind = "") {
  Comparison comparison;
  comparison.a = "target";
  comparison.b = "target, no sync";
  comparison.means.difference = difference;
  comparison.means.ci95 = interval;
  campaign::MetricValue metric;
  metric.kind = kind;
  metric.label = label;
  metric.unit = unit;
  return optimism_sentence(comparison, metric);
}

TEST(Optimism, IsANumberWithItsIntervalIfSignificant) {
  EXPECT_EQ(
      sentence(5.263, {{4.69, 5.83}}, "Time required", "s"),
      "Without synchronisation, “target” appears 5.3 s faster than it is (time required; 95 % "
      "interval 4.7 to 5.8).");
  EXPECT_EQ(
      sentence(-5.263, {{-5.83, -4.69}}, "Time required", "s"),
      "Without synchronisation, “target” appears 5.3 s slower than it is (time required; 95 % "
      "interval 4.7 to 5.8).");
  EXPECT_EQ(sentence(2.4, {{1.9, 2.9}}, "Oscillations", "1"),
            "Without synchronisation, “target” appears better than it is: oscillations smaller by "
            "2.4 (95 % interval 1.9 to 2.9).");
  EXPECT_EQ(sentence(2.0, std::nullopt, "Oscillations", "1"),
            "Without synchronisation, “target” appears better than it is: oscillations smaller by "
            "2.00 (too few trials for an interval).");
  EXPECT_EQ(sentence(0.012, {{-0.021, 0.045}}, "Position error", "m"),
            "Without synchronisation, “target” does not differ significantly in position error: "
            "0.012 m (95 % interval −0.021 to 0.045).");
}

TEST(Optimism, KnowsOfWhichMetricsMoreIsBetter) {
  EXPECT_THAT(sentence(0.5, {{0.4, 0.6}}, "Least clearance", "m", "min_clearance_m"),
              testing::HasSubstr("appears worse than it is: least clearance smaller by 0.5"));
}

TEST(Problems, AreEachNamed) {
  campaign::CampaignResults results;
  results.manifest.seeds = {1, 2};
  results.scenarios = {scenario({1, 2}, {1, 2})};
  EXPECT_TRUE(problems(results).empty());
  results.manifest.seeds = {1, 2, 3, 4};
  results.scenarios = {scenario({1, 2, 3, 4}, {1, 2})};
  std::vector<campaign::TrialResult>& host = results.scenarios[0].conditions[0].trials;
  host[0].outcome = campaign::Outcome::kFailed;
  host[0].reason = "the SUT was lost";
  host[1].metrics[0].value.reset();
  host[1].metrics[0].missing_because = "it did not finish";
  host[2].audit = campaign::AuditVerdict{false, "FAILED: 1 finding"};
  host[3].sync.causality_violations = 2;
  host[3].reason = "'uav1' hit 'room'";
  host[3].contacts = {{.uav = "uav1", .count = 1, .hard = 1}};
  campaign::ThisRun& target = results.scenarios[0].conditions[1].trials[0].this_run;
  target.target.emplace().warnings = {"it was hot"};
  target.notes = {"a signal stopped the SUT", "this machine was suspended"};
  results.damaged = {"turn/target/seed-0003/result.json: not a result"};
  EXPECT_THAT(
      problems(results),
      ElementsAre("turn, host, seed 1: failed, excluded from all means: the SUT was lost",
                  "turn, host, seed 2: no value of time required: it did not finish",
                  "turn, host, seed 3: audit: FAILED: 1 finding",
                  "turn, host, seed 4: 'uav1' hit 'room'",
                  "turn, host, seed 4: 2 causality violations", "turn, target, seed 1: it was hot",
                  "turn, target, seed 1: a signal stopped the SUT",
                  "turn, target, seed 1: this machine was suspended",
                  "turn, target: no readable result for seeds 3 and 4 (not run yet, or "
                  "damaged)",
                  "turn/target/seed-0003/result.json: not a result"));
}

}  // namespace
}  // namespace tether::report
