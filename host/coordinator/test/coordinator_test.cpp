#include "coordinator_fixture.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/coordinator/coordinator.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

TEST_F(CoordinatorTest, AFinishedRunIsReportedAndRecorded) {
  const RunReport report =
      run({sleep(microseconds(1500), milliseconds(10)), finish(microseconds(700))});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_EQ(report.st, st_ms(12));
  ASSERT_EQ(report.suts.size(), 1u);
  EXPECT_EQ(report.suts[0].et, us(12'200));
  ASSERT_TRUE(report.suts[0].finish);
  EXPECT_TRUE(report.suts[0].finish->reached_goal);
  EXPECT_EQ(report.interactions, 2u);
  EXPECT_EQ(report.causality_violations, 0u);
  ASSERT_TRUE(recorder_.footer);
  EXPECT_EQ(recorder_.footer->end, "finished");
  EXPECT_EQ(recorder_.header.suts.at(0).sut, "script");
  EXPECT_EQ(recorder_.header.sensors.size(), 3u);
}

// What the SUT is told of its camera is what the record holds.
TEST_F(CoordinatorTest, TheRecordDescribesItsCameras) {
  run({finish(Duration(0))});
  const auto& [name, X_BS, rate_hz, properties] =
      std::get<link::Welcome>(server_->sent.at(1).front()).catalogue.sensors.at(kCamera);
  const uav::CameraModel& model = std::get<uav::CameraProperties>(properties).model;
  const auto& camera = recorder_.header.sensors.at(kCamera).camera;
  ASSERT_TRUE(camera);
  EXPECT_THAT(camera->p_BS_m, testing::ElementsAre(X_BS.p.x, X_BS.p.y, X_BS.p.z));
  EXPECT_THAT(camera->q_BS, testing::ElementsAre(X_BS.q.w, X_BS.q.x, X_BS.q.y, X_BS.q.z));
  EXPECT_EQ(camera->width_px, model.width_px);
  EXPECT_EQ(camera->fx_px, model.fx_px);
  EXPECT_EQ(camera->cy_px, model.cy_px);
  EXPECT_FALSE(recorder_.header.sensors.at(kRange).camera);
}

TEST_F(CoordinatorTest, TheWelcomeBringsTheCatalogue) {
  run({finish(Duration(0))});
  const auto& welcome = std::get<link::Welcome>(server_->sent.at(1).front());
  EXPECT_EQ(welcome.catalogue.uav, "uav0");
  EXPECT_EQ(welcome.catalogue.sensors.size(), 3u);
  EXPECT_EQ(welcome.catalogue.anchors.size(), 1u);
  EXPECT_FALSE(welcome.free_running);
}

// Paper, Fig. 8: the measurement starts when asked for; simulation goes on until the data is there,
// and no further.
TEST_F(CoordinatorTest, AnOnDemandReadIsSampledAtItsRequestAndDeliveredADelayLater) {
  run({read(microseconds(2'300), kRange), finish(Duration(0))});
  const record::Interaction& entry = recorder_.interactions.at(0);
  EXPECT_EQ(entry.request_at, us(2'300));
  EXPECT_EQ(entry.sampled_at, same_instant(us(2'300)));
  EXPECT_EQ(entry.sample_state_at, st_ms(2));
  EXPECT_EQ(entry.reply_at, us(100'000));
  EXPECT_EQ(entry.st_at_arrival, st_ms(0));
  EXPECT_EQ(entry.st_at_release, st_ms(100));
  EXPECT_EQ(entry.lag, microseconds(2'300));
  EXPECT_EQ(entry.grid_error, microseconds(300));
  EXPECT_EQ(simulator_->now(), st_ms(100));
}

TEST_F(CoordinatorTest, PeriodicReadsGetTheNewestOrWaitForTheNext) {
  run({read(Duration(0), kCamera), read(milliseconds(1), kCamera), read(milliseconds(95), kCamera),
       read(Duration(0), kCamera, true), finish(Duration(0))});
  const auto& log = recorder_.interactions;
  EXPECT_EQ(log.at(0).sample_index, 0u);  // waits until 0 + 10.4 ms
  EXPECT_EQ(log.at(0).reply_at, us(10'400));
  EXPECT_EQ(log.at(1).sample_index, 1u);  // waits until 33 + 10.4 ms
  EXPECT_EQ(log.at(1).reply_at, us(43'400));
  EXPECT_EQ(log.at(2).sample_index, 3u);  // at 138.4 ms: number 3 (99 + 10.4) is the newest
  EXPECT_EQ(log.at(2).reply_at, us(138'400));
  EXPECT_EQ(log.at(2).sample_state_at, st_ms(99));
  EXPECT_EQ(log.at(3).sample_index, 3u);  // the same again
  EXPECT_TRUE(log.at(3).latest);
  EXPECT_FALSE(log.at(2).latest);
  EXPECT_EQ(simulator_->calls().measure, 4u);
}

TEST_F(CoordinatorTest, CommandsActAfterTheCommandLatency) {
  latency_ = microseconds(1'500);
  run({turn(milliseconds(2), 1.0), sleep(Duration(0), milliseconds(9)), finish(Duration(0))});
  EXPECT_EQ(simulator_->applied().at(0).at, st_ms(4));
  EXPECT_EQ(recorder_.interactions.at(0).effect_at, st_ms(4));
}

TEST_F(CoordinatorTest, ASutIsNotHeldForItsOwnCommandToAct) {
  run({turn(microseconds(2'500), 1.0), finish(Duration(0))});
  EXPECT_EQ(recorder_.interactions.at(0).st_at_release, st_ms(2));
  EXPECT_EQ(recorder_.interactions.at(0).effect_at, st_ms(3));
}

// Everything but wall times.
std::string without_wall(const MemoryRecorder& r) {
  std::string text;
  for (const auto& i : r.interactions)
    for (const std::int64_t v :
         {to_ns(i.request_at), to_ns(i.reply_at), to_ns(i.st_at_arrival), to_ns(i.st_at_release),
          to_ns(i.sample_state_at.value_or(SimTime::min())),
          to_ns(i.effect_at.value_or(SimTime::min())), static_cast<std::int64_t>(i.sample_index)})
      text += std::to_string(v) + " ";
  for (const auto& g : r.ground_truth)
    text += std::to_string(g.p_WB_m[0]) + " " + std::to_string(to_ns(g.at)) + "\n";
  return text;
}

ScriptedServer::Script busy_script() {
  ScriptedServer::Script script;
  for (std::uint32_t i = 0; i < 40; ++i) {
    script.push_back(read(microseconds(i * 731 % 9'000), i % 3));
    script.push_back(turn(microseconds(i * 377 % 4'000), i % 2 ? 0.5 : -0.3));
  }
  script.push_back(finish(milliseconds(1)));
  return script;
}

TEST_F(CoordinatorTest, TheSimulatorsSpeedMakesNoDifference) {
  run(busy_script());
  const std::string unhindered = without_wall(recorder_);
  options_.real_time_factor = 0.1;
  recorder_ = {};
  make();
  const RunReport slowed = run(busy_script());
  EXPECT_EQ(without_wall(recorder_), unhindered);
  EXPECT_GE(to_seconds(slowed.wall), 9.0 * to_seconds(slowed.st));
}

TEST_F(CoordinatorTest, ProgressLetsTheSimulatorRunAheadWithoutChangingAnything) {
  make();
  const link::PeerId peer =
      server_->add_sut(hello(), {read(milliseconds(40), kRange), finish(Duration(0))});
  server_->deliver(peer, link::Progress{us(30'500)});
  for (int i = 0; i < 3; ++i) server_->deliver(peer, link::Progress{us(30'500)});
  coordinator_->run(*server_);
  const record::Interaction& entry = recorder_.interactions.at(0);
  EXPECT_EQ(entry.request_at, us(40'000));
  EXPECT_EQ(entry.sample_state_at, st_ms(40));
  EXPECT_EQ(entry.reply_at, us(137'700));
}

TEST_F(CoordinatorTest, SeveralSutsShareOneTime) {
  make(2);
  server_->add_sut(hello("uav1"), {turn(milliseconds(5), 1.0), sleep(Duration(0), milliseconds(20)),
                                   finish(Duration(0))});
  server_->add_sut(hello("uav0"), {read(milliseconds(7), kRange), turn(milliseconds(1), 1.0),
                                   finish(Duration(0))});
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kFinished);
  ASSERT_EQ(recorder_.interactions.size(), 6u);
  EXPECT_TRUE(std::is_sorted(
      recorder_.interactions.begin(), recorder_.interactions.end(),
      [](const auto& a, const auto& b) { return a.st_at_release < b.st_at_release; }));
  EXPECT_EQ(simulator_->applied().at(0).uav, 1u);
  EXPECT_EQ(simulator_->applied().at(0).at, st_ms(5));
}

TEST_F(CoordinatorTest, AnUnstampedClientIsChargedByTheCoordinatorsTimer) {
  make();
  server_->add_sut(hello("", link::ClockKind::kUnstamped),
                   {read(seconds(99), kRange), finish(seconds(99))});
  coordinator_->run(*server_);
  const record::Interaction& entry = recorder_.interactions.at(0);
  EXPECT_FALSE(entry.stamped);
  EXPECT_GT(entry.request_at, us(0));
  EXPECT_LT(entry.request_at,
            us(1'000'000));  // a few readings of the host's clock, not the script's 99 s
  EXPECT_EQ(recorder_.header.suts.at(0).clock, "unstamped");
}

TEST_F(CoordinatorTest, FreeRunningServesTheStateOfTheMomentAndChargesNothing) {
  options_.policy = sync::SyncPolicy::kFreeRunning;
  options_.real_time_factor = 0.25;
  const RunReport report =
      run({read(seconds(5), kRange), read(seconds(5), kCamera), finish(seconds(5))});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_LT(report.st, st_ms(100));
  for (const record::Interaction& entry : recorder_.interactions) {
    EXPECT_EQ(same_instant(entry.request_at), entry.st_at_arrival);
    EXPECT_EQ(entry.reply_at, entry.request_at);
    EXPECT_EQ(entry.st_at_release, entry.st_at_arrival);
  }
  EXPECT_TRUE(std::get<link::Welcome>(server_->sent.at(1).front()).free_running);
}

TEST_F(CoordinatorTest, FreeRunningFollowsTheWallClock) {
  options_.policy = sync::SyncPolicy::kFreeRunning;
  options_.real_time_factor = 0.5;
  options_.time_limit = seconds(1);
  const RunReport report = run({});
  EXPECT_EQ(report.end, RunEnd::kTimeLimit);
  EXPECT_NEAR(to_seconds(report.wall), 2.0, 0.1);
}

// Ways to fail: each names the culprit, ends the run, and leaves the record up to there.

TEST_F(CoordinatorTest, TheTimeLimitEndsTheRun) {
  options_.time_limit = seconds(2);
  const RunReport report = run({sleep(Duration(0), seconds(60))});
  EXPECT_EQ(report.end, RunEnd::kTimeLimit);
  EXPECT_EQ(report.st, st_ms(2'000));
  EXPECT_EQ(refusal(1).reason, link::Refusal::Reason::kRunEnded);
  EXPECT_EQ(recorder_.footer->end, "time_limit");
  EXPECT_EQ(recorder_.ground_truth.size(), 201u);
}

TEST_F(CoordinatorTest, ASutThatGivesNoWordIsHung) {
  options_.hang_limit = seconds(3);
  const RunReport report = run({sleep(Duration(0), milliseconds(5))});
  EXPECT_EQ(report.end, RunEnd::kSutHung);
  EXPECT_THAT(report.reason, HasSubstr("\"script\" of UAV \"uav0\" timed out: no message for 3 s"));
  EXPECT_EQ(recorder_.interactions.size(), 1u);
}

TEST_F(CoordinatorTest, ASutThatNeverJoinsEndsTheRun) {
  options_.connect_limit = seconds(1);
  make();
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("no SUT joined for UAV \"uav0\" within 1 s"));
}

TEST_F(CoordinatorTest, ASutThatDisconnectsIsLost) {
  make();
  const auto peer = server_->add_sut(hello(), {});
  server_->disconnect(peer);
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("lost the SUT of UAV \"uav0\": connection closed"));
}

TEST_F(CoordinatorTest, ALostSimulatorEndsTheRun) {
  make();
  simulator_->on_advance([](SimTime, SimTime to) {
    if (to >= st_ms(50)) throw Error(ErrorCode::kSetup, "the simulator crashed");
  });
  const RunReport report = run({sleep(Duration(0), seconds(1))});
  EXPECT_EQ(report.end, RunEnd::kSimulatorLost);
  EXPECT_EQ(report.reason, "the simulator crashed");
  EXPECT_LT(report.st, st_ms(50));
  EXPECT_TRUE(recorder_.footer);
}

// A simulator that was told to give up fails, too.
TEST_F(CoordinatorTest, WhatTheCallerKnowsOfALostSimulatorIsTheReason) {
  bool is_interrupted = false;
  make();
  simulator_->on_advance([&](SimTime, SimTime to) {
    if (to < st_ms(50)) return;
    is_interrupted = true;
    throw Error(ErrorCode::kSetup, "given up");
  });
  hooks_.should_stop = [&]() -> std::optional<std::pair<RunEnd, std::string>> {
    if (!is_interrupted) return std::nullopt;
    return std::pair(RunEnd::kInterrupted, std::string("by the user"));
  };
  const RunReport report = run({sleep(Duration(0), seconds(1))});
  EXPECT_EQ(report.end, RunEnd::kInterrupted);
  EXPECT_EQ(report.reason, "by the user");
}

TEST_F(CoordinatorTest, TheTargetIsReadOnceWhenTheRunHasEnded) {
  int reads = 0;
  hooks_.read_target = [&] {
    EXPECT_FALSE(recorder_.footer);
    ++reads;
    return record::Readings{{"governor", "performance"}};
  };
  run({sleep(Duration(0), milliseconds(50))});
  EXPECT_EQ(reads, 1);
  EXPECT_EQ(recorder_.footer->target_after, (record::Readings{{"governor", "performance"}}));
}

TEST_F(CoordinatorTest, TheCallerMayInterrupt) {
  hooks_.should_stop = [] {
    return std::optional(std::pair(RunEnd::kInterrupted, std::string("Ctrl-C")));
  };
  EXPECT_EQ(run({sleep(Duration(0), seconds(500))}).end, RunEnd::kInterrupted);
}

TEST_F(CoordinatorTest, StrangersAreRefusedAndTheRunIsUnharmed) {
  make();
  server_->add_sut(hello(), busy_script());
  link::Hello thief = hello();
  thief.token = "guess";
  const auto wrong_token = server_->add_sut(thief, {});
  const auto second = server_->add_sut(hello(), {});
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_EQ(refusal(wrong_token).reason, link::Refusal::Reason::kToken);
  EXPECT_EQ(refusal(second).reason, link::Refusal::Reason::kUav);
}

TEST_F(CoordinatorTest, ABadRequestIsAnsweredAndEndsTheRun) {
  make();
  const auto peer = server_->add_sut(hello(), {});
  server_->deliver(
      peer, link::Request{.sequence = 3, .issued_at = us(0), .body = link::ReadSensor{kImu}});
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_EQ(report.reason, "the SUT of UAV \"uav0\" sent request number 3, expected 1");
  EXPECT_EQ(refusal(peer).reason, link::Refusal::Reason::kBadRequest);
  EXPECT_EQ(refusal(peer).message, "request number 3, expected 1");
}

TEST_F(CoordinatorTest, AStampInThePastIsCountedAndNamed) {
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), milliseconds(10))});
  bool sent = false;
  hooks_.on_status = [&](const RunStatus& status) {
    if (sent || status.st < st_ms(10)) return;
    sent = true;
    server_->deliver(
        peer,
        link::Request{.sequence = 2, .issued_at = us(9'000), .body = link::Finish{true, "", ""}});
  };
  const RunReport report = coordinator_->run(*server_, hooks_);
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_EQ(report.causality_violations, 1u);
  EXPECT_EQ(recorder_.interactions.at(1).violation, "request in the past by 1000000 ns");
  EXPECT_EQ(recorder_.interactions.at(1).request_at, us(10'000));
}

// A SUT that is stuck keeps a helper thread that says so again and again: no word.
TEST_F(CoordinatorTest, ProgressThatGoesNowhereIsNoWord) {
  options_.hang_limit = seconds(3);
  make();
  const auto peer = server_->add_sut(hello(), {});
  hooks_.on_status = [&](const RunStatus&) { server_->deliver(peer, link::Progress{us(0)}); };
  EXPECT_EQ(coordinator_->run(*server_, hooks_).end, RunEnd::kSutHung);
}

// Two SUTs may wait for each other behind our back: one's progress must let the other go on.
TEST_F(CoordinatorTest, ProgressOfOneSutReleasesAnother) {
  make(2);
  bool released = false;
  const auto slow = server_->add_sut(hello("uav0"), {});
  const auto quick = server_->add_sut(hello("uav1"), {turn(Duration(110), 1.0)});
  hooks_.on_status = [&](const RunStatus& status) {
    released = server_->sent[quick].size() > 1;
    if (status.interactions == 0) server_->deliver(slow, link::Progress{us(900)});
  };
  hooks_.should_stop = [&]() -> std::optional<std::pair<RunEnd, std::string>> {
    if (!released && to_seconds(now_) < 100.0) return std::nullopt;
    return std::pair(RunEnd::kInterrupted, std::string("enough"));
  };
  coordinator_->run(*server_, hooks_);
  EXPECT_TRUE(released);
}

TEST_F(CoordinatorTest, LongStepsArePacedToo) {
  options_.policy = sync::SyncPolicy::kFreeRunning;
  options_.real_time_factor = 0.5;
  options_.time_limit = seconds(1);
  simulator_ = std::make_unique<sim::FakeSimulator>(sim::make_fake_world(1, milliseconds(80)));
  options_.token = "secret";
  options_.uavs.assign(1, {{kCameraTiming, kImuTiming, kRangeTiming}, Duration(0), std::nullopt});
  coordinator_ = std::make_unique<Coordinator>(*simulator_, recorder_, options_,
                                               [this] { return now_ += tick_; });
  server_ = std::make_unique<ScriptedServer>();
  server_->add_sut(hello(), {});
  EXPECT_EQ(coordinator_->run(*server_).end, RunEnd::kTimeLimit);
}

TEST_F(CoordinatorTest, ASutOnAnotherClockThanTheConditionsIsRefusedAndTheUserTold) {
  clock_ = ClockSetting{link::ClockKind::kCpu, 12.0};
  options_.connect_limit = seconds(1);
  make();
  std::vector<std::string> told;
  hooks_.on_refused = [&](const std::string& text) { told.push_back(text); };
  const auto peer = server_->add_sut(hello("", link::ClockKind::kWall), {});
  EXPECT_EQ(coordinator_->run(*server_, hooks_).end, RunEnd::kSutLost);
  EXPECT_THAT(refusal(peer).message, HasSubstr("TETHER_CLOCK='cpu*12'"));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_THAT(told[0], HasSubstr("TETHER_CLOCK='cpu*12'"));
}

TEST_F(CoordinatorTest, ASutThatMeasuresItsTimeIsRefusedWhereItIsScripted) {
  clock_ = ClockSetting{.kind = link::ClockKind::kScripted, .computing = microseconds(2500)};
  options_.connect_limit = seconds(1);
  make();
  const auto peer = server_->add_sut(hello("", link::ClockKind::kWall), {});
  EXPECT_EQ(coordinator_->run(*server_, hooks_).end, RunEnd::kSutLost);
  EXPECT_THAT(refusal(peer).message, HasSubstr("TETHER_CLOCK='scripted*2.5'"));
}

}  // namespace
}  // namespace tether::coordinator
