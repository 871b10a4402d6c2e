#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign/result.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

class Result : public testing::Test {
 protected:
  ScratchFolder scratch_;
  scenario::Campaign campaign_ = make_campaign(scratch_);
  const scenario::Scenario& scenario_ = campaign_.scenarios[0].scenario;
  TrialResult trial_ = make_trial(scenario_, "target", 2, 1.0, 9.242);
};

TEST_F(Result, ReadsBackAsItWasWritten) {
  write_result(scratch_.path(), trial_);
  EXPECT_EQ(read_result(scratch_.path()), trial_);
}

TEST_F(Result, ReadsBackWithEverythingMissing) {
  TrialResult failed = make_setup_failure(scenario_, scenario_.conditions[0], 7, "no port");
  failed.this_run.attempts = 2;
  failed.this_run.first_failure = "no port either";
  failed.this_run.notes = {"a SUT was stopped", "this machine was suspended"};
  write_result(scratch_.path(), failed);
  EXPECT_EQ(read_result(scratch_.path()), failed);
  EXPECT_EQ(failed.outcome, Outcome::kFailed);
  EXPECT_EQ(failed.reason, "no port");
}

TEST_F(Result, KeepsEveryNanosecond) {
  for (const std::int64_t ns :
       {0L, 1L, 999'999'999L, 1'000'000'001L, 123'456'789'012'345'678L / 100}) {
    trial_.sync.st_at_end = SimTime(Duration(ns));
    EXPECT_EQ(result_from_json(to_json(trial_), "f").sync.st_at_end, trial_.sync.st_at_end) << ns;
  }
}

TEST_F(Result, TextIsTheSameApartFromThisRun) {
  TrialResult other = trial_;
  other.this_run = {"2031-01-01T00:00:00Z", "another machine", seconds(99), seconds(1), 2, "x"};
  const std::string a = to_json(trial_), b = to_json(other);
  const auto part = a.find("\"this_run\"");
  ASSERT_NE(part, std::string::npos);
  EXPECT_NE(a, b);
  EXPECT_EQ(a.substr(0, part), b.substr(0, part));
}

TEST_F(Result, KeepsWhatWasReadOfTheTarget) {
  trial_.this_run.target =
      TargetReport{.name = "board",
                   .address = "ssh://pi@board",
                   .before = {{"governor", "performance"}},
                   .after = {{"governor", "performance"}, {"throttled", "0x4"}},
                   .warnings = {"the target was throttled"},
                   .is_spoiled = true};
  EXPECT_EQ(result_from_json(to_json(trial_), "f").this_run.target, trial_.this_run.target);
}

TEST_F(Result, IsReadableForPeople) {
  const std::string text = to_json(trial_);
  EXPECT_THAT(text, HasSubstr("\"outcome\": \"goal_reached\""));
  EXPECT_THAT(text, HasSubstr("\"exit_code\": 0"));
  EXPECT_THAT(text, HasSubstr("\"st_at_end_s\": 2.481000001"));
  EXPECT_THAT(text, HasSubstr("\"value\": 9.242"));
  EXPECT_THAT(text, HasSubstr("\"steps\": 12"));
}

TEST_F(Result, SaysWhatAScriptedSutWasCharged) {
  trial_.clock = "scripted";
  trial_.computing = Duration(2'500'000);
  const std::string text = to_json(trial_);
  EXPECT_THAT(text, HasSubstr("\"computing_s\": 0.0025"));
  EXPECT_EQ(result_from_json(text, "f").computing, trial_.computing);
}

TEST_F(Result, NamesItsTarget) {
  EXPECT_EQ(to_json(trial_).find("\"target\":"), std::string::npos);
  trial_.target = "slow_board";
  EXPECT_EQ(result_from_json(to_json(trial_), "f").target, "slow_board");
}

