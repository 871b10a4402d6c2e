#include "flight.h"

#include <regex>
#include <set>

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
  failed.this_run.doubts = {{Doubt::Kind::kUnseenWait, "uav1", 4.9},
                            {Doubt::Kind::kBusyMachine, "pi", 0.3}};
  failed.this_run.loads = {{"pi", 0.3, 0.0}};
  failed.this_run.sut_files = {"flight.csv", "pictures/1.png"};
  failed.this_run.sizing = {"face_anchor", "target, counted", "t.toml", std::pair(0.75, 40.0)};
  failed.this_run.simulator = {milliseconds(1), milliseconds(2), 5, 4, 3};
  write_result(scratch_.path(), failed);
  EXPECT_EQ(read_result(scratch_.path()), failed);
  EXPECT_EQ(failed.outcome, Outcome::kFailed);
  EXPECT_EQ(failed.reason, "no port");
}

TEST_F(Result, IsRefusedIfItsOutcomeContradictsTheRest) {
  const auto expect_refused = [&](TrialResult edited, const std::string& why) {
    const Error error = bad_file_error([&] { (void)result_from_json(to_json(edited), "r.json"); });
    EXPECT_EQ(error.where().file, "r.json");
    EXPECT_THAT(error.what(), HasSubstr(why));
  };
  TrialResult edited = trial_;
  edited.metrics[1].max = 5.0;
  expect_refused(edited, "\"goal_reached\", but time_required is 9.242 s, beyond its limit of 5 s");
  edited.outcome = Outcome::kGoalMissed;
  EXPECT_EQ(result_from_json(to_json(edited), "r.json"), edited);
  edited.metrics[1].value = 4.0;
  expect_refused(edited, "\"goal_missed\", but nothing is missed");
  edited.contacts[0].hard = 1;
  EXPECT_EQ(result_from_json(to_json(edited), "r.json"), edited);
  edited = trial_;
  edited.end = std::string(kEndTimeLimit);
  expect_refused(edited, "but the end is \"time_limit\"");
  edited = trial_;
  edited.clauses = {{.uav = "uav1", .name = "near", .met = true, .margin = -1.0, .unit = "m"}};
  expect_refused(edited, "clause \"near\" is met by -1 m");
}

