#include "coordinator_fixture.h"
#include "sessions/validator.h"

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

TEST_F(CoordinatorTest, ReportsAndRecordsAFinishedRun) {
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

// Contacts are asked for with the ground truth, however far the simulation advances at once.
TEST_F(CoordinatorTest, RecordsContactsAndTheLeastClearance) {
  const std::vector<sim::Contact> contacts{{st_ms(3), 0, "wall", 4.0}, {st_ms(11), 0, "box", 0.5}};
  make();
  simulator_->plan_contacts(contacts);
  const uav::VelocityCommand ahead{.velocity_H_m_s = {100.0, 0.0, 0.0}, .yaw_rate_rad_s = 0.0};
  run({{milliseconds(1), link::SetVelocity{ahead}},
       sleep(Duration(0), milliseconds(11)),
       finish(milliseconds(1))});
  EXPECT_TRUE(recorder_.header.reports_contacts);
  ASSERT_EQ(recorder_.contacts.size(), 2u);
  EXPECT_EQ(recorder_.contacts[0].first, st_ms(10));
  EXPECT_EQ(recorder_.contacts[1].first, st_ms(13)) << "the end";
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const record::Contact& contact = recorder_.contacts[i].second;
    EXPECT_EQ(contact.uav, "uav0");
    EXPECT_EQ(contact.at, contacts[i].at);
    EXPECT_EQ(contact.with, contacts[i].with);
    EXPECT_EQ(contact.speed_m_s, contacts[i].speed_m_s);
  }
  ASSERT_EQ(recorder_.footer->clearances.size(), 1u);
  EXPECT_NEAR(recorder_.footer->clearances[0].min_m, 9.1, 1e-9);
  EXPECT_EQ(recorder_.footer->clearances[0].at, st_ms(10));
  EXPECT_EQ(recorder_.footer->clearances[0].to, "wall");
}

TEST_F(CoordinatorTest, SaysThatTheSimulatorReportsNoContacts) {
  run({finish(Duration(0))});
  EXPECT_FALSE(recorder_.header.reports_contacts);
  EXPECT_TRUE(recorder_.footer->clearances.empty());
}