TEST_F(Result, SaysWhereConcurrentSutsStoodStill) {
  EXPECT_THAT(to_json(trial_), testing::Not(HasSubstr("overshoot")));
  trial_.sync.stops = StopFigures{1200, Duration(73'000)};
  const std::string text = to_json(trial_);
  EXPECT_THAT(text, HasSubstr("\"stops\": 1200"));
  EXPECT_THAT(text, HasSubstr("\"largest_overshoot_s\": 7.3e-05"));
  EXPECT_EQ(result_from_json(text, "f").sync, trial_.sync);
}

TEST_F(Result, NamesItsProfiles) {
  trial_.profiles = {"rig", "top"};
  EXPECT_EQ(result_from_json(to_json(trial_), "f").profiles, trial_.profiles);
  const std::string text = to_json(trial_);
  const auto begin = text.find("  \"profiles\""), end = text.find("  \"outcome\"");
  EXPECT_EQ(result_from_json(text.substr(0, begin) + text.substr(end), "f").profiles,
            std::vector<std::string>{});
}

TEST_F(Result, SaysNothingOfAScriptWhereTimeWasMeasured) {
  EXPECT_THAT(to_json(trial_), testing::Not(HasSubstr("computing_s")));
}

TEST_F(Result, TextOfAnyBytesIsKeptReadable) {
  trial_.reason = "bad \xff bytes \n and \"quotes\"";
  trial_.suts[0].details = "{ no JSON";
  const TrialResult back = result_from_json(to_json(trial_), "f");
  EXPECT_THAT(back.reason, HasSubstr("and \"quotes\""));
  EXPECT_EQ(back.suts[0].details, "{ no JSON");
}

// As many lists within each other as a megabyte has: whoever copied or wrote them as they are
// nested would run out of stack.
TEST_F(Result, OfDetailsThatAreTooDeepKeepsTheText) {
  const std::string lists(500'000, '['), ends(500'000, ']');
  const std::string deep = "{\"a\":" + lists + ends + "}";
  trial_.suts[0].details = deep;
  const std::string text = to_json(trial_);
  EXPECT_EQ(result_from_json(text, "f").suts[0].details, deep);

  trial_.suts[0].details = R"({"a":1})";
  std::string file = to_json(trial_);
  file.replace(file.find("\"a\": 1"), 6, "\"a\": " + lists + ends);
  EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { (void)result_from_json(file, "r.json"); }),
              HasSubstr("r.json: is nested deeper than 64 levels"));
}

// The deepest details that are kept as an object can be read again with all that is around them.
TEST_F(Result, OfTheDeepestDetailsReadsBack) {
  for (const std::size_t levels : {60u, 61u}) {
    const std::string lists(levels - 1, '['), ends(levels - 1, ']');
    trial_.suts[0].details = "{\"a\":" + lists + ends + "}";
    const std::string text = to_json(trial_);
    EXPECT_EQ(text.find("\"details\": {") != std::string::npos, levels == 60);
    EXPECT_EQ(result_from_json(text, "f"), trial_);
  }
}

TEST_F(Result, TornAnywhereIsDetected) {
  const std::string text = to_json(trial_);
  for (std::size_t size = 0; size + 2 < text.size(); size += 3) {
    EXPECT_THAT(error_message(ErrorCode::kBadFile,
                              [&] { (void)result_from_json(text.substr(0, size), "r.json"); }),
                HasSubstr("r.json: is torn or damaged"));
  }
}

TEST_F(Result, AnyMemberMissingOrOfAnotherTypeIsDetected) {
  std::istringstream stream(to_json(trial_));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  int members = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto colon = lines[i].find("\": ");
    const bool computed = lines[i].find("\"met\"") != std::string::npos ||
                          lines[i].find("\"exit_code\"") != std::string::npos ||
                          lines[i].find("\"steps\"") != std::string::npos;
    if (colon == std::string::npos || computed) continue;
    const std::string value = lines[i].substr(colon + 3);
    if (value.starts_with("{") || value.starts_with("[")) continue;
    ++members;
    std::string retyped, renamed;
    for (std::size_t j = 0; j < lines.size(); ++j) {
      const bool comma = lines[i].ends_with(",");
      retyped += (j == i ? lines[i].substr(0, colon + 3) + "[]" + (comma ? "," : "") : lines[j]);
      const auto quote = lines[i].find('"');
      renamed +=
          j == i ? lines[i].substr(0, quote + 1) + "x" + lines[i].substr(quote + 1) : lines[j];
    }
    // A SUT's version may have any name, and the number of a version any text.
    const bool is_version = lines[i].find("\"simulator\"") != std::string::npos ||
                            lines[i].find("\"tether\"") != std::string::npos;
    error_message(ErrorCode::kBadFile, [&] { (void)result_from_json(retyped, "f"); });
    if (is_version) continue;
    EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { (void)result_from_json(renamed, "f"); }),
                HasSubstr("lacks the member"))
        << lines[i];
  }
  EXPECT_GT(members, 40);
}

TEST_F(Result, OfANewerSchemaIsRefused) {
  std::string text = to_json(trial_);
  text.replace(text.find("\"schema\": 1"), 11, "\"schema\": 2");
  EXPECT_THAT(error_message(ErrorCode::kBadFile, [&] { (void)result_from_json(text, "f"); }),
              HasSubstr("has schema 2"));
}

// make_result.

