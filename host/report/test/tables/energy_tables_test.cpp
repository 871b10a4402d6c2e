#include "sample_results.h"

#include <gmock/gmock.h>

#include <tether/report/report.h>

namespace tether::report {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

campaign::UavEnergy energy(double lift_J) {
  return {.uav = "uav1",
          .spent_J = {lift_J, -1.0, 2.0, 3.0, 4.0, 2.0},
          .charge_from = 1.0,
          .charge_to = 0.8,
          .least_voltage_V = 11.5,
          .tasks = {{"look", {lift_J / 2, 0.0, 1.0, 1.0, 2.0, 1.0}}}};
}

TEST(EnergyTables, OfARun) {
  campaign::TrialResult trial;
  EXPECT_THAT(energy_table(trial).rows, IsEmpty());
  trial.energy = {energy(90.0)};
  EXPECT_THAT(
      energy_table(trial).rows,
      ElementsAre(ElementsAre("uav1", "look", "50.0", "45.0", "0.0", "1.0", "1.0", "2.0", "1.0"),
                  ElementsAre("uav1", "whole flight", "100.0", "90.0", "-1.0", "2.0", "3.0", "4.0",
                              "2.0")));
}

TEST(EnergyTables, OfACampaignHasARowForEachCondition) {
  campaign::ScenarioResults scenario = sample_results({{"host", {1, 2}}, {"target", {3, 4}}});
  EXPECT_THAT(energy_table(scenario).rows, IsEmpty());
  auto& host = scenario.conditions[0].trials;
  host[0].energy = {energy(90.0)};
  host[1].energy = {energy(110.0)};
  host[1].outcome = campaign::Outcome::kGoalMissed;
  const Table table = energy_table(scenario);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][1], "host");
  EXPECT_EQ(table.rows[0][2], "2");
  EXPECT_EQ(table.rows[0][3], "110");
  EXPECT_EQ(table.rows[0][6], "4.0");
  EXPECT_EQ(table.rows[1][2], "0");
}

}  // namespace
}  // namespace tether::report
