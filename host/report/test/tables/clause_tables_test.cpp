#include "sample_results.h"

#include <gmock/gmock.h>

#include <tether/report/report.h>

namespace tether::report {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

judge::ClauseVerdict clause(double margin_m) {
  judge::ClauseVerdict clause{.uav = "uav1", .name = "near", .met = margin_m >= 0.0};
  clause.margin = margin_m;
  clause.unit = "m";
  clause.from = SimTime{};
  clause.to = clause.decided_at = SimTime(std::chrono::seconds(2));
  clause.limited_by = "1 m at ST 2.000 s";
  return clause;
}

TEST(ClauseTables, OfARun) {
  campaign::TrialResult trial;
  trial.outcome = campaign::Outcome::kGoalMissed;
  EXPECT_THAT(clauses_table(trial).rows, IsEmpty());
  trial.clauses = {clause(-0.5), {.uav = "uav1", .name = "far"}};
  const Table table = clauses_table(trial);
  EXPECT_THAT(table.rows,
              ElementsAre(ElementsAre("near", "missed", "-0.500 m", "0.000", "2.000", "–", "2.000"),
                          ElementsAre("far", "missed", "–", "–", "–", "–", "–")));
  EXPECT_THAT(table.notes, ElementsAre("near: 1 m at ST 2.000 s."));
}

TEST(ClauseTables, OfARunThatFailed) {
  campaign::TrialResult trial;
  trial.outcome = campaign::Outcome::kFailed;
  trial.clauses = {{.uav = "uav1", .name = "far"}};
  trial.clauses[0].limited_by = "interrupted by the user";
  const Table table = clauses_table(trial);
  EXPECT_EQ(table.rows.at(0).at(1), "not evaluated");
  EXPECT_THAT(table.notes, IsEmpty());
}

TEST(ClauseTables, TimesOfACampaign) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1, 2}}, {"target", {3}}});
  EXPECT_THAT(times_table(scenario).rows, IsEmpty());
  judge::ClauseVerdict reaction{.uav = "uav1", .name = "reaction", .unit = "ms"};
  scenario.conditions[0].trials[0].clauses = {reaction};  // a flight that failed
  reaction.limit = 150.0;
  reaction.quantiles = {80.0, 90.0, 100.0};
  scenario.conditions[0].trials[1].clauses = {reaction};
  EXPECT_THAT(
      times_table(scenario).rows,
      ElementsAre(ElementsAre("reaction", "host", "ms", "150.000", "90.000", "99.000", "100.000")));
}

TEST(ClauseTables, OfACampaign) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1, 2}}, {"target", {3, 4, 5}}});
  EXPECT_THAT(clauses_table(scenario).rows, IsEmpty());
  auto& host = scenario.conditions[0].trials;
  auto& target = scenario.conditions[1].trials;
  host[0].clauses = {clause(1.0)};
  host[1].clauses = {clause(2.0)};
  target[0].clauses = {clause(-1.0)};
  target[1].clauses = {{.uav = "uav1", .name = "near", .unit = "m"}};
  target[2].clauses = {clause(1.0)};
  target[2].outcome = campaign::Outcome::kFailed;
  const Table table = clauses_table(scenario);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_THAT(std::vector(table.rows[0].begin(), table.rows[0].begin() + 6),
              ElementsAre("near", "host", "2 of 2", "[0.158, 1.000]", "m", "1.500"));
  EXPECT_THAT(std::vector(table.rows[1].begin(), table.rows[1].begin() + 6),
              ElementsAre("near", "target", "0 of 2", "[0.000, 0.842]", "m", "-1.000"));
}

}  // namespace
}  // namespace tether::report