record::Record finished_record() {
  record::Record record;
  record.header.seed = 5;
  record.header.policy = "conservative_barrier";
  record.header.tether_version = "0.1.0";
  record.header.simulator = "mujoco 2.2.2";
  record.header.machine = "a machine";
  record.header.suts = {{"uav1", "tether-sut 0.1.0", "cpu", 8.0, Duration{0}}};
  record.header.anchors = {{"box", "box", {}, {4, 0, 1}, {1, 0, 0, 0}}};
  record::GroundTruth truth;
  truth.uav = "uav1";
  record.ground_truth = {{SimTime{}, 0, truth}};
  record::Interaction finish;
  finish.uav = "uav1";
  finish.kind = "finish";
  finish.request_at = ExecTime(seconds(3));
  record.interactions = {{SimTime(seconds(3)), 0, finish}};
  record.footer = record::Footer{.end = "finished",
                                 .reason = "",
                                 .st_at_end = SimTime(seconds(3)),
                                 .et_at_end = {ExecTime(seconds(3))},
                                 .wall = seconds(2),
                                 .interactions = 9,
                                 .causality_violations = 0,
                                 .largest_lag = milliseconds(40),
                                 .largest_grid_error = milliseconds(1)};
  return record;
}

const std::vector<TaskEnd> kReached = {{"uav1", true, "in the middle", "{}"}};

class MakeResult : public Result {
 protected:
  TrialResult make(const record::Record& record, const std::vector<TaskEnd>& ends) const {
    return make_result(scenario_, scenario_.conditions[1], record, ends);
  }
};

TEST_F(MakeResult, NamesAThrottledBoardInItsReason) {
  record::Record record = finished_record();
  record.header.target = {"board", "ssh://pi@board", {{"throttled", "0x0"}}};
  EXPECT_EQ(make(record, kReached).reason, "every SUT reached its goal within the limits");
  EXPECT_FALSE(make(record, kReached).this_run.target->is_spoiled);

  record.footer->target_after = {{"throttled", "0x50005"}};
  const TrialResult result = make(record, kReached);
  EXPECT_THAT(result.reason, HasSubstr("within the limits; but the target was throttled"));
  ASSERT_TRUE(result.this_run.target);
  EXPECT_TRUE(result.this_run.target->is_spoiled);
  EXPECT_EQ(result.this_run.target->after.at("throttled"), "0x50005");
  EXPECT_EQ(result.outcome, Outcome::kGoalReached);

  // Of the host, where times need not be its own, it is a warning.
  record.header.target->address.clear();
  EXPECT_EQ(make(record, kReached).reason, "every SUT reached its goal within the limits");
  EXPECT_EQ(make(record, kReached).this_run.target->warnings.size(), 1u);
}

TEST_F(MakeResult, TakesWhatAScriptedSutIsChargedFromTheCondition) {
  scenario::Condition& condition = campaign_.scenarios[0].scenario.conditions[1];
  condition.clock = scenario::Clock::kScripted;
  condition.computing = milliseconds(3);
  const TrialResult result = make(finished_record(), kReached);
  EXPECT_EQ(result.clock, "scripted");
  EXPECT_EQ(result.computing, milliseconds(3));
}

TEST_F(MakeResult, TakesTheTargetFromTheCondition) {
  scenario::Condition& condition = campaign_.scenarios[0].scenario.conditions[1];
  EXPECT_EQ(make(finished_record(), kReached).target, "");
  condition.target.emplace().name = "slow_board";
  EXPECT_EQ(make(finished_record(), kReached).target, "slow_board");
}

TEST_F(MakeResult, TakesTheProfilesFromScenarioAndCondition) {
  scenario::Scenario& scenario = campaign_.scenarios[0].scenario;
  scenario::Profile rig, top;
  rig.name = "rig";
  top.name = "top";
  scenario.uavs[0].profile = rig;
  scenario.conditions[1].profiles = {top};
  EXPECT_THAT(make(finished_record(), kReached).profiles, testing::ElementsAre("rig", "top"));
}

TEST_F(MakeResult, TakesEverythingFromTheRecord) {
  const TrialResult result = make(finished_record(), kReached);
  EXPECT_EQ(result.outcome, Outcome::kGoalReached);
  EXPECT_EQ(result.scenario, "turn");
  EXPECT_EQ(result.condition, "target");
  EXPECT_EQ(result.seed, 5u);
  EXPECT_EQ(result.policy, "conservative_barrier");
  EXPECT_EQ(result.cpu_factor, 8.0);
  EXPECT_EQ(result.find_metric("time_required")->value, 3.0);
  EXPECT_EQ(result.suts[0].et_at_end, ExecTime(seconds(3)));
  EXPECT_EQ(result.suts[0].outcome, "in the middle");
  EXPECT_EQ(result.sync.interactions, 9u);
  EXPECT_EQ(result.sync.largest_grid_error, milliseconds(1));
  EXPECT_EQ(result.this_run.largest_lag, milliseconds(40));
  EXPECT_EQ(result.this_run.wall, seconds(2));
  EXPECT_EQ(result.versions.at("sut of uav1"), "tether-sut 0.1.0");
}

