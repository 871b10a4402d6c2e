#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign_testing/sample_campaign.h>
#include <tether/report/report.h>

namespace tether::report {
namespace {

using namespace campaign;  // NOLINT: the results that the tables are of

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Report : public testing::Test {
 protected:
  Report() {
    CampaignFolder folder(out_, campaign_, {{"tether", "0.1.0"}}, OpenMode::kFresh);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const double s = static_cast<double>(seed);
      write("host", seed, 0, 2.4 + 0.1 * s);
      write("target", seed, s - 1, 4.0 * s);
      write("target, no sync", seed, 0, 2.3 + 0.2 * s);
    }
  }
  void write(const std::string& condition, std::uint64_t seed, double oscillations, double time_s) {
    write(make_trial(scenario(), condition, seed, oscillations, time_s));
  }
  void write(const TrialResult& result) {
    const auto folder = out_ / trial_folder("turn", result.condition, result.seed);
    std::filesystem::create_directories(folder);
    write_result(folder, result);
  }
  void write_noted(std::uint64_t seed, std::vector<std::string> notes) {
    TrialResult trial = make_trial(scenario(), "host", seed, 0, 2.7);
    trial.this_run.notes = std::move(notes);
    write(trial);
  }
  static std::vector<std::string> noted(const Table& table) {
    std::vector<std::string> found;
    for (const std::string& note : table.notes)
      if (note.starts_with("Noted")) found.push_back(note);
    return found;
  }
  const scenario::Scenario& scenario() const { return campaign_.scenarios[0].scenario; }
  ScenarioResults results() const { return read_campaign_results(out_).scenarios[0]; }

  ScratchFolder scratch_;
  std::filesystem::path out_ = scratch_.path("out");
  scenario::Campaign campaign_ = make_campaign(scratch_);
};

TEST_F(Report, HasThePapersForm) {
  EXPECT_EQ(
      to_text(paper_form_table(results())),
      "Table III: Performance of the \"face anchor\" task\n"
      "\n"
      "                 Oscillations                       Time required (s)\n"
      "                 measured          paper            measured          paper\n"
      "SUT location      mean  std. dev.  mean  std. dev.   mean  std. dev.   mean  std. dev.\n"
      "──────────────────────────────────────────────────────────────────────────────────────\n"
      "host             0.000      0.000     0          0  2.600      0.100   2.48      0.033\n"
      "target           1.000      1.000     1      1.612  8.000      4.000  9.242     13.767\n"
      "target, no sync  0.000      0.000     0          0  2.700      0.200  2.504      0.108\n"
      "\n"
      "Trials: host 3 of 3 (3 reached the goal); target 3 of 3 (3 reached the goal); target, no "
      "sync 3 of 3 (3 reached the goal). Times are simulated time.\n"
      "Paper: Table III, Section V; ten experiments per condition.\n");
}

TEST_F(Report, NamesEveryTrialThatIsInNoMean) {
  TrialResult unfinished = make_trial(scenario(), "target", 2, 3, 0);
  unfinished.metrics[1].value.reset();
  unfinished.metrics[1].missing_because = "the SUT of 'uav1' did not finish";
  write(unfinished);
  write(make_setup_failure(scenario(), scenario().conditions[0], 3, "no port"));
  std::filesystem::remove_all(out_ / "turn/target-no-sync/seed-0001");
  scratch_.write("out/turn/target-no-sync/seed-0002/result.json", "{");

  const CampaignResults all = read_campaign_results(out_);
  const Table table = paper_form_table(all.scenarios[0]);
  EXPECT_THAT(table.notes,
              Contains("Not in a mean: target, seed 2: the SUT of 'uav1' did not finish."));
  EXPECT_THAT(table.notes, Contains("Not in a mean: host, seed 3: no port."));
  EXPECT_THAT(table.notes, Contains("Not run yet, or without a readable result: 2 trials of "
                                    "target, no sync."));
  EXPECT_THAT(all.damaged, ElementsAre(HasSubstr("target-no-sync/seed-0002/result.json")));
  EXPECT_THAT(to_text(table), HasSubstr("target           1.667      1.528"));
}

TEST_F(Report, NamesEveryTrialThatNeededASecondAttempt) {
  TrialResult again = make_trial(scenario(), "host", 3, 0, 2.7);
  again.this_run.attempts = 2;
  again.this_run.first_failure = "the port was taken";
  write(again);
  std::vector<std::string> found;
  for (const std::string& note : paper_form_table(results()).notes)
    if (note.starts_with("Second attempt")) found.push_back(note);
  EXPECT_THAT(found, ElementsAre("Second attempt: host, seed 3; the first could not be set up: "
                                 "the port was taken."));
}

// A SUT that a signal stopped is in the mean all the same; under the wall clock with its stop.
TEST_F(Report, NamesEveryTrialThatHasNotes) {
  EXPECT_THAT(noted(paper_form_table(results())), IsEmpty());
  write_noted(3, {"a signal stopped the SUT", "this machine was suspended"});
  const Table table = paper_form_table(results());
  const std::string note =
      "Noted: host, seed 3: a signal stopped the SUT; this machine was suspended.";
  EXPECT_THAT(noted(table), ElementsAre(note));
  EXPECT_THAT(to_text(table), HasSubstr("\n" + note + "\n"));
  EXPECT_THAT(to_markdown(table), HasSubstr("\n" + note + "\n"));
}

TEST_F(Report, OfManyTrialsWithNotesTellsTheFirstThree) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) write_noted(seed, {"busy"});
  ScenarioResults many = results();
  std::vector<TrialResult>& trials = many.conditions[0].trials;
  std::vector<std::string> expected = {"Noted: host, seed 1: busy.", "Noted: host, seed 2: busy.",
                                       "Noted: host, seed 3: busy."};
  EXPECT_EQ(noted(paper_form_table(many)), expected);
  const auto add = [&](std::uint64_t seed) {
    trials.push_back(trials.front());
    trials.back().seed = seed;
  };
  add(4);
  expected.push_back("Noted: host, seed 4 too (4 of 4 trials): see their result.json.");
  EXPECT_EQ(noted(paper_form_table(many)), expected);
  add(5);
  trials.back().this_run.notes.clear();
  add(6);
  expected.back() = "Noted: host, seeds 4, 6 too (5 of 6 trials): see their result.json.";
  EXPECT_EQ(noted(paper_form_table(many)), expected);
}

