#include "coordinator_fixture.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/coordinator/coordinator.h>

// A SUT of several threads: parallel calls with one ET.
namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::EndsWith;

Act read_if_available(Duration compute, std::uint32_t sensor, bool latest = false) {
  return {compute, link::ReadSensor{sensor, latest, true}};
}

class ConcurrentTest : public CoordinatorTest {
 protected:
  RunReport run_threads(std::vector<Script> scripts, Duration overshoot = Duration(0)) {
    if (!coordinator_) make();
    server_->add_threads(hello(), std::move(scripts), overshoot);
    return run();
  }
  template <class Message>
  std::vector<Message> sent_to(link::PeerId peer) {
    std::vector<Message> found;
    for (const link::Message& message : server_->sent[peer])
      if (const auto* m = std::get_if<Message>(&message)) found.push_back(*m);
    return found;
  }
};

TEST_F(ConcurrentTest, ReceivesTheTimeOfItsReplyAtOnce) {
  run_threads({{read(microseconds(2'300), kRange), finish(Duration(0))}});
  const auto& messages = server_->sent[1];
  const auto& due = std::get<link::Due>(messages.at(1));
  EXPECT_EQ(due.sequence, 1u);
  EXPECT_EQ(due.reply_at, us(100'000));
  const auto& reply = std::get<link::Reply>(messages.at(2));
  EXPECT_EQ(reply.resume_at, us(100'000));
  EXPECT_TRUE(reply.sample);
}

TEST_F(ConcurrentTest, OneThreadSendsCommandsWhileAnotherWaitsForItsData) {
  Script commands;
  for (int i = 0; i < 5; ++i) commands.push_back(turn(milliseconds(20), 0.1 * i));
  const RunReport report = run_threads(
      {{read(microseconds(2'300), kRange), finish(milliseconds(50))}, commands}, microseconds(70));
  EXPECT_EQ(report.end, RunEnd::kFinished);
  std::vector<std::int64_t> replies_us;
  for (const auto& entry : recorder_.interactions) {
    replies_us.push_back(to_ns(entry.reply_at) / 1000);
    EXPECT_EQ(entry.st_at_release, StepGrid(milliseconds(1)).floor(same_instant(entry.reply_at)));
    EXPECT_FALSE(entry.violation);
  }
  // The thread of each command resumes at the stop: 70 µs after its call.
  EXPECT_THAT(replies_us, ElementsAre(20'000, 40'070, 60'140, 80'210, 100'000, 100'280, 150'070));
  EXPECT_EQ(recorder_.interactions.at(4).sample_state_at, st_ms(2));
}

// One stop for each call, and one for the reply of an earlier call.
TEST_F(ConcurrentTest, RecordsEachStopWithTheReplyThatCausedIt) {
  const RunReport report = run_threads(
      {{read(microseconds(2'300), kRange), finish(Duration(0))}, {turn(milliseconds(20), 0.1)}},
      microseconds(70));
  std::vector<std::pair<ExecTime, std::optional<ExecTime>>> stops;
  for (const auto& stop : recorder_.stops) stops.emplace_back(stop.at, stop.reply_at);
  EXPECT_THAT(
      stops, ElementsAre(std::pair(us(2'370), std::nullopt), std::pair(us(20'070), us(20'000)),
                         std::pair(us(100'070), us(100'000)), std::pair(us(100'140), us(100'070))));
  EXPECT_EQ(report.stops, 4u);
  EXPECT_EQ(report.largest_overshoot, microseconds(70));
  EXPECT_EQ(recorder_.footer->stops, 4u);
  EXPECT_EQ(recorder_.footer->largest_overshoot, microseconds(70));
  EXPECT_TRUE(recorder_.header.suts.at(0).concurrent);
}

std::vector<Script> busy_threads(std::uint64_t seed) {
  KeyedRandom random({.seed = seed});
  std::vector<Script> scripts(1 + random.bits() % 5);
  for (Script& script : scripts) {
    for (int i = 0; i < 60; ++i) {
      const Duration compute = microseconds(random.bits() % 9'000);
      const auto sensor = static_cast<std::uint32_t>(random.bits() % 3);
      switch (random.bits() % 4) {
        case 0:
          script.push_back(turn(compute, random.uniform() - 0.5));
          break;
        case 1:
          script.push_back(sleep(compute, microseconds(random.bits() % 30'000)));
          break;
        case 2:
          script.push_back(read_if_available(compute, sensor % 2, random.bits() % 2));
          break;
        default:
          script.push_back(read(compute, sensor, random.bits() % 2));
      }
    }
  }
  scripts[0].push_back(finish(seconds(1)));
  return scripts;
}

TEST_F(ConcurrentTest, TheSpeedOfTheSimulatorDoesNotChangeTheRecord) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const auto fly = [&](double real_time_factor) {
      options_.real_time_factor = real_time_factor;
      make();
      EXPECT_EQ(run_threads(busy_threads(seed), microseconds(130)).end, RunEnd::kFinished);
      return without_wall(recorder_);
    };
    EXPECT_EQ(fly(0.0), fly(0.5));
  }
}

// Whatever is read when, and by how many threads.
TEST_F(ConcurrentTest, PicturesAreAnnouncedWithTheStateOfTheirInstant) {
  std::size_t announced = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    make();
    run_threads(busy_threads(seed), microseconds(130));
    for (const auto& picture : simulator_->expected()) {
      EXPECT_EQ(picture.sensor, kCamera);
      EXPECT_EQ(
          picture.at,
          StepGrid(milliseconds(1)).floor(uav::sampling_instant(kCameraTiming, picture.index)));
    }
    announced += simulator_->expected().size();
  }
  EXPECT_GT(announced, 50u);
}

TEST_F(ConcurrentTest, TheFinishOfOneThreadDropsTheCallsOfTheOthers) {
  const RunReport report = run_threads({{sleep(Duration(0), seconds(9))},
                                        {read(milliseconds(2), kRange)},
                                        {finish(milliseconds(5))}});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_EQ(report.st, st_ms(5));
  EXPECT_EQ(report.interactions, 1u);
  EXPECT_EQ(recorder_.interactions.at(0).kind, record::kFinish);
  EXPECT_THAT(server_->closed, ElementsAre(1u));
}

TEST_F(ConcurrentTest, DroppedCallsAreNotAnsweredLater) {
  set_free_running(1.0);
  make(2);
  server_->add_threads(hello("uav0"), {{read({}, kImu), read({}, kImu)},
                                       {read_if_available({}, kCamera), finish({})}});
  server_->add_sut(hello("uav1"), {read({}, kImu), read({}, kImu), read({}, kImu), finish({})});
  EXPECT_EQ(run().end, RunEnd::kFinished);
  for (const auto& entry : recorder_.interactions)
    EXPECT_TRUE(entry.uav == "uav1" || entry.st_at_release < st_ms(50));
}

TEST_F(ConcurrentTest, DropsRequestsAfterAFinish) {
  make();
  const auto peer = add_silent(true);
  server_->deliver(peer, request(1, us(10), link::Finish{true, "", ""}));
  server_->deliver(peer, request(2, us(20), link::ReadSensor{kImu}));
  server_->deliver(peer, link::Progress{us(30), true});
  EXPECT_EQ(run().end, RunEnd::kFinished);
  EXPECT_EQ(recorder_.interactions.size(), 1u);
  EXPECT_EQ(sent_to<link::Due>(peer).size(), 1u);
}

TEST_F(ConcurrentTest, IsFinishedOnceItIsStoppedForItsFinish) {
  for (const bool has_stopped : {true, false}) {
    make();
    const auto peer = add_silent(true);
    server_->deliver(peer, request(1, us(1'000'000), link::Finish{true, "", ""}));
    if (has_stopped) server_->deliver(peer, link::Progress{us(1'000'000), true});
    server_->disconnect(peer);
    EXPECT_EQ(run().end, has_stopped ? RunEnd::kFinished : RunEnd::kSutLost);
  }
}

TEST_F(ConcurrentTest, SendsNoReplyBeforeTheStop) {
  options_.hang_limit = seconds(1);
  make();
  const auto peer = add_silent(true);
  server_->deliver(peer, request(1, us(10), link::SetVelocity{}));
  server_->deliver(peer, link::Progress{us(900)});
  EXPECT_EQ(run().end, RunEnd::kSutHung);
  EXPECT_TRUE(recorder_.interactions.empty());
}

TEST_F(ConcurrentTest, IsNotHungWhileItIsStoppedForAReply) {
  options_.hang_limit = seconds(3);
  options_.real_time_factor = 0.001;
  const RunReport report =
      run_threads({{sleep(Duration(0), milliseconds(40)), finish(Duration(0))}});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_GE(report.wall, seconds(20));
}

// The first measurement of the camera is available at 10.4 ms.
TEST_F(ConcurrentTest, ReadsIfAvailableDoNotWait) {
  const Script script{read_if_available(microseconds(10'399), kCamera),
                      read_if_available(microseconds(1), kCamera), finish(Duration(0))};
  for (const bool concurrent : {false, true}) {
    make();
    concurrent ? run_threads({script}) : run(script);
    const auto& log = recorder_.interactions;
    EXPECT_EQ(log.at(0).reply_at, us(10'399));
    EXPECT_EQ(log.at(1).reply_at, us(10'400));
    for (const std::size_t i : {0u, 1u}) {
      EXPECT_TRUE(log.at(i).only_if_available);
      EXPECT_EQ(log.at(i).sampled_at.has_value(), i == 1);
      EXPECT_EQ(sent_to<link::Reply>(1).at(i).sample.has_value(), i == 1);
    }
  }
}

// By 100 ms, measurements 0 to 2 are available, and 3 at 109.4 ms.
TEST_F(ConcurrentTest, WhatIsSkippedIsNotReadAnyMore) {
  const Act skip{milliseconds(100), link::ReadSensor{.sensor = kCamera, .queue = 9, .skips = true}};
  const Act again{{}, link::ReadSensor{.sensor = kCamera, .queue = 9, .skips = true}};
  run({skip, again, {{}, link::ReadSensor{.sensor = kCamera, .queue = 9}}, finish({})});
  const auto& log = recorder_.interactions;
  EXPECT_EQ(log.at(0).reply_at, us(100'000));
  EXPECT_EQ(log.at(0).skipped_to, 2U);
  EXPECT_FALSE(log.at(0).sampled_at);
  EXPECT_FALSE(sent_to<link::Reply>(1).at(0).sample);
  EXPECT_FALSE(log.at(1).skipped_to) << "there is nothing more";
  EXPECT_EQ(log.at(2).sample_index, 3U);
  EXPECT_EQ(log.at(2).reply_at, us(109'400));
}

TEST_F(ConcurrentTest, SeveralRequestsAreOpenInFreeRunning) {
  set_free_running(1.0);
  const RunReport report =
      run_threads({{read({}, kCamera), read({}, kCamera), read({}, kCamera), finish({})},
                   {read_if_available({}, kCamera), read({}, kRange), read({}, kRange)},
                   {turn({}, 0.1)}});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_TRUE(sent_to<link::Due>(1).empty());
  EXPECT_EQ(recorder_.interactions.size(), 8u);
  // The read that waits for its camera is answered last.
  EXPECT_EQ(recorder_.interactions.at(6).sensor, "camera");
  EXPECT_EQ(recorder_.interactions.at(6).st_at_release, st_ms(66));
  const auto empty_reads =
      std::count_if(recorder_.interactions.begin(), recorder_.interactions.end(),
                    [](const auto& i) { return i.kind == record::kSensor && !i.sampled_at; });
  EXPECT_EQ(empty_reads, 1);
}

// The other SUT sends nothing, so ST does not reach the time of the reply.
TEST_F(ConcurrentTest, ContinuingBeforeItsReplyEndsTheRun) {
  std::vector<link::Message> messages{link::Progress{us(2'950), true}};
  for (const ExecTime at : {us(2'850), us(2'900), us(2'950)})
    messages.push_back(request(2, at, link::SetVelocity{}));
  for (const link::Message& message : messages) {
    make(2);
    add_silent(false, "uav1");
    const auto peer = add_silent(true, "uav0");
    server_->deliver(peer, request(1, us(50), link::Sleep{us(2'900)}));
    server_->deliver(peer, link::Progress{us(2'900), true});
    server_->deliver(peer, message);
    EXPECT_THAT(run().reason, EndsWith(" while it was stopped for a reply at 2900000 ns"));
  }
}

TEST_F(ConcurrentTest, SharesTheTimeOfASerialSut) {
  make(2);
  server_->add_sut(hello("uav0"), {turn(milliseconds(5), 1.0), read(milliseconds(1), kRange),
                                   finish(milliseconds(1))});
  server_->add_threads(hello("uav1"), busy_threads(3), microseconds(40));
  EXPECT_EQ(run().end, RunEnd::kFinished);
  EXPECT_TRUE(
      std::ranges::is_sorted(recorder_.interactions, {}, &record::Interaction::st_at_release));
}

}  // namespace
}  // namespace tether::coordinator