TEST_F(MakeResult, TellsOfStopsOnlyWhereASutIsConcurrent) {
  record::Record record = finished_record();
  EXPECT_FALSE(make(record, kReached).sync.stops);
  record.header.suts[0].concurrent = true;
  record.footer->stops = 7;
  record.footer->largest_overshoot = milliseconds(2);
  EXPECT_EQ(make(record, kReached).sync.stops, (StopFigures{7, milliseconds(2)}));
  record.header.policy = record::kFreeRunning;
  EXPECT_FALSE(make(record, kReached).sync.stops);
}

TEST_F(MakeResult, MissesTheGoalWithAReason) {
  EXPECT_THAT(make(finished_record(), {{"uav1", false, "anchor never seen", ""}}).reason,
              HasSubstr("did not reach its goal: anchor never seen"));
  EXPECT_THAT(make(finished_record(), {}).reason, HasSubstr("did not finish"));

  record::Record late = finished_record();
  late.interactions[0].message.request_at = ExecTime(seconds(31));
  const TrialResult result = make(late, kReached);
  EXPECT_EQ(result.outcome, Outcome::kGoalMissed);
  EXPECT_EQ(exit_code(result.outcome), 1);
  EXPECT_EQ(result.reason, "time_required is 31 s, beyond its limit of 30 s");
}

// A mean must not take up the position of an UAV that never set out.
TEST_F(MakeResult, AMissedTaskMeasuresNothing) {
  const auto metric = [](const TrialResult& result) {
    return *result.find_metric("time_required");
  };
  const MetricValue missed =
      metric(make(finished_record(), {{"uav1", false, "anchor never seen", ""}}));
  EXPECT_FALSE(missed.value);
  EXPECT_EQ(missed.missing_because, "the SUT of 'uav1' did not reach its goal: anchor never seen");
  EXPECT_EQ(metric(make(finished_record(), {})).missing_because,
            "the SUT of 'uav1' did not finish");
  record::Record lost = finished_record();
  lost.footer->end = "sut_lost";
  lost.footer->reason = "because";
  EXPECT_FALSE(metric(make(lost, kReached)).value);
  EXPECT_EQ(metric(make(lost, kReached)).missing_because, "because");
}

TEST_F(MakeResult, TheTimeLimitMissesTheGoal) {
  record::Record record = finished_record();
  record.footer->end = "time_limit";
  EXPECT_EQ(make(record, kReached).outcome, Outcome::kGoalMissed);
  EXPECT_EQ(make(record, kReached).reason, "the time limit was reached");
}

TEST_F(MakeResult, ALostPartIsAFailure) {
  for (const char* end : {"sut_lost", "sut_hung", "simulator_lost", "interrupted"}) {
    record::Record record = finished_record();
    record.footer->end = end;
    record.footer->reason = "because";
    const TrialResult result = make(record, kReached);
    EXPECT_EQ(exit_code(result.outcome), 3) << end;
    EXPECT_EQ(result.reason, "because");
    EXPECT_EQ(result.end, end);
  }
}

TEST_F(MakeResult, ASutThatNeverDidAnythingIsAMatterOfTheSetUp) {
  record::Record record = finished_record();
  record.footer->end = "sut_lost";
  record.footer->interactions = 0;
  EXPECT_EQ(make(record, {}).end, kEndSetupFailed);
}

TEST_F(MakeResult, ARecordWithoutItsEndIsAFailure) {
  record::Record record = finished_record();
  record.footer.reset();
  record.damage = "torn at byte 17";
  const TrialResult result = make(record, kReached);
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_THAT(result.reason, HasSubstr("torn at byte 17"));
}

TEST_F(Result, AnInvalidOneKeepsNoNumbers) {
  TrialResult result;
  result.outcome = Outcome::kGoalReached;
  result.metrics.push_back({.name = "time_required",
                            .kind = "time_required",
                            .label = "",
                            .unit = "s",
                            .value = 2.0,
                            .missing_because = "",
                            .max = {}});
  invalidate(result, "broken rules");
  EXPECT_EQ(result.outcome, Outcome::kFailed);
  EXPECT_EQ(result.reason, "broken rules");
  EXPECT_FALSE(result.metrics[0].value);
  EXPECT_EQ(result.metrics[0].missing_because, "broken rules");
}

}  // namespace
}  // namespace tether::campaign
