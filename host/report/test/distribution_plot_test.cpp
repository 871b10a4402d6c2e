#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

campaign::TrialResult trial(double value) {
  campaign::TrialResult result;
  result.outcome = campaign::Outcome::kGoalReached;
  campaign::MetricValue metric;
  metric.name = metric.kind = "time_required";
  metric.label = "Time required";
  metric.unit = "s";
  metric.value = value;
  result.metrics = {metric};
  return result;
}

campaign::ScenarioResults results(const std::vector<double>& host) {
  campaign::ScenarioResults scenario;
  scenario.scenario = "turn";
  scenario.metrics = {"time_required"};
  campaign::ConditionResults condition;
  condition.condition = "host";
  condition.planned = host.size();
  for (const double value : host) condition.trials.push_back(trial(value));
  scenario.conditions = {condition};
  return scenario;
}

// Quartiles by linear interpolation, as R's quantile() by default.
TEST(DistributionPlot, HasAPointForEachTrialAndABoxOfQuartiles) {
  const std::string script = distribution_plot(results({4, 1, 2, 3, 5}), "time_required")->script;
  EXPECT_THAT(script, HasSubstr("set object rectangle from 2,0.7 to 4,1.3"));
  EXPECT_THAT(script, HasSubstr("set arrow from 3,0.7 to 3,1.3 nohead"));
  EXPECT_THAT(script, HasSubstr("$trials0 << END\n4 1.042492\n1 "));
  EXPECT_THAT(distribution_plot(results({1, 2, 4, 8}), "time_required")->script,
              HasSubstr("from 1.75,0.7 to 5,1.3"));
  EXPECT_THAT(distribution_plot(results({1, 2}), "time_required")->script,
              Not(HasSubstr("rectangle")));
}

TEST(DistributionPlot, LabelsHaveUnitAndNumberOfMissingTrials) {
  campaign::ScenarioResults scenario = results({1, 2, 3});
  scenario.conditions[0].planned = 5;
  scenario.conditions[0].trials[1].metrics[0].value.reset();
  const std::string script = distribution_plot(scenario, "time_required")->script;
  EXPECT_THAT(script, HasSubstr("'host (2 of 5)' 1"));
  EXPECT_THAT(script, HasSubstr("'Time required (s)'"));
}

TEST(DistributionPlot, NeedsAValue) {
  campaign::ScenarioResults scenario = results({1});
  EXPECT_FALSE(distribution_plot(scenario, "oscillations"));
  scenario.conditions[0].trials[0].metrics[0].value.reset();
  EXPECT_FALSE(distribution_plot(scenario, "time_required"));
}

}  // namespace
}  // namespace tether::report
