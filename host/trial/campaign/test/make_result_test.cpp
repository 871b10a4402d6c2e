#include "flight.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign/result.h>
#include <tether/campaign_testing/sample_campaign.h>

namespace tether::campaign {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

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

class MakeResult : public testing::Test {
 protected:
  TrialResult make(const record::Record& record, const std::vector<TaskEnd>& ends) const {
    return make_result(scenario_, scenario_.conditions[1], record, ends);
  }

  ScratchFolder scratch_;
  scenario::Campaign campaign_ = make_campaign(scratch_);
  const scenario::Scenario& scenario_ = campaign_.scenarios[0].scenario;
};

TEST_F(MakeResult, AProgramThatDoesNothingSaysNothingAboutItsComputer) {
  record::Record record = finished_record();
  record.header.suts[0].as_is = true;
  record.interactions.clear();
  record::Interaction& call = record.interactions.emplace_back().message;
  call.uav = "uav1";
  call.kind = record::kFinish;
  record.header.sensors.push_back({.uav = "uav1", .name = "eye", .kind = "camera"});
  EXPECT_EQ(make(record, kReached).outcome, Outcome::kFailed);
  EXPECT_THAT(make(record, kReached).reason, HasSubstr("cameras at /dev/video0 to 1"));
  record.header.suts[0].as_is = false;
  const TrialResult own_word = make(record, kReached);
  EXPECT_EQ(own_word.outcome, Outcome::kGoalReached) << "it says itself that it has flown";
  EXPECT_THAT(to_line(own_word.warnings.at(0)), HasSubstr("did nothing with it"));
  record.header.suts[0].as_is = true;
  record.header.suts.emplace_back().uav = "uav2";
  const TrialResult of_two = make(record, kReached);
  EXPECT_NE(of_two.outcome, Outcome::kFailed) << "it can be a load beside another";
  EXPECT_THAT(to_line(of_two.warnings.at(0)), HasSubstr("did nothing with it"));
}

TEST_F(MakeResult, AProgramThatHardlyDidAnythingAndDidNotMoveIsDoubtful) {
  record::Record record = finished_record();
  EXPECT_THAT(to_line(make(record, kReached).warnings.at(0)), HasSubstr("did hardly anything"));
  record.ground_truth.push_back(record.ground_truth.front());
  record.ground_truth.back().message.p_WB_m[0] += 1.0;
  EXPECT_TRUE(make(record, kReached).warnings.empty()) << "it has flown";
  record.ground_truth.pop_back();
  for (int i = 0; i < 9; ++i) record.interactions.push_back(record.interactions.back());
  EXPECT_TRUE(make(record, kReached).warnings.empty()) << "its goal may be to hover and look";
}

TEST_F(MakeResult, WhatIsNotKnownOfAProgramAsItIsIsDoubtful) {
  record::Record record = finished_record();
  for (int i = 0; i < 9; ++i) record.interactions.push_back(record.interactions.back());
  record.annotations.push_back({});
  record.annotations.back().message = {"uav1", {}, "as_is", R"({"doubt": "has another clock"})"};
  record.annotations.push_back({});
  record.annotations.back().message = {"uav1", {}, "as_is", R"({"doubt": 1})"};
  record.annotations.push_back({});
  record.annotations.back().message = {"uav1", {}, "other", R"({"doubt": "of its own"})"};
  const TrialResult result = make(record, kReached);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(to_line(result.warnings.front()), "UAV 'uav1' has another clock");
}

TEST_F(MakeResult, AProgramThatBeganNoTaskOfItsMissionIsDoubtful) {
  const auto file = scratch_.write("mission.toml", "[[task]]\ntask = \"search\"\n");
  scenario::Scenario scenario = scenario_;
  scenario.uavs[0].placement.name = "uav1";
  scenario.uavs[0].sut.mission = mission::load_mission(file);
  record::Record record = finished_record();
  const auto doubts = [&] {
    return make_result(scenario, scenario.conditions[1], record, kReached).warnings;
  };
  for (int i = 0; i < 9; ++i) record.interactions.push_back(record.interactions.back());
  EXPECT_THAT(to_line(doubts().at(0)), HasSubstr("began no task of its mission"));
  record::Annotation& task = record.annotations.emplace_back().message;
  task.uav = "uav1";
  task.topic = "mission";
  task.json = R"({"task": "search", "event": "start"})";
  EXPECT_THAT(to_line(doubts().at(0)), HasSubstr("'search' of its mission"));
  record.header.suts[0].as_is = true;
  EXPECT_TRUE(doubts().empty()) << "such a program does not tell its tasks";
}

// A program whose exit code says that all is well, behind a flight controller.
TEST_F(MakeResult, ACompanionHasFlownOnlyIfItHasSentSomething) {
  record::Record record = finished_record();
  record.header.suts[0].controller.emplace().name = "built-in";
  record.interactions.pop_back();
  TrialResult result = make(record, kReached);
  EXPECT_EQ(result.outcome, Outcome::kFailed) << "it says nothing about its computer";
  EXPECT_EQ(result.end, kEndSetupFailed);
  EXPECT_EQ(
      result.reason,
      "the program of UAV 'uav1' ended before it sent anything or read a sensor: in the middle");
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
  EXPECT_THAT(
      make(record, {{"uav1", false, "it gave up", "{}"}}).reason,
      HasSubstr("it gave up; the flight controller said at ST 0.000 s: Arming denied: no fix"));
  EXPECT_THAT(make(record, kReached).reason, testing::Not(HasSubstr("Arming")));
  record::AutopilotMessage& answer = record.autopilot.emplace_back().message;
  answer.uav = "uav1";
  answer.name = "COMMAND_ACK";
  answer.fields = R"({"command": 176, "result": 2})";
  EXPECT_THAT(to_line(make(record, kReached).warnings.at(0)),
              HasSubstr("its last request for a mode was denied: Arming denied: no fix"));
  record.autopilot.back().message.sent_at = from_ns<SimTime>(600'000'000);
  EXPECT_THAT(to_line(make(record, kReached).warnings.at(0)), testing::Not(HasSubstr("no fix")))
      << "that was said of something else";
  record.autopilot.push_back(record.autopilot.back());
  record.autopilot.back().message.fields = R"({"command": 176, "result": 0})";
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

TEST_F(MakeResult, WhatTheFlightControllerDeniedOrDidByItselfIsDoubtful) {
  record::Record record = finished_record();
  record.header.suts[0].controller.emplace().name = "built-in";
  record.ground_truth.push_back(record.ground_truth.front());
  record.ground_truth.back().message.p_WB_m[0] += 1.0;
  const auto say = [&](const char* name, const char* fields, bool to_controller = false) {
    record::AutopilotMessage& message = record.autopilot.emplace_back().message;
    message.uav = "uav1";
    message.to_controller = to_controller;
    message.outcome = record::kDelivered;
    message.name = name;
    message.fields = fields;
  };
  const auto doubts = [&] {
    std::string lines;
    for (const Warning& warning : make(record, kReached).warnings) lines += to_line(warning) + "\n";
    return lines;
  };
  say("SET_MODE", "{}", true);
  say("HEARTBEAT", R"({"base_mode": 217, "system_status": 4})");
  say("HEARTBEAT", R"({"autopilot": 8, "base_mode": 0, "system_status": 6})");  // of a gimbal
  say("COMMAND_ACK", R"({"command": 512, "result": 2})");
  EXPECT_EQ(doubts(), "") << "a message that was asked for is none of the flight";
  const record::Record fine = record;
  say("COMMAND_ACK", R"({"command": 300, "result": 2})");
  EXPECT_THAT(doubts(), HasSubstr("its last request for the start of a mission was denied"));
  say("COMMAND_ACK", R"({"command": 300, "result": 0})");
  EXPECT_EQ(doubts(), "") << "it was accepted later";
  say("ATTITUDE", "{}");
  record.autopilot.back().message.outcome = record::kQueueFull;
  EXPECT_THAT(doubts(), HasSubstr("was full: 1 of 7 messages were lost"));
  record.autopilot.pop_back();
  say("MISSION_ACK", R"({"type": 3})");
  EXPECT_THAT(doubts(), HasSubstr("its last mission was refused"));
  record = fine;
  say("HEARTBEAT", R"({"base_mode": 217, "system_status": 5})");
  EXPECT_THAT(doubts(), HasSubstr("was in a failsafe"));
  record = fine;
  say("HEARTBEAT", R"({"base_mode": 89, "system_status": 3})");
  for (auto& logged : record.ground_truth) logged.message.clearance_m = 2.0;
  EXPECT_THAT(doubts(), HasSubstr("is in the air")) << "disarmed";
  record.ground_truth.back().message.v_WB_m_s[2] = -2.3;
  EXPECT_THAT(doubts(), HasSubstr("sinks at 2.3 m/s, 2 m from anything, when its program ends"));
  record = fine;
  for (int i = 0; i < 6; ++i) say("SET_ATTITUDE_TARGET", "{}", true);
  EXPECT_THAT(doubts(), HasSubstr("flew none of the 6 set-points of its program"));
  say("HEARTBEAT", R"({"base_mode": 217, "system_status": 4, "custom_mode": 393216})");
  EXPECT_EQ(doubts(), "") << "it was in OFFBOARD";
  record.autopilot[record.autopilot.size() - 2].message.outcome = record::kIgnored;
  EXPECT_THAT(doubts(), HasSubstr("ignored 1 set-point of its program"));
}

TEST_F(MakeResult, CommandsThatHadNoEffectAreDoubtful) {
  record::Record record = finished_record();
  record.header.policy = record::kConservativeBarrier;
  record.ground_truth.push_back(record.ground_truth.front());
  const auto doubts = [&](const std::vector<TaskEnd>& ends) {
    std::string lines;
    for (const Warning& warning : make(record, ends).warnings) lines += to_line(warning) + "\n";
    return lines;
  };
  record::CommandEffect& command = record.commands.emplace_back().message;
  command.uav = "uav1";
  command.yaw_rate_rad_s = 0.1;
  EXPECT_THAT(doubts(kReached), testing::Not(HasSubstr("commanded nothing")));
  command.yaw_rate_rad_s = 0.0;
  EXPECT_THAT(doubts(kReached), HasSubstr("was commanded nothing but to stay"));
  record.ground_truth.back().message.p_WB_m[0] += 1.0;
  EXPECT_EQ(doubts(kReached), "") << "it moved";
  record.annotations.push_back(
      {{},
       0,
       {"uav1", {}, uav::kClientReport, R"({"refused_commands": 20, "uncharged_ms": 2130})"}});
  EXPECT_THAT(doubts(kReached), HasSubstr("was not given 20 commands of its program"));
  EXPECT_THAT(doubts(kReached), HasSubstr("other threads computed 2.13 s during calls"));
  record.annotations.clear();
  command.loss = "land";
  EXPECT_THAT(doubts(kReached), HasSubstr("had no new set-point for too long once, at ST 0.000 s"));
  EXPECT_EQ(doubts({{"uav1", false, "late", {}}}), "") << "a slow computer can be why";
}

TEST_F(MakeResult, TellsWhyItIsNotKnownWhetherAProgramWaited) {
  record::Record record = finished_record();
  record.header.policy = record::kConservativeBarrier;
  auto& report = record.annotations.emplace_back().message;
  report = {"uav1", {}, uav::kClientReport, R"({"clock_read_hz": 4e5})"};
  EXPECT_THAT(make(record, kReached).pace->unclear, HasSubstr("reads its clock every 2.5 µs"));
  report.json = R"({"clock_read_hz": 0, "others_ms": 5804})";
  EXPECT_THAT(make(record, kReached).pace->unclear, HasSubstr("5.8 s are of threads other"));
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