TEST_F(CoordinatorTest, SendsACatalogueWithTheCamerasOfTheRecord) {
  run({finish(Duration(0))});
  const auto& welcome = std::get<link::Welcome>(server_->sent.at(1).front());
  EXPECT_EQ(welcome.catalogue.uav, "uav0");
  EXPECT_EQ(welcome.catalogue.sensors.size(), 3u);
  EXPECT_EQ(welcome.catalogue.anchors.size(), 1u);
  EXPECT_FALSE(welcome.free_running);

  const auto& [name, X_BS, rate_hz, properties, own_stamps, joints] =
      welcome.catalogue.sensors.at(kCamera);
  EXPECT_FALSE(own_stamps || joints > 0);
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

// The record has the truth; the SUT sees what the driver says.
TEST_F(CoordinatorTest, ASutSeesStampsOfTheDriverAndTheRecordHasBoth) {
  sim::World world = sim::make_fake_world(1, milliseconds(1));
  const uav::DriverModel model{
      .stamp_offset = milliseconds(20), .lost_probability = 0.3, .repeated_probability = 0.4};
  world.uavs[0].sensors[kCamera].driver = model;
  const std::string name = world.uavs[0].sensors[kCamera].name;
  make(std::move(world));
  const uav::Driver driver(model, kCameraTiming.period, options_.seed, "uav0", name);
  ScriptedServer::Script script(30, read(Duration(0), kCamera));
  script.push_back(finish(Duration(0)));
  run(std::move(script));

  EXPECT_TRUE(std::get<link::Welcome>(server_->sent.at(1).front())
                  .catalogue.sensors.at(kCamera)
                  .own_stamps);
  ASSERT_TRUE(recorder_.header.sensors.at(kCamera).driver);
  EXPECT_FALSE(recorder_.header.sensors.at(kImu).driver);
  std::uint64_t index = 0;
  int repeated = 0;
  for (std::size_t i = 0; i < 30; ++i, ++index) {
    while (driver.loses(index)) ++index;
    const record::Interaction& entry = recorder_.interactions.at(i);
    const std::uint64_t content = driver.content_of(index);
    ASSERT_EQ(entry.sample_index, index);
    ASSERT_EQ(entry.repeated_index.value_or(index), content);
    repeated += entry.repeated_index ? 1 : 0;
    ASSERT_EQ(entry.sampled_at, uav::sampling_instant(kCameraTiming, content));
    ASSERT_EQ(entry.sample_state_at, entry.sampled_at);
    ASSERT_EQ(entry.sample_stamp, driver.stamp(uav::sampling_instant(kCameraTiming, index), index));
    const auto& reply = std::get<link::Reply>(server_->sent.at(1).at(i + 1));
    const auto& image = std::get<uav::CameraSample>(*reply.sample);
    ASSERT_EQ(image.sampled_at, entry.sample_stamp);
    ASSERT_EQ(image.index, index);
  }
  EXPECT_GT(repeated, 0);
}

// Paper, Fig. 8: the measurement starts at the request, and the simulation advances until its data
// is available, and no further.
TEST_F(CoordinatorTest, SamplesAnOnDemandReadAtItsRequestAndRepliesADelayLater) {
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

TEST_F(CoordinatorTest, PeriodicReadsGetTheNewestMeasurementOrWaitForTheNext) {
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

TEST_F(CoordinatorTest, CommandsTakeEffectAfterTheCommandLatencyWithoutHoldingTheSut) {
  latency_ = microseconds(1'500);
  run({turn(milliseconds(2), 1.0), turn(microseconds(100), 1.0), sleep({}, milliseconds(9)),
       finish(Duration(0))});
  EXPECT_EQ(simulator_->applied().at(0).at, st_ms(4));
  EXPECT_EQ(recorder_.interactions.at(0).effect_at, st_ms(4));
  EXPECT_EQ(recorder_.interactions.at(0).st_at_release, st_ms(2));
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

TEST_F(CoordinatorTest, TheSpeedOfTheSimulatorDoesNotChangeTheRecord) {
  run(busy_script());
  const std::string unlimited = without_wall(recorder_);
  options_.real_time_factor = 0.1;
  make();
  const RunReport slowed = run(busy_script());
  EXPECT_EQ(without_wall(recorder_), unlimited);
  EXPECT_GE(to_seconds(slowed.wall), 9.0 * to_seconds(slowed.st));
}

TEST_F(CoordinatorTest, ProgressMessagesDoNotChangeTheRecord) {
  make();
  const link::PeerId peer =
      server_->add_sut(hello(), {read(milliseconds(40), kRange), finish(Duration(0))});
  for (int i = 0; i < 4; ++i) server_->deliver(peer, link::Progress{us(30'500)});
  run();
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
  EXPECT_EQ(run().end, RunEnd::kFinished);
  ASSERT_EQ(recorder_.interactions.size(), 6u);
  EXPECT_TRUE(
      std::ranges::is_sorted(recorder_.interactions, {}, &record::Interaction::st_at_release));
  EXPECT_EQ(simulator_->applied().at(0).uav, 1u);
  EXPECT_EQ(simulator_->applied().at(0).at, st_ms(5));
}

// Even if ST does not advance by a step.
TEST_F(CoordinatorTest, ProgressOfOneSutReleasesAnother) {
  make(2);
  bool released = false;
  const auto slow = add_silent(false, "uav0");
  const auto quick = server_->add_sut(hello("uav1"), {turn(Duration(110), 1.0)});
  hooks_.on_status = [&](const RunStatus& status) {
    released = server_->sent[quick].size() > 1;
    if (status.interactions == 0) server_->deliver(slow, link::Progress{us(900)});
  };
  hooks_.should_stop = [&]() -> std::optional<Ending> {
    if (!released && to_seconds(now_) < 100.0) return std::nullopt;
    return Ending{RunEnd::kInterrupted, "enough"};
  };
  run();
  EXPECT_TRUE(released);
}

TEST_F(CoordinatorTest, MeasuresTheTimeOfAnUnstampedClient) {
  clock_ = computer::Clock{.kind = computer::ClockKind::kUnstamped};
  make();
  server_->add_sut(hello("", computer::ClockKind::kUnstamped),
                   {read(seconds(99), kRange), finish(seconds(99))});
  run();
  const record::Interaction& entry = recorder_.interactions.at(0);
  EXPECT_FALSE(entry.stamped);
  EXPECT_GT(entry.request_at, us(0));
  EXPECT_LT(entry.request_at, us(1'000'000));  // some readings of the host clock
  const record::SutInfo& sut = recorder_.header.suts.at(0);
  EXPECT_EQ(sut.clock.kind, computer::ClockKind::kUnstamped);
  EXPECT_EQ(sut.required_clock, (computer::Clock{computer::ClockKind::kUnstamped}));
}

// ---- Failures: each ends the run with its cause, and keeps the record up to there.

TEST_F(CoordinatorTest, EndsAtTheTimeLimit) {
  options_.time_limit = seconds(2);
  const RunReport report = run({sleep(Duration(0), seconds(60))});
  EXPECT_EQ(report.end, RunEnd::kTimeLimit);
  EXPECT_EQ(report.st, st_ms(2'000));
  EXPECT_EQ(refusal(1).reason, link::Refusal::Reason::kRunEnded);
  EXPECT_EQ(recorder_.footer->end, "time_limit");
  EXPECT_EQ(recorder_.ground_truth.size(), 201u);
}

TEST_F(CoordinatorTest, EndsIfASutDoesNotJoinOrDisconnects) {
  options_.connect_limit = seconds(1);
  make();
  RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_FALSE(report.began);
  make();
  server_->disconnect(add_silent());
  report = run();
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_TRUE(report.began && report.lost_uav == "uav0");
  EXPECT_THAT(report.reason, HasSubstr("connection closed"));
}

// A simulator that is interrupted fails, too: then the caller knows the cause.
TEST_F(CoordinatorTest, EndsIfTheSimulatorFails) {
  for (const bool interrupted : {false, true}) {
    bool failed = false;
    make();
    simulator_->on_advance([&](SimTime, SimTime to) {
      if (to < st_ms(50)) return;
      failed = true;
      throw Error(ErrorCode::kSetup, "crashed");
    });
    hooks_.should_stop = [&]() -> std::optional<Ending> {
      if (!failed || !interrupted) return std::nullopt;
      return Ending{RunEnd::kInterrupted, "by the user"};
    };
    const RunReport report = run({sleep(Duration(0), seconds(1))});
    EXPECT_EQ(report.end, interrupted ? RunEnd::kInterrupted : RunEnd::kSimulatorLost);
    EXPECT_EQ(report.reason, interrupted ? "by the user" : "crashed");
    EXPECT_LT(report.st, st_ms(50));
    EXPECT_TRUE(recorder_.footer);
  }
}

TEST_F(CoordinatorTest, ReadsTheTargetOnceAfterTheRun) {
  int reads = 0;
  hooks_.read_target = [&] {
    EXPECT_FALSE(recorder_.footer);
    ++reads;
    return record::Readings{{"governor", "performance"}};
  };
  make();
  server_->add_sut(hello("", computer::ClockKind::kWall), {sleep(Duration(0), milliseconds(50))});
  run();
  EXPECT_EQ(reads, 1);
  EXPECT_EQ(recorder_.footer->target_after, (record::Readings{{"governor", "performance"}}));
}

TEST_F(CoordinatorTest, EndsIfTheRecordCannotBeWritten) {
  for (int room = 1;; room += 7) {
    make();
    recorder_.room = room;
    const RunReport report = run(busy_script());
    if (recorder_.footer) {
      EXPECT_EQ(report.end, RunEnd::kFinished);
      return;
    }
    EXPECT_EQ(report.end, RunEnd::kRecordFailed);
    EXPECT_TRUE(report.began);
    EXPECT_THAT(report.reason, HasSubstr("the disk is full"));
    const bool had_finished = report.suts.at(0).finish.has_value();
    EXPECT_TRUE(had_finished || refusal(1).reason == link::Refusal::Reason::kRunEnded);
  }
}

TEST_F(CoordinatorTest, RejectedClientsDoNotDisturbTheRun) {
  make();
  server_->add_sut(hello(), busy_script());
  link::Hello thief = hello();
  thief.token = "guess";
  const auto wrong_token = server_->add_sut(thief, {});
  const auto second = add_silent();
  EXPECT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(refusal(wrong_token).reason, link::Refusal::Reason::kToken);
  EXPECT_EQ(refusal(second).reason, link::Refusal::Reason::kUav);
}

TEST_F(CoordinatorTest, AProtocolViolationIsReportedToTheSutAndTheCaller) {
  make();
  const auto peer = add_silent();
  server_->deliver(peer, request(3, us(0), link::ReadSensor{kImu}));
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_EQ(refusal(peer).reason, link::Refusal::Reason::kBadRequest);
  EXPECT_EQ(report.reason, "the SUT of UAV \"uav0\" sent " + refusal(peer).message);
}

TEST_F(CoordinatorTest, CountsATimestampInThePastAsAViolation) {
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), milliseconds(10))});
  bool sent = false;
  hooks_.on_status = [&](const RunStatus& status) {
    if (sent || status.st < st_ms(10)) return;
    sent = true;
    server_->deliver(peer, request(2, us(9'000), link::Finish{true, "", ""}));
  };
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_EQ(report.causality_violations, 1u);
  EXPECT_EQ(recorder_.interactions.at(1).violation, "request in the past by 1000000 ns");
  EXPECT_EQ(recorder_.interactions.at(1).request_at, us(10'000));
}

TEST_F(CoordinatorTest, RejectsASutWithAnotherClockThanItsCondition) {
  const std::pair<computer::Clock, const char*> cases[] = {
      {{computer::ClockKind::kCpu, 12.0}, "TETHER_CLOCK='cpu*12'"},
      {{.kind = computer::ClockKind::kScripted, .computing = microseconds(2500)},
       "TETHER_CLOCK='scripted*2.5'"}};
  options_.connect_limit = seconds(1);
  for (const auto& [clock, expected] : cases) {
    clock_ = clock;
    make();
    std::vector<std::string> refused;
    hooks_.on_refused = [&](const std::string&, const std::string& reason) {
      refused.push_back(reason);
    };
    const auto peer = server_->add_sut(hello("", computer::ClockKind::kWall), {});
    EXPECT_EQ(run().end, RunEnd::kSutLost);
    EXPECT_THAT(refusal(peer).message, HasSubstr(expected));
    EXPECT_THAT(refused, testing::ElementsAre(HasSubstr(expected)));
  }
}

TEST_F(CoordinatorTest, RecordsAnnotationsOfSutsOnly) {
  make();
  const auto peer = server_->add_sut(hello(), {finish(milliseconds(1))});
  const link::PeerId stranger = peer + 1;
  for (const auto from : {peer, stranger})
    server_->deliver(from, link::Annotation{ExecTime{}, "step", "{}"});
  EXPECT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(recorder_.annotations.size(), 1u);
  EXPECT_EQ(refusal(stranger).reason, link::Refusal::Reason::kBadMessage);
}

// ---- Status and messages while nothing moves.

// Of a reply, as the server sees it or as the SUT reports it.
TEST_F(CoordinatorTest, TransitIsNotSilence) {
  options_.hang_limit = seconds(3);
  for (const bool is_reported : {true, false}) {
    make();
    const auto peer = server_->add_sut(hello(), {read(Duration(0), kCamera)});
    const WallTime arrival = now_ + seconds(20);
    std::uint32_t bytes = 0;
    std::string blocked;
    server_->moved = [&] { return is_reported || now_ > arrival ? 0 : ++bytes; };
    hooks_.on_status = [&](const RunStatus& status) {
      if (now_ > arrival) return;
      blocked = status.blocked;
      if (is_reported) server_->deliver(peer, link::Progress{.received_bytes = ++bytes});
    };
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kSutHung) << "later";
    EXPECT_GT(report.wall, seconds(22));
    EXPECT_LT(report.wall, seconds(24));
    EXPECT_EQ(blocked.find("the rest of its reply") != std::string::npos, is_reported) << blocked;
  }
}

TEST_F(CoordinatorTest, TheStatusNamesTheSutThatBlocksTheRun) {
  options_.hang_limit = seconds(3);
  make();
  server_->add_sut(hello(), {sleep(Duration(0), milliseconds(5))});
  std::string first;
  SimTime st_before{};
  hooks_.on_status = [&](const RunStatus& status) {
    if (first.empty() && !status.blocked.empty()) {
      first = status.blocked;
      EXPECT_EQ(status.st, st_before);
    }
    st_before = status.st;
  };
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutHung);
  EXPECT_EQ(recorder_.interactions.size(), 1u);
  EXPECT_THAT(first, HasSubstr("(UAV \"uav0\"), which has been computing for 1.0 s"));
  EXPECT_THAT(report.reason, HasSubstr("3.0 s without a message; last message at ET 0.005000 s"));
}

TEST_F(CoordinatorTest, AJoinCountsAsAMove) {
  options_.connect_limit = seconds(3);
  make(2);
  std::optional<WallTime> added, joined, reported;
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.joined == 1 && !joined) joined = now_;
    if (!status.blocked.empty() && !reported) reported = now_;
    if (!added && now_ > WallTime(milliseconds(700))) {
      added = now_;
      add_silent(false, "uav1");
    }
  };
  run();
  ASSERT_TRUE(joined && reported);
  EXPECT_NEAR(to_seconds(*reported - *joined), 1.0, 0.1);
}

TEST_F(CoordinatorTest, ReportsTheStateOfALostSut) {
  options_.real_time_factor = 0.5;
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), seconds(5))});
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.st > st_ms(1'000)) server_->disconnect(peer);
  };
  EXPECT_THAT(run().reason, HasSubstr("waiting for its reply at ET 5.000000 s"));
}

// ---- Limits on calls, without which a SUT could keep a run from ending.

/// So many calls, each after `compute`, and the finish.
ScriptedServer::Script calls(std::size_t count, Duration compute) {
  ScriptedServer::Script script(count, turn(compute, 0.1));
  script.push_back(finish(compute));
  return script;
}

TEST_F(CoordinatorTest, CallsWithoutComputingTimeEndTheRunUnlessTheClientIsUnstamped) {
  tick_ = Duration(1000);
  EXPECT_EQ(run(calls(20'000, Duration(0))).end, RunEnd::kSutLost);
  EXPECT_EQ(recorder_.interactions.size(), kMaxCallsInAStep);
  make();
  server_->add_sut(hello("", computer::ClockKind::kUnstamped), calls(20'000, Duration(0)));
  EXPECT_EQ(run().end, RunEnd::kFinished) << "the clock of the coordinator charges each call";
}

TEST_F(CoordinatorTest, EachStepAllowsTheSameNumberOfCalls) {
  tick_ = Duration(1000);
  ScriptedServer::Script script;
  for (int i = 0; i < 3; ++i) {
    script.insert(script.end(), 9'000, turn(Duration(0), 0.1));
    script.push_back(turn(milliseconds(2), 0.1));
  }
  script.push_back(finish(Duration(0)));
  EXPECT_EQ(run(std::move(script)).end, RunEnd::kFinished);
}

}  // namespace
}  // namespace tether::coordinator
