#include "sample_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/report.h>

namespace tether::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

campaign::ScenarioResults point(std::vector<campaign::Setting> settings,
                                const std::vector<double>& times_s) {
  campaign::ScenarioResults scenario = sample_results({{"host", times_s}});
  scenario.swept_from = "turn";
  scenario.settings = std::move(settings);
  return scenario;
}

TEST(Sweep, IsOfThePointsOfEachScenario) {
  campaign::CampaignResults results;
  results.scenarios = {sample_results({{"host", {1}}}), point({{"f", "1"}}, {1}),
                       point({{"f", "2"}}, {2})};
  const auto sweeps = sweeps_of(results);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_EQ(sweeps[0].scenario, "turn");
  EXPECT_THAT(sweeps[0].points, ElementsAre(&results.scenarios[1], &results.scenarios[2]));
}

TEST(SweepTable, HasSuccessAndMeansOfEachPoint) {
  auto slow = point({{"f", "2"}}, {2, 4});
  slow.conditions[0].trials[1].outcome = campaign::Outcome::kGoalMissed;
  const auto fast = point({{"f", "1"}}, {1, 1});
  const Table table = sweep_table({"turn", {&fast, &slow}});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_THAT(table.rows[1], ElementsAre("2", "host", "1 of 2", "1 to 99 %", "3.000", testing::_));
}

TEST(SweepPlot, IsOverTheKeyWithTheMostValues) {
  const auto a = point({{"f", "1"}, {"g", "5"}}, {1}), b = point({{"f", "1"}, {"g", "10"}}, {2}),
             c = point({{"f", "1"}, {"g", "20"}}, {3}), d = point({{"a.f", "2"}, {"g", "5"}}, {4});
  const Sweep sweep{"turn", {&a, &b, &c, &d}};
  const std::string means = sweep_plot(sweep, "time_required").value().script;
  EXPECT_THAT(means, HasSubstr("set xtics ('5' 5, '10' 10, '20' 20)"));
  EXPECT_THAT(means, HasSubstr("$mean0 << END\n5 1\n10 2\n20 3\nEND"));
  EXPECT_THAT(means, HasSubstr("$mean1 << END\n5 4\nEND"));
  EXPECT_THAT(means, HasSubstr("host, f 2"));
  EXPECT_THAT(sweep_plot(sweep).value().script, HasSubstr("$share0 << END\n5 1 "));
}

TEST(SweepPlot, OfKeysThatVaryTogetherIsOverAllOfThem) {
  const auto a = point({{"f", "1"}, {"g", "21"}, {"h", "0"}}, {1}),
             b = point({{"f", "6"}, {"g", "6"}, {"h", "0"}}, {2});
  const std::string means = sweep_plot({"turn", {&a, &b}}, "time_required").value().script;
  EXPECT_THAT(means, HasSubstr("set xtics ('1, 21' 0, '6, 6' 1)"));
  EXPECT_THAT(means, HasSubstr("f, g"));
}

TEST(SweepPlot, PlacesFilesByTheirOrder) {
  const auto a = point({{"uav.profile", "/x/wide.toml"}}, {1}),
             b = point({{"uav.profile", "/x/narrow.toml"}}, {2});
  const std::string script = sweep_plot({"turn", {&a, &b}}, "time_required").value().script;
  EXPECT_THAT(script, HasSubstr("set xtics ('wide' 0, 'narrow' 1)"));
  EXPECT_THAT(script, Not(HasSubstr("/x/")));
}

// Names have no order.
TEST(SweepPlot, JoinsNumbersByLinesButNotNames) {
  const auto plots = [](const char* first, const char* second) {
    const auto a = point({{"f", first}}, {1}), b = point({{"f", second}}, {2});
    const Sweep sweep{"turn", {&a, &b}};
    return sweep_plot(sweep)->script + sweep_plot(sweep, "time_required")->script;
  };
  EXPECT_THAT(plots("1", "2"),
              testing::AllOf(HasSubstr("with yerrorlines"), HasSubstr("with linespoints")));
  EXPECT_THAT(plots("wide", "narrow"),
              testing::AllOf(HasSubstr("with yerrorbars"), HasSubstr("with points pointtype 7"),
                             Not(HasSubstr("lines "))));
}

// p = 2 / 70 = 0.0286 for 4 of 4 against 0 of 4; of three pairs, two are as unlikely.
TEST(SweepTests, AreFishersCorrectedByHolm) {
  auto none = point({{"f", "4"}}, {1, 1, 1, 1});
  for (auto& trial : none.conditions[0].trials) trial.outcome = campaign::Outcome::kGoalMissed;
  const auto all = point({{"f", "1"}}, {1, 1, 1, 1}), also = point({{"f", "2"}}, {1, 1, 1, 1});
  EXPECT_THAT(sweep_tests_table({"turn", {&all, &also, &none}}).rows,
              ElementsAre(ElementsAre("host", "1", "2", "4 of 4", "4 of 4", "1.000"),
                          ElementsAre("host", "1", "4", "4 of 4", "0 of 4", "0.086"),
                          ElementsAre("host", "2", "4", "4 of 4", "0 of 4", "0.086")));
  EXPECT_TRUE(sweep_tests_table({"turn", {&all}}).rows.empty());
}

TEST(SweepPlot, NeedsAValue) {
  auto a = point({{"f", "1"}}, {1});
  EXPECT_FALSE(sweep_plot({"turn", {&a}}, "oscillations"));
  a.conditions[0].trials.clear();
  EXPECT_FALSE(sweep_plot({"turn", {&a}}));
}

}  // namespace
}  // namespace tether::report