TEST_F(Report, GivesProgramsTheNotes) {
  write_noted(3, {"stopped, then \"continued\"", "suspended"});
  const CampaignResults all = read_campaign_results(out_);
  const std::string trials = to_csv(trials_table(all)), summaries = to_csv(summaries_table(all));
  EXPECT_THAT(trials, HasSubstr(",reason,notes\r\n"));
  EXPECT_THAT(trials, HasSubstr(",\"stopped, then \"\"continued\"\"; suspended\"\r\n"));
  EXPECT_THAT(summaries, HasSubstr(",paper_mean,paper_stddev,noted\r\n"));
  EXPECT_THAT(summaries, HasSubstr(",2.48,0.033,1\r\n"));
}

TEST_F(Report, ShowsWhatThePaperAloneMeasured) {
  ScenarioResults two = results();
  two.conditions.erase(two.conditions.begin());
  const Table table = paper_form_table(two);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_THAT(table.rows[2],
              ElementsAre("host (paper only)", "–", "–", "0", "0", "–", "–", "2.48", "0.033"));
}

TEST_F(Report, OfNothingRunYetHasRowsWithoutNumbers) {
  std::filesystem::remove_all(out_ / "turn");
  const CampaignResults all = read_campaign_results(out_);
  for (const Table& table : report_tables(all)) EXPECT_FALSE(to_text(table).empty());
  EXPECT_EQ(paper_form_table(all.scenarios[0]).rows.size(), 3u);
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

TEST_F(Report, StatesTheOptimismOfNoSync) {
  const auto found = optimism(results());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].a, "target");
  EXPECT_EQ(found[1].b, "target, no sync");
  EXPECT_NEAR(found[1].means.difference, 5.3, 1e-12);
  const std::string text = to_text(optimism_table(results()));
  EXPECT_THAT(text, HasSubstr("Time required (s)  target − target, no sync"));
  EXPECT_THAT(text, HasSubstr("5.300"));
  const auto uncorrected = HasSubstr("p is not corrected for the number of comparisons.");
  EXPECT_THAT(text, uncorrected);
  EXPECT_THAT(to_text(comparisons_table(results())), uncorrected);
}

// Sensors that cost something against sensors that cost nothing are no optimism of the
// synchronisation.
TEST_F(Report, ComparesForOptimismOnlyWhatHasTheSameSensors) {
  ScenarioResults one = results();
  for (auto& condition : one.conditions)
    for (TrialResult& trial : condition.trials) trial.profiles = {"paper_table_1"};
  EXPECT_EQ(optimism(one).size(), 2u);
  for (TrialResult& trial : one.conditions[1].trials) trial.profiles.push_back("ideal");
  EXPECT_TRUE(optimism(one).empty());
}