TEST_F(Result, KeepsEveryNanosecond) {
  for (const std::int64_t ns : {0L, 1L, 999'999'999L, 1'000'000'001L, 1'234'567'890'123'456L}) {
    trial_.sync.st_at_end = SimTime(Duration(ns));
    EXPECT_EQ(result_from_json(to_json(trial_), "f"), trial_) << ns;
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

TEST_F(Result, ReadsBackWithEveryOptionalPart) {
  const std::string plain = to_json(trial_);
  for (const char* member :
       {"\"target\":", "\"step_s\"", "overshoot", "computing_s", "warnings", "\"tasks\"",
        "\"clauses\"", "emulator", "\"pace\"", "\"energy\"", "\"margins\"", "\"quantiles\""})
    EXPECT_THAT(plain, testing::Not(HasSubstr(member)));
  trial_.clock.kind = computer::ClockKind::kScripted;
  trial_.clock.computing = Duration(2'500'000);
  trial_.step = StepReport{Duration(4'000'000), "world"};
  trial_.target = "slow_board";
  trial_.emulator = {"qemu-x86_64", "Nehalem", {{"integer", 0.125}, {"load", 0.5}}};
  trial_.profiles = {"rig", "top"};
  trial_.metrics[0].min = 0.5;
  trial_.contacts.push_back({.uav = "uav2"});
  trial_.tasks = {{"uav1", "find", SimTime{}, SimTime(seconds(3)), "reached", "goal reached"}};
  judge::ClauseVerdict clause{.uav = "uav1", .name = "near", .met = true};
  trial_.clauses = {clause};
  clause.margin = 0.25;
  clause.unit = "m";
  clause.from = clause.to = clause.deadline = clause.decided_at = SimTime(milliseconds(1500));
  clause.limited_by = "1 m";
  clause.margins = {{SimTime{}, 2.0}, {SimTime(milliseconds(1500)), 0.25}};
  clause.quantiles = {0.5, 0.75};
  clause.limit = 1.0;
  trial_.clauses.push_back(clause);
  trial_.energy = {{.uav = "uav1",
                    .spent_J = {1, -2, 3, 4, 5, 6},
                    .charge_from = 1.0,
                    .charge_to = 0.5,
                    .least_voltage_V = 11.25,
                    .tasks = {{"find", {6, 5, 4, 3, 2, 1}}}}};
  trial_.pace = timing::Pace{.uav = "uav1",
                             .seed = trial_.seed,
                             .stages = {{"detect", 40, 0.02, 0.03, 0.04, 0.05, 0.75}},
                             .camera = "camera",
                             .images = 41,
                             .read_hz = 29.5,
                             .offered_hz = 30.0,
                             .median_s = 0.02,
                             .p95_s = 0.03,
                             .shares_real_board = true,
                             .shared_board = "obc",
                             .programs = 3,
                             .waiting = 0.25,
                             .boards = {{.board = "obc", .uavs = {"uav1"}, .alone = 0.5}},
                             .radio = "radio=ideal",
                             .messages = 7,
                             .messages_arrived = 6};
  trial_.pace->setpoint_hz = 12.5;
  trial_.pace->speed = {.programs = {{.uav = "uav1",
                                      .clock = trial_.clock,
                                      .replay = record::ReplayInfo{"t", "exact", "now", "pi", "0a"},
                                      .board = "obc",
                                      .computer = "obc",
                                      .launcher = "nice",
                                      .concurrent = true,
                                      .build = "0a\nargument 1 x",
                                      .libraries = {"libx.so 0b"},
                                      .loader = "library ld-linux.so.2",
                                      .pinned_core = 1,
                                      .idle_W = 2.0,
                                      .busy_core_W = 3.0}},
                        .boards = {{"obc", 2, false}},
                        .machine = "here",
                        .target = "pi ssh://pi",
                        .emulator = trial_.emulator};
  trial_.warnings = {{Consequence::kMissing, {"w.sdf", 7}, "<include> of 'sun'", "is not found"},
                     {Consequence::kNoEffect, {}, "visual 'v'", "is plain", true}};
  trial_.sync.stops = StopFigures{1200, Duration(73'000)};
  trial_.this_run.target =
      TargetReport{.name = "board",
                   .address = "ssh://pi@board",
                   .before = {{"governor", "performance"}},
                   .after = {{"governor", "performance"}, {"throttled", "0x4"}},
                   .warnings = {"the target was throttled"},
                   .is_spoiled = true};
  const std::string text = to_json(trial_);
  EXPECT_EQ(result_from_json(text, "f"), trial_);
  for (const char* documented :
       {"\"outcome\": \"goal_reached\"", "\"exit_code\": 0", "\"st_at_end_s\": 2.481000001",
        "\"value\": 9.242", "\"steps\": 12", "\"stops\": 1200", "\"largest_overshoot_s\": 7.3e-05",
        "\"computing_s\": 0.0025", "\"step_s\": 0.004", "\"contacts\": \"not reported\"",
        "\"speed_m_s\": 0.25", "\"consequence\": \"missing\"", "\"can_change_verdict\": true",
        "\"margin\": 0.25", "\"deadline_s\": 1.5"})
    EXPECT_THAT(text, HasSubstr(documented));
  const auto begin = text.find("  \"profiles\""), end = text.find("  \"outcome\"");
  EXPECT_THAT(result_from_json(text.substr(0, begin) + text.substr(end), "f").profiles,
              testing::IsEmpty())
      << "of an older version";
}

TEST_F(Result, DecidesByTheConsequenceWhatAWarningOfAnOlderVersionChanges) {
  trial_.warnings = {{Consequence::kMissing, {}, "s", "m"}, {Consequence::kNoEffect, {}, "s", "m"}};
  const std::string text = std::regex_replace(
      to_json(trial_), std::regex(",\\s*\"can_change_verdict\": (true|false)"), "");
  EXPECT_THAT(text, testing::Not(HasSubstr("can_change_verdict")));
  EXPECT_EQ(result_from_json(text, "f").warnings, trial_.warnings);
}

TEST_F(Result, KeepsTextOfAnyBytesReadable) {
  trial_.reason = "bad \xff bytes \n and \"quotes\"";
  trial_.suts[0].details = "{ no JSON";
  const TrialResult back = result_from_json(to_json(trial_), "f");
  EXPECT_THAT(back.reason, HasSubstr("and \"quotes\""));
  EXPECT_EQ(back.suts[0].details, "{ no JSON");
}

std::string nested(std::size_t levels) {
  return "{\"a\":" + std::string(levels - 1, '[') + std::string(levels - 1, ']') + "}";
}

// Details of up to 60 levels are kept as an object, deeper ones as text. A recursive reader or
// writer would run out of stack at half a million.
TEST_F(Result, KeepsDetailsThatAreNestedTooDeeplyAsText) {
  for (const std::size_t levels : {60u, 61u, 500'001u}) {
    trial_.suts[0].details = nested(levels);
    const std::string text = to_json(trial_);
    EXPECT_EQ(text.find("\"details\": {") != std::string::npos, levels == 60);
    EXPECT_EQ(result_from_json(text, "f"), trial_);
  }
  trial_.suts[0].details = R"({"a":1})";
  std::string file = to_json(trial_);
  file.replace(file.find("\"a\": 1"), 6, "\"a\": " + nested(500'001));
  EXPECT_EQ(bad_file_error([&] { (void)result_from_json(file, "r.json"); }).where().file, "r.json");
}

TEST_F(Result, IsRefusedIfTruncatedAnywhere) {
  const std::string text = to_json(trial_);
  for (std::size_t size = 0; size + 2 < text.size(); size += 3)
    bad_file_error([&] { (void)result_from_json(text.substr(0, size), "r.json"); });
}

TEST_F(Result, IsRefusedIfAnyMemberIsMissingOrOfAnotherType) {
  const std::string text = to_json(trial_);
  const std::set<std::string> unread = {"met", "exit_code", "steps"};
  const std::set<std::string> free_names = {"simulator", "tether"};  // of versions
  int members = 0;
  for (std::size_t begin = 0; text.find('"', begin) != std::string::npos;
       begin = text.find('\n', begin) + 1) {
    const std::size_t name = text.find('"', begin) + 1, end = text.find('\n', begin);
    const std::size_t colon = text.find("\": ", name);
    const std::string member = text.substr(name, colon - name);
    if (colon > end || unread.contains(member) || text[colon + 3] == '{' || text[colon + 3] == '[')
      continue;
    ++members;
    const std::size_t stop = text[end - 1] == ',' ? end - 1 : end;
    const std::string retyped = text.substr(0, colon + 3) + "[]" + text.substr(stop);
    EXPECT_EQ(bad_file_error([&] { (void)result_from_json(retyped, "f"); }).subject(), member);
    if (free_names.contains(member)) continue;
    const std::string renamed = text.substr(0, name) + "x" + text.substr(name);
    EXPECT_EQ(bad_file_error([&] { (void)result_from_json(renamed, "f"); }).subject(), member);
  }
  EXPECT_GT(members, 40);
}

TEST_F(Result, IsRefusedIfASchemaOrAValueIsUnknown) {
  const auto expect_refused = [&](const std::string& member, std::string text,
                                  const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    EXPECT_EQ(bad_file_error([&] { (void)result_from_json(text, "f"); }).subject(), member);
  };
  expect_refused("schema", to_json(trial_), "\"schema\": 1", "\"schema\": 2");
  expect_refused("outcome", to_json(trial_), "\"goal_reached\"", "\"splendid\"");
  expect_refused("attempts", to_json(trial_), "\"attempts\": 1", "\"attempts\": 0");
  expect_refused("wall_s", to_json(trial_), "\"wall_s\": 1.2", "\"wall_s\": 1e300, \"x\": 1.2");
}

// make_result.

record::Record finished_record() {
  record::Record record = Flight().anchor_at(4.0, 0.0).pose(0, 0.0, 0.0, 0.0).finish(3000).record();
  record.header.seed = 5;
  record.header.tether_version = "0.1.0";
  record.header.simulator = "mujoco 2.2.2";
  record.header.machine = "a machine";
  record.header.suts = {
      {"uav1", "tether-sut 0.1.0", {computer::ClockKind::kCpu, 8.0}, Duration{0}}};
  record.footer = record::Footer{.end = "finished",
                                 .reason = "",
                                 .st_at_end = SimTime(seconds(3)),
                                 .et_at_end = {ExecTime(seconds(3))},
                                 .wall = seconds(2),
                                 .interactions = 9,
                                 .causality_violations = 0,
                                 .largest_lag = milliseconds(40),
                                 .largest_grid_error = milliseconds(1)};
  record::Interaction& read = record.interactions.emplace_back().message;
  read.uav = "uav1";
  read.kind = record::kSensor;
  return record;
}

const std::vector<TaskEnd> kReached = {{"uav1", true, "in the middle", "{}"}};

class MakeResult : public Result {
 protected:
  TrialResult make(const record::Record& record, const std::vector<TaskEnd>& ends) const {
    return make_result(scenario_, scenario_.conditions[1], record, ends);
  }
};

TEST_F(MakeResult, AProgramThatDoesNothingSaysNothingAboutItsComputer) {
  record::Record record = finished_record();
  record.header.suts[0].as_is = true;
  record.interactions.clear();
  record::Interaction& call = record.interactions.emplace_back().message;
  call.uav = "uav1";
  call.kind = record::kFinish;
  EXPECT_EQ(make(record, kReached).outcome, Outcome::kFailed);
  record.header.suts.emplace_back().uav = "uav2";
  EXPECT_NE(make(record, kReached).outcome, Outcome::kFailed) << "it can be a load beside another";
}

// A program whose exit code says that all is well, behind a flight controller.
TEST_F(MakeResult, ACompanionHasFlownOnlyIfItHasSentSomething) {
  record::Record record = finished_record();
  record.header.suts[0].controller.emplace().name = "built-in";
  record.interactions.pop_back();
  TrialResult result = make(record, kReached);
  EXPECT_EQ(result.outcome, Outcome::kFailed) << "it says nothing about its computer";
  EXPECT_EQ(result.end, kEndSetupFailed);
  EXPECT_EQ(result.reason,
            "the program of UAV 'uav1' ended before it did anything with it: in the middle");
  record::Interaction& read = record.interactions.emplace_back().message;
  read.uav = "uav1";
  for (const std::string_view waits : {record::kSleep, record::kReceive}) {
    read.kind = waits;
    EXPECT_EQ(make(record, kReached).outcome, Outcome::kFailed) << "it only waited";
    result = make(record, {});
  }
  EXPECT_THAT(to_line(result.warnings.at(0)), HasSubstr("did nothing with it"));
  read.kind = record::kSensor;
  EXPECT_THAT(to_line(make(record, kReached).warnings.at(0)), HasSubstr("sent no message"));
  record::AutopilotMessage& sent = record.autopilot.emplace_back().message;
  sent.uav = "uav1";
  sent.to_controller = true;
  sent.name = "HEARTBEAT";
  sent.outcome = "wrong_signature";
  EXPECT_THAT(to_line(make(record, kReached).warnings.at(0)), HasSubstr("refused 1 message "));
  sent.outcome = record::kDelivered;
  result = make(record, kReached);
  EXPECT_EQ(result.outcome, Outcome::kGoalReached);
  EXPECT_THAT(to_line(result.warnings.at(0)), HasSubstr("never left its start"));
  EXPECT_EQ(make(record, {}).warnings.size(), 1u) << "nor did it by the end of the time";
  for (const char* fields : {R"({"severity": 6, "text": "Welcome"})",
                             R"({"severity": 2, "text": "Arming denied: ", "chunk_seq": 0})",
                             R"({"severity": 2, "text": "no fix", "chunk_seq": 1})"}) {
    record::AutopilotMessage& said = record.autopilot.emplace_back().message;
    said.uav = "uav1";
    said.name = "STATUSTEXT";
    said.fields = fields;
  }
  EXPECT_THAT(make(record, {{"uav1", false, "it gave up", "{}"}}).reason,
              HasSubstr("it gave up; the flight controller said: Arming denied: no fix"));
  EXPECT_THAT(make(record, kReached).reason, testing::Not(HasSubstr("Arming")));
  record.ground_truth.push_back(record.ground_truth.back());
  record.ground_truth.back().message.p_WB_m[2] = 2.0;
  record.ground_truth.back().message.clearance_m = 1.5;
  result = make(record, kReached);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(to_line(result.warnings[0]), HasSubstr("is in the air (1.5 m from anything)"));
  for (auto& logged : record.ground_truth) logged.message.clearance_m = 1.5;
  EXPECT_TRUE(make(record, kReached).warnings.empty()) << "it began there";
  record::GroundTruth& last = record.ground_truth.back().message;
  std::ranges::copy(record.ground_truth.front().message.p_WB_m, last.p_WB_m);
  EXPECT_EQ(make(record, kReached).warnings.size(), 1u) << "it did nothing";
  const record::GroundTruth& first = record.ground_truth.front().message;
  const double half_rad = 0.1;  // about z
  last.q_WB[0] = first.q_WB[0] * std::cos(half_rad) - first.q_WB[3] * std::sin(half_rad);
  last.q_WB[3] = first.q_WB[0] * std::sin(half_rad) + first.q_WB[3] * std::cos(half_rad);
  EXPECT_TRUE(make(record, kReached).warnings.empty()) << "it turned";
}

TEST_F(MakeResult, TakesEverythingFromTheRecord) {
  const TrialResult result = make(finished_record(), kReached);
  EXPECT_EQ(result.outcome, Outcome::kGoalReached);
  EXPECT_EQ(result.scenario, "turn");
  EXPECT_EQ(result.condition, "target");
  EXPECT_EQ(result.seed, 5u);
  EXPECT_EQ(result.policy, "conservative_barrier");
  EXPECT_EQ(result.clock.factor, 8.0);
  EXPECT_EQ(result.target, "");
  EXPECT_EQ(result.find_metric("time_required")->value, 3.0);
  EXPECT_EQ(result.suts[0].et_at_end, ExecTime(seconds(3)));
  EXPECT_EQ(result.suts[0].outcome, "in the middle");
  EXPECT_EQ(result.sync.interactions, 9u);
  EXPECT_EQ(result.sync.largest_grid_error, milliseconds(1));
  EXPECT_FALSE(result.sync.stops);
  EXPECT_EQ(result.this_run.largest_lag, milliseconds(40));
  EXPECT_EQ(result.this_run.wall, seconds(2));
  EXPECT_EQ(result.versions.at("sut of uav1"), "tether-sut 0.1.0");
}

TEST_F(MakeResult, HasThePaceUnlessItFailed) {
  record::Record record = finished_record();
  record.header.policy = record::kConservativeBarrier;
  TrialResult result = make(record, kReached);
  EXPECT_EQ(result.pace, timing::pace_of(record));
  EXPECT_EQ(result.pace.value().seed, 5u);
  invalidate(result, "the SUT was lost");
  EXPECT_FALSE(result.pace);
}

TEST_F(MakeResult, MissesTheGoalWithAClause) {
  scenario::UavSetup& uav = campaign_.scenarios[0].scenario.uavs[0];
  uav.placement.name = "uav1";
  mission::Mission& mission = uav.sut.mission.emplace();
  mission.tasks.emplace_back().name = "turn";
  mission::Clause& clause = mission.clauses.emplace_back();
  clause.name = "in time";
  record::Record record = finished_record();
  for (const char* note : {R"({"task":"turn","event":"start"})",
                           R"({"task":"turn","event":"end","status":"reached"})"})
    record.annotations.push_back({{}, 0, {"uav1", {}, "mission", note}});

  clause.within = seconds(4);
  const TrialResult met = make(record, kReached);
  EXPECT_EQ(met.outcome, Outcome::kGoalReached) << met.reason;
  EXPECT_EQ(met.tasks.at(0).task, "turn");
  EXPECT_EQ(met.clauses.at(0).margin, 1.0);
  clause.within = seconds(2);
  const TrialResult missed = make(record, kReached);
  EXPECT_EQ(missed.outcome, Outcome::kGoalMissed);
  EXPECT_THAT(missed.reason, testing::StartsWith("clause \"in time\" is missed by 1 s"));
  TrialResult failed = met;
  invalidate(failed, "the SUT was lost");
  EXPECT_FALSE(failed.clauses.at(0).met || failed.clauses.at(0).margin);
  EXPECT_FALSE(
      make_setup_failure(scenario_, scenario_.conditions[1], 1, "no port").clauses.at(0).met);
}

TEST_F(MakeResult, TakesClockTargetAndProfilesFromScenarioAndCondition) {
  scenario::Scenario& scenario = campaign_.scenarios[0].scenario;
  scenario::Condition& condition = scenario.conditions[1];
  condition.computers[0].clock.kind = computer::ClockKind::kScripted;
  condition.computers[0].clock.computing = milliseconds(3);
  condition.computers[0].target.emplace().name = "slow_board";
  scenario.uavs[0].profile.emplace().name = "rig";
  condition.profiles.emplace_back().name = "top";
  const TrialResult result = make(finished_record(), kReached);
  EXPECT_EQ(result.clock.kind, computer::ClockKind::kScripted);
  EXPECT_EQ(result.clock.computing, milliseconds(3));
  EXPECT_EQ(result.target, "slow_board");
  EXPECT_THAT(result.profiles, testing::ElementsAre("rig", "top"));
}

TEST_F(MakeResult, ReportsStopsOnlyOfASynchronisedConcurrentSut) {
  record::Record record = finished_record();
  record.header.suts[0].concurrent = true;
  record.footer->stops = 7;
  record.footer->largest_overshoot = milliseconds(2);
  EXPECT_EQ(make(record, kReached).sync.stops, (StopFigures{7, milliseconds(2)}));
  record.header.policy = record::kFreeRunning;
  EXPECT_FALSE(make(record, kReached).sync.stops);
}

// A mean must not include the position of a UAV that never set out.
TEST_F(MakeResult, AMissedTaskHasNoMetrics) {
  for (const std::vector<TaskEnd>& ends :
       {std::vector<TaskEnd>{{"uav1", false, "anchor never seen", ""}}, std::vector<TaskEnd>{}}) {
    const TrialResult result = make(finished_record(), ends);
    EXPECT_EQ(result.outcome, Outcome::kGoalMissed);
    EXPECT_FALSE(result.find_metric("time_required")->value);
    EXPECT_EQ(result.find_metric("time_required")->missing_because, result.reason);
    EXPECT_THAT(result.reason, HasSubstr(ends.empty() ? "'uav1'" : "anchor never seen"));
  }
}

TEST_F(MakeResult, MissesTheGoalBeyondALimit) {
  record::Record record = finished_record();
  record.interactions[0].message.request_at = ExecTime(seconds(31));
  EXPECT_EQ(make(record, kReached).outcome, Outcome::kGoalMissed);
  EXPECT_EQ(exit_code(make(record, kReached).outcome), 1);
  EXPECT_EQ(make(record, kReached).reason, "time_required is 31 s, beyond its limit of 30 s");
  record.interactions[0].message.request_at = ExecTime(seconds(30) + std::chrono::nanoseconds(1));
  EXPECT_EQ(make(record, kReached).reason,
            "time_required is 30.000000001 s, beyond its limit of 30 s");
  record.interactions.erase(record.interactions.begin());  // its end
  EXPECT_THAT(make(record, kReached).reason, HasSubstr("no time_required: "));
  record = finished_record();
  record.footer->end = kEndTimeLimit;
  EXPECT_EQ(make(record, kReached).outcome, Outcome::kGoalMissed);
}

TEST_F(MakeResult, ALostPartIsAFailureWithoutMetrics) {
  for (const char* end : {"sut_lost", "sut_hung", "simulator_lost", "interrupted"}) {
    record::Record record = finished_record();
    record.footer->end = end;
    record.footer->reason = "because";
    const TrialResult result = make(record, kReached);
    EXPECT_EQ(exit_code(result.outcome), 3) << end;
    EXPECT_EQ(result.reason, "because");
    EXPECT_EQ(result.end, end);
    EXPECT_FALSE(result.find_metric("time_required")->value);
    EXPECT_EQ(result.find_metric("time_required")->missing_because, "because");
  }
}

TEST_F(MakeResult, ARecordWithoutInteractionsOrEndIsAFailure) {
  record::Record record = finished_record();
  record.footer->end = "sut_lost";
  record.footer->interactions = 0;
  EXPECT_EQ(make(record, {}).end, kEndSetupFailed);
  record.footer.reset();
  record.damage = "truncated at byte 17";
  EXPECT_EQ(make(record, kReached).outcome, Outcome::kFailed);
  EXPECT_THAT(make(record, kReached).reason, HasSubstr(record.damage));
}

}  // namespace
}  // namespace tether::campaign
