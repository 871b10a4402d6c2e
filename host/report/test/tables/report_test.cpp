#include "campaign_fixture.h"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/report.h>

namespace tether::report {
namespace {

using namespace campaign;  // NOLINT: the results that the tables are of

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

class Report : public CampaignFixture {};

TEST_F(Report, HasTheTablesOfACampaign) {
  std::string text;
  for (const Table& table : report_tables(all())) text += to_text(table) + "\n";
  std::ifstream golden(TETHER_TEST_DIR "/tables_of_a_campaign.txt");
  EXPECT_EQ(text, std::string(std::istreambuf_iterator<char>(golden), {}));
}

// Each reason for which a number is missing or doubtful.
TEST_F(Report, NotesNameEverySpecialTrial) {
  TrialResult unfinished = trial("target", 2, 3, 0);
  unfinished.outcome = Outcome::kGoalMissed;
  unfinished.metrics[1].value.reset();
  unfinished.metrics[1].missing_because = "the SUT of 'uav1' did not finish";
  write(unfinished);
  TrialResult again = trial("target", 3, 0, 2.7);
  again.this_run.attempts = 2;
  again.this_run.first_failure = "the port was taken";
  again.this_run.target.emplace().warnings = {"it was hot"};
  write(again);
  TrialResult noted = trial("host", 1, 0, 2.7);
  noted.contacts[0].hard = 1;
  noted.reason = "'uav1' hit 'room'";
  noted.this_run.notes = {"a signal stopped the SUT", "suspended"};
  write(noted);
  write(make_setup_failure(scenario(), scenario().conditions[0], 3, "no port"));
  std::filesystem::remove_all(out_ / "turn/target-no-sync/seed-0001");
  scratch_.write("out/turn/target-no-sync/seed-0002/result.json", "{");

  const CampaignResults campaign = all();
  const Table table = paper_form_table(campaign.scenarios[0]);
  EXPECT_THAT(
      table.notes,
      ElementsAre("Trials: host 3 of 3 (2 reached the goal); target 3 of 3 (2 reached the goal); "
                  "target, no sync 1 of 3 (1 reached the goal). Times are simulated time.",
                  "Paper: Table III, Section V; ten experiments per condition.",
                  "Excluded from means: host, seed 3: no port.",
                  "Crash: host, seed 1: 'uav1' hit 'room'.",
                  "Note: host, seed 1: a signal stopped the SUT; suspended.",
                  "Excluded from means: target, seed 2: the SUT of 'uav1' did not finish.",
                  "Attempt 2: target, seed 3. The first attempt failed: the port "
                  "was taken.",
                  "target, seed 3: it was hot.",
                  "No readable result for 2 trials of target, no sync (not run yet, or damaged)."));
  EXPECT_EQ(campaign.damaged.size(), 1U);
  EXPECT_EQ(table.rows[1][5], "3.350") << "the mean of the trials that have a value";
}

TEST_F(Report, ShowsTheNotesOfTheFirstThreeTrialsOfACondition) {
  ScenarioResults many = results();
  std::vector<TrialResult>& trials = many.conditions[0].trials;
  for (TrialResult& trial : trials) trial.this_run.notes = {"busy"};
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    trials.push_back(trials.front());
    trials.back().seed = seed;
  }
  trials[4].this_run.notes.clear();
  EXPECT_EQ(paper_form_table(many).notes.back(),
            "Notes on host, seeds 4, 6 (5 of 6 trials have notes): see result.json.");
  trials.resize(4);
  EXPECT_EQ(paper_form_table(many).notes.back(),
            "Notes on host, seed 4 (4 of 4 trials have notes): see result.json.");
}

TEST_F(Report, ShowsConditionsOfThePaperOnly) {
  ScenarioResults two = results();
  two.conditions.erase(two.conditions.begin());
  const Table table = paper_form_table(two);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_THAT(table.rows[2],
              ElementsAre("host (paper only)", "–", "–", "0", "0", "–", "–", "2.48", "0.033"));
}

TEST_F(Report, ComparesACountedConditionWithThePapersOnly) {
  ScenarioResults counted = results();
  counted.conditions[1].condition = "target, counted";
  for (TrialResult& trial : counted.conditions[1].trials) {
    trial.condition = "target, counted";
    trial.clock.kind = computer::ClockKind::kCounted;
    trial.emulator.program = "qemu-x86_64";
  }
  const Table table = paper_form_table(counted);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[1].back(), "13.767") << "of the paper's target";
  EXPECT_TRUE(optimism(counted).empty()) << "by other clocks, computers differ as well";
}

TEST_F(Report, BeforeTheFirstTrialHasRowsWithoutNumbers) {
  std::filesystem::remove_all(out_ / "turn");
  for (const Table& table : report_tables(all())) EXPECT_FALSE(to_text(table).empty());
  EXPECT_EQ(paper_form_table(results()).rows.size(), 3u);
}