TEST_F(Report, ComparesForOptimismOnlyWhatRanOnTheSameTarget) {
  ScenarioResults one = results();
  for (TrialResult& trial : one.conditions[1].trials) trial.target = "another_board";
  EXPECT_TRUE(optimism(one).empty());
}

TEST_F(Report, SaysWhichTargetATrialRanOn) {
  TrialResult trial = make_trial(scenario(), "target", 2, 0, 3);
  trial.clock = "wall";
  trial.cpu_factor = 4.0;
  trial.target = "slow_board";
  write(trial);
  EXPECT_THAT(to_text(basis_table(read_campaign_results(out_))),
              HasSubstr("target: conservative_barrier, wall clock × 4, target slow_board"));
}

TEST_F(Report, SaysWhatItRestsOn) {
  TrialResult bad = make_trial(scenario(), "target", 2, 0, 3);
  bad.audit = AuditVerdict{false, "a command in the past"};
  bad.sync.causality_violations = 2;
  write(bad);
  const std::string text = to_text(basis_table(read_campaign_results(out_)));
  EXPECT_THAT(text, HasSubstr("a machine"));
  EXPECT_THAT(text, HasSubstr("tether-sut 0.1.0"));
  EXPECT_THAT(text, HasSubstr("1 to 3"));
  EXPECT_THAT(text, HasSubstr("9 of 9"));
  // 2.481 s of ST in 1.235 s.
  EXPECT_THAT(text, HasSubstr("host: 2.01; target: 2.01; target, no sync: 2.01"));
  EXPECT_THAT(text, HasSubstr("8 of 9 (6 synchronised trials)"));
  EXPECT_THAT(text, HasSubstr("target: conservative_barrier, cpu clock × 8"));
  EXPECT_THAT(text, HasSubstr("simulator at most 0.25 × real time"));
}

TEST_F(Report, SaysWhatAScriptedClockCharges) {
  TrialResult scripted = make_trial(scenario(), "target", 2, 0, 3);
  scripted.clock = "scripted";
  scripted.computing = Duration(2'500'000);
  write(scripted);
  EXPECT_THAT(to_text(basis_table(read_campaign_results(out_))),
              HasSubstr("scripted clock, 2.5 ms for each phase of computing"));
}

TEST_F(Report, SaysHowLateConcurrentSutsStoodStill) {
  const auto text = [&] { return to_text(basis_table(read_campaign_results(out_))); };
  EXPECT_THAT(text(), testing::Not(HasSubstr("Stops of all threads")));
  for (const std::uint64_t seed : {1u, 2u}) {
    TrialResult trial = make_trial(scenario(), "target", seed, 0, 3);
    trial.sync.stops = campaign::StopFigures{100 * seed, Duration(70'000 / seed)};
    write(trial);
  }
  EXPECT_THAT(text(), HasSubstr("300, at most 0.070 ms late"));
}

TEST_F(Report, OfOneRunHasItsLimits) {
  TrialResult trial = make_trial(scenario(), "target", 2, 3, 12.5);
  trial.metrics[0].value.reset();
  trial.metrics[0].missing_because = "no ground truth";
  const Table table = run_table(trial);
  EXPECT_THAT(table.rows[0], ElementsAre("Oscillations", "–", "–"));
  EXPECT_THAT(table.rows[1], ElementsAre("Time required (s)", "12.500", "30"));
  EXPECT_THAT(table.notes, Contains("No Oscillations: no ground truth."));
  EXPECT_THAT(noted(table), IsEmpty());
  trial.this_run.notes = {"a signal stopped the SUT", "suspended"};
  EXPECT_THAT(noted(run_table(trial)), ElementsAre("Noted: a signal stopped the SUT; suspended."));
}

TEST_F(Report, ForProgramsIsComplete) {
  const CampaignResults all = read_campaign_results(out_);
  EXPECT_EQ(trials_table(all).rows.size(), 18u);
  const Table summaries = summaries_table(all);
  EXPECT_EQ(summaries.rows.size(), 6u);
  EXPECT_THAT(to_csv(summaries), HasSubstr("turn,target,time_required,s,3,3,8,4,8,"));
  EXPECT_THAT(to_csv(summaries), HasSubstr(",9.242,13.767,0\r\n"));
}

TEST_F(Report, DetailsHaveAllStatistics) {
  EXPECT_THAT(
      to_text(details_table(results())),
      AllOf(HasSubstr("\nInterval: of the mean, Student's t."),
            HasSubstr("Time required (s)  target           3  8.000  [-1.937, 17.937]      4.000   "
                      "8.000  4.000  12.000")));
}

}  // namespace
}  // namespace tether::report
