#include "sample_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string script(const campaign::ScenarioResults& results) {
  return distribution_plot(results, "time_required").value().script;
}
std::string script(const std::vector<double>& times_s) {
  return script(sample_results({{"host", times_s}}));
}

// Quartiles by linear interpolation, as R's quantile() by default.
TEST(DistributionPlot, HasAPointForEachTrialAndABoxOfQuartiles) {
  const std::string five = script({4, 1, 2, 3, 5});
  EXPECT_THAT(five, HasSubstr("set object rectangle from 2,0.7 to 4,1.3"));
  EXPECT_THAT(five, HasSubstr("set arrow from 3,0.7 to 3,1.3 nohead"));
  EXPECT_THAT(five, HasSubstr("$trials0 << END\n4 1.042492\n1 "));
  EXPECT_THAT(script({1, 2, 4, 8}), HasSubstr("from 1.75,0.7 to 5,1.3"));
  EXPECT_THAT(script({1, 2}), Not(HasSubstr("rectangle")));
}

TEST(DistributionPlot, LabelsHaveUnitAndNumberOfMissingTrials) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1, 2, 3}}});
  scenario.conditions[0].planned = 5;
  scenario.conditions[0].trials[1].metrics[0].value.reset();
  EXPECT_THAT(script(scenario), HasSubstr("'host (2 of 5)' 1"));
  EXPECT_THAT(script(scenario), HasSubstr("'Time required (s)'"));
}

TEST(MarginPlot, HasAPointForEachTrialAndALineAtZero) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1, 2}}, {"target", {3}}});
  judge::ClauseVerdict near{.uav = "uav1", .name = "near", .unit = "m"};
  EXPECT_FALSE(margin_plot(scenario, near));
  for (auto* trial : {&scenario.conditions[0].trials[0], &scenario.conditions[1].trials[0]}) {
    near.margin = near.margin ? 0.5 : 0.25;
    trial->clauses = {{.uav = "uav2", .name = "near"}, near};
  }
  const std::string plot = margin_plot(scenario, near).value().script;
  EXPECT_THAT(plot, HasSubstr("'Margin of near (m)'"));
  EXPECT_THAT(plot, HasSubstr("$trials0 << END\n0.25 "));
  EXPECT_THAT(plot, HasSubstr("$trials1 << END\n0.5 "));
  EXPECT_THAT(plot, HasSubstr("'host (1 of 2)'"));
  EXPECT_THAT(plot, HasSubstr("set xrange [-")) << "0 is in the range";
}

TEST(TimesPlot, HasTheQuantilesOfEachTrialAndALineAtTheLimit) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1, 2}}, {"target", {3}}});
  judge::ClauseVerdict reaction{.uav = "uav1", .name = "reaction", .unit = "ms", .limit = 150.0};
  EXPECT_FALSE(times_plot(scenario, reaction));
  reaction.quantiles = {80.0, 90.0, 100.0};
  scenario.conditions[0].trials[1].clauses = {reaction};
  reaction.quantiles = {200.0, 220.0, 240.0};
  scenario.conditions[1].trials[0].clauses = {reaction};
  const std::string plot = times_plot(scenario, reaction).value().script;
  EXPECT_THAT(plot, HasSubstr("'reaction (ms)'"));
  EXPECT_THAT(plot, HasSubstr("set arrow from 150,graph 0"));
  EXPECT_THAT(plot, HasSubstr("$trials0 << END\n80 "));
  EXPECT_THAT(plot, HasSubstr("$trials1 << END\n200 "));
  EXPECT_THAT(plot, HasSubstr("'host (1 of 2)' 1, 'target' 2"));
}

TEST(DistributionPlot, NeedsAValue) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1}}});
  EXPECT_FALSE(distribution_plot(scenario, "oscillations"));
  scenario.conditions[0].trials[0].metrics[0].value.reset();
  EXPECT_FALSE(distribution_plot(scenario, "time_required"));
}

}  // namespace
}  // namespace tether::report