TEST_F(Report, ComparesEveryPairOnce) {
  const auto comparisons = compare_conditions(results());
  ASSERT_EQ(comparisons.size(), 6u);  // three pairs, two metrics
  EXPECT_EQ(comparisons[3].metric, "time_required");
  EXPECT_EQ(comparisons[3].a, "target");
  EXPECT_EQ(comparisons[3].b, "host");
  EXPECT_NEAR(comparisons[3].means.difference, 5.4, 1e-12);
  EXPECT_NEAR(comparisons[3].ranks.p_two_sided, 0.1, 1e-12);  // 2 of 20 orders
}

// Only the synchronisation must differ: not the sensors, and not the target.
TEST_F(Report, StatesTheOptimismOfTheSameTargetAndSensors) {
  ScenarioResults one = results();
  for (auto& condition : one.conditions)
    for (TrialResult& trial : condition.trials) trial.profiles = {"paper_table_1"};
  const auto found = optimism(one);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].a, "target");
  EXPECT_EQ(found[1].b, "target, no sync");
  EXPECT_NEAR(found[1].means.difference, 5.3, 1e-12);
  ScenarioResults other = one;
  for (TrialResult& trial : one.conditions[1].trials) trial.profiles.push_back("ideal");
  EXPECT_TRUE(optimism(one).empty());
  for (TrialResult& trial : other.conditions[1].trials) trial.target = "another_board";
  EXPECT_TRUE(optimism(other).empty());
}

TEST_F(Report, BasisHasClocksAuditsAndStops) {
  TrialResult wall = trial("target", 1, 0, 3);
  wall.clock.kind = computer::ClockKind::kWall;
  wall.clock.factor = 4.0;
  wall.target = "slow_board";
  wall.audit = AuditVerdict{false, "a command in the past"};
  wall.sync.causality_violations = 2;
  wall.sync.stops = StopFigures{100, Duration(70'000)};
  TrialResult scripted = trial("target", 2, 0, 3);
  scripted.clock = {computer::ClockKind::kScripted, 1.0, Duration(2'500'000)};
  scripted.sync.stops = StopFigures{200, Duration(35'000)};
  EXPECT_THAT(basis_table(all()).rows, Not(Contains(Contains("Stops of all threads"))));
  write(wall);
  write(scripted);
  const Table table = basis_table(all());
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
           {"Condition", "target: conservative_barrier, wall clock × 4, target slow_board"},
           {"Condition",
            "target: conservative_barrier, scripted clock, 2.5 ms per computing phase"},
           {"Audits passed", "8 of 9 (6 synchronised trials)"},
           {"Causality violations", "2"},
           {"Stops of all threads", "300, largest overshoot 0.070 ms"}})
    EXPECT_THAT(table.rows, Contains(ElementsAre(name, value)));
}

TEST_F(Report, OfOneRunHasItsLimitsAndNotes) {
  TrialResult one = trial("target", 2, 3, 12.5);
  one.metrics[0].value.reset();
  one.metrics[0].missing_because = "no ground truth";
  one.this_run.notes = {"a signal stopped the SUT", "suspended"};
  const Table table = run_table(one);
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre("Oscillations", "–", "–"),
                                      ElementsAre("Time required (s)", "12.500", "30")));
  EXPECT_THAT(table.notes, ElementsAre("Oscillations: no value (no ground truth).",
                                       "every SUT reached its goal within the limits.",
                                       "Note: a signal stopped the SUT; suspended."));
  one.metrics[1].value = 31.0;
  EXPECT_EQ(run_table(one).rows[1].back(), "30, missed");
}

TEST_F(Report, ForProgramsHasFullPrecisionAndNotes) {
  TrialResult noted = trial("host", 3, 0, 2.7);
  noted.this_run.notes = {"stopped, then \"continued\"", "suspended"};
  write(noted);
  const Table trials = trials_table(all()), summaries = summaries_table(all());
  EXPECT_EQ(trials.rows.size(), 18u);
  EXPECT_THAT(trials.rows[5], ElementsAre("turn", "host", "3", "goal_reached", "time_required", "s",
                                          "2.7", "every SUT reached its goal within the limits",
                                          "stopped, then \"continued\"; suspended"));
  EXPECT_EQ(summaries.rows.size(), 6u);
  EXPECT_EQ(summaries.rows[3].back(), "1");
  EXPECT_EQ(summaries.rows[4].back(), "0");
  const std::string csv = to_csv(summaries);
  EXPECT_TRUE(
      csv.starts_with("scenario,condition,metric,unit,planned,n,mean,stddev,median,"
                      "ci95_low,ci95_high,paper_mean,paper_stddev,noted\r\n"))
      << csv;
  EXPECT_TRUE(to_csv(trials).starts_with(
      "scenario,condition,seed,outcome,metric,unit,value,reason,notes\r\n"));
}

TEST_F(Report, CountsNoFlightOfAnotherCondition) {
  write_result(folder_of("target", 1), trial("host", 1, 0, 2.5));
  EXPECT_EQ(results().find_condition("target")->trials.size(), 2u);
  ASSERT_EQ(all().damaged.size(), 1u);
  EXPECT_THAT(all().damaged[0], testing::HasSubstr("is of condition \"host\", seed 1"));
}

}  // namespace
}  // namespace tether::report
