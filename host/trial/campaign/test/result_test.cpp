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
  failed.this_run.stopped_program = failed.this_run.notes[0];
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
  trial_.pace->setpoint_gap_s = 0.5;
  trial_.pace->unqueued = {{"uav1", "imu", 12}};
  trial_.pace->losses = {2, SimTime(std::chrono::milliseconds(3201)), "uav1", "hover"};
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

}  // namespace
}  // namespace tether::campaign
