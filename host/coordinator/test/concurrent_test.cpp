#include "coordinator_fixture.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/coordinator/coordinator.h>

// A SUT of several threads: calls beside each other, one ET for all.
namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

Act look(Duration compute, std::uint32_t sensor, bool latest = false) {
  return {compute, link::ReadSensor{sensor, latest, true}};
}

class ConcurrentTest : public CoordinatorTest {
 protected:
  RunReport run_threads(std::vector<Script> scripts, Duration overshoot = Duration(0)) {
    if (!coordinator_) make();
    server_->add_threads(hello(), std::move(scripts), overshoot);
    return coordinator_->run(*server_, hooks_);
  }
  /// A peer that says what the test has it say.
  link::PeerId add_silent(bool concurrent = true) {
    link::Hello h = hello();
    h.concurrent = concurrent;
    return server_->add_sut(h, {});
  }
  template <class Message>
  std::vector<Message> sent_to(link::PeerId peer) {
    std::vector<Message> found;
    for (const link::Message& message : server_->sent[peer])
      if (const auto* m = std::get_if<Message>(&message)) found.push_back(*m);
    return found;
  }
};

link::Request request(std::uint64_t sequence, ExecTime at, decltype(link::Request::body) body) {
  return {.sequence = sequence, .issued_at = at, .body = std::move(body)};
}

TEST_F(ConcurrentTest, IsToldAtOnceWhenItsReplyIsDue) {
  run_threads({{read(microseconds(2'300), kRange), finish(Duration(0))}});
  const auto& messages = server_->sent[1];
  const auto& due = std::get<link::Due>(messages.at(1));
  EXPECT_EQ(due.sequence, 1u);
  EXPECT_EQ(due.reply_at, us(100'000));
  const auto& reply = std::get<link::Reply>(messages.at(2));
  EXPECT_EQ(reply.resume_at, us(100'000));
  EXPECT_TRUE(reply.sample);
}

TEST_F(ConcurrentTest, OneThreadCommandsWhileAnotherWaitsForItsData) {
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
  // Each command's thread goes on where all of them stopped: 70 µs after its call.
  EXPECT_THAT(replies_us, ElementsAre(20'000, 40'070, 60'140, 80'210, 100'000, 100'280, 150'070));
  EXPECT_EQ(recorder_.interactions.at(4).sample_state_at, st_ms(2));
}

// One stop for each call, and one where a reply is due that was asked for earlier.
TEST_F(ConcurrentTest, StopsAreRecordedWithWhatTheyAreFor) {
  const RunReport report = run_threads(
      {{read(microseconds(2'300), kRange), finish(Duration(0))}, {turn(milliseconds(20), 0.1)}},
      microseconds(70));
  const auto& stops = recorder_.stops;
  ASSERT_EQ(stops.size(), 4u);
  EXPECT_EQ(stops[0].at, us(2'370));
  EXPECT_EQ(stops[0].reply_at, std::nullopt);
  EXPECT_EQ(stops[1].at, us(20'070));
  EXPECT_EQ(stops[1].reply_at, us(20'000));
  EXPECT_EQ(stops[2].at, us(100'070));
  EXPECT_EQ(stops[2].reply_at, us(100'000));
  EXPECT_EQ(stops[3].reply_at, us(100'070));
  EXPECT_EQ(report.stops, 4u);
  EXPECT_EQ(report.largest_overshoot, microseconds(70));
  EXPECT_EQ(recorder_.footer->stops, 4u);
  EXPECT_EQ(recorder_.footer->largest_overshoot, microseconds(70));
  EXPECT_TRUE(recorder_.header.suts.at(0).concurrent);
}

std::string without_wall(const MemoryRecorder& recorder) {
  std::string text;
  for (const auto& i : recorder.interactions) {
    text += std::to_string(i.sequence) + ":" + i.sensor;
    for (const std::int64_t v :
         {to_ns(i.request_at), to_ns(i.reply_at), to_ns(i.st_at_release),
          to_ns(i.sample_state_at.value_or(SimTime::min())),
          to_ns(i.effect_at.value_or(SimTime::min())), static_cast<std::int64_t>(i.sample_index)})
      text += " " + std::to_string(v);
    text += "\n";
  }
  for (const auto& stop : recorder.stops)
    text += std::to_string(to_ns(stop.at)) + " " +
            std::to_string(to_ns(stop.reply_at.value_or(ExecTime::min()))) + "\n";
  for (const auto& g : recorder.ground_truth) text += std::to_string(g.p_WB_m[0]) + "\n";
  return text;
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
          script.push_back(look(compute, sensor % 2, random.bits() % 2));
          break;
        default:
          script.push_back(read(compute, sensor, random.bits() % 2));
      }
    }
  }
  scripts[0].push_back(finish(seconds(1)));
  return scripts;
}

TEST_F(ConcurrentTest, TheSimulatorsSpeedMakesNoDifference) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    options_.real_time_factor = 0.0;
    recorder_ = {};
    make();
    ASSERT_EQ(run_threads(busy_threads(seed), microseconds(130)).end, RunEnd::kFinished);
    const std::string unhindered = without_wall(recorder_);
    options_.real_time_factor = 0.5;
    recorder_ = {};
    make();
    ASSERT_EQ(run_threads(busy_threads(seed), microseconds(130)).end, RunEnd::kFinished);
    EXPECT_EQ(without_wall(recorder_), unhindered);
  }
}

TEST_F(ConcurrentTest, WhenOneThreadFinishesTheOthersCallsAreDropped) {
  const RunReport report = run_threads({{sleep(Duration(0), seconds(9))},
                                        {read(milliseconds(2), kRange)},
                                        {finish(milliseconds(5))}});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_EQ(report.st, st_ms(5));
  EXPECT_EQ(report.interactions, 1u);
  EXPECT_EQ(recorder_.interactions.at(0).kind, record::kFinish);
  EXPECT_THAT(server_->closed, ElementsAre(1u));
}

TEST_F(ConcurrentTest, WhatAFinishDroppedIsNotAnsweredLater) {
  options_.policy = sync::SyncPolicy::kFreeRunning;
  options_.real_time_factor = 1.0;
  make(2);
  server_->add_threads(hello("uav0"),
                       {{read({}, kImu), read({}, kImu)}, {look({}, kCamera), finish({})}});
  server_->add_sut(hello("uav1"), {read({}, kImu), read({}, kImu), read({}, kImu), finish({})});
  EXPECT_EQ(coordinator_->run(*server_).end, RunEnd::kFinished);
  for (const auto& entry : recorder_.interactions)
    EXPECT_TRUE(entry.uav == "uav1" || entry.st_at_release < st_ms(50));
}

TEST_F(ConcurrentTest, WhatIsAskedAfterAFinishIsDropped) {
  make();
  const auto peer = add_silent();
  server_->deliver(peer, request(1, us(10), link::Finish{true, "", ""}));
  server_->deliver(peer, request(2, us(20), link::ReadSensor{kImu}));
  server_->deliver(peer, link::Progress{us(30), true});
  EXPECT_EQ(coordinator_->run(*server_).end, RunEnd::kFinished);
  EXPECT_EQ(recorder_.interactions.size(), 1u);
  EXPECT_EQ(sent_to<link::Due>(peer).size(), 1u);
}

TEST_F(ConcurrentTest, HasFinishedIfItLeavesWhileItStandsStillForIt) {
  for (const bool has_stopped : {true, false}) {
    make();
    const auto peer = add_silent();
    server_->deliver(peer, request(1, us(1'000'000), link::Finish{true, "", ""}));
    if (has_stopped) server_->deliver(peer, link::Progress{us(1'000'000), true});
    server_->disconnect(peer);
    EXPECT_EQ(coordinator_->run(*server_).end, has_stopped ? RunEnd::kFinished : RunEnd::kSutLost);
  }
}

TEST_F(ConcurrentTest, NoReplyLeavesBeforeItHasStopped) {
  options_.hang_limit = seconds(1);
  make();
  const auto peer = add_silent();
  server_->deliver(peer, request(1, us(10), link::SetVelocity{}));
  server_->deliver(peer, link::Progress{us(900)});
  EXPECT_EQ(coordinator_->run(*server_).end, RunEnd::kSutHung);
  EXPECT_TRUE(recorder_.interactions.empty());
}

// Standing still, it waits for us and owes no word.
TEST_F(ConcurrentTest, ASutThatStandsStillForAReplyIsNotHung) {
  options_.hang_limit = seconds(3);
  options_.real_time_factor = 0.001;
  const RunReport report =
      run_threads({{sleep(Duration(0), milliseconds(40)), finish(Duration(0))}});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_GE(report.wall, seconds(20));
}

// The camera's first measurement is there at 10.4 ms.
TEST_F(ConcurrentTest, LooksForWhatIsThereAndNeverWaits) {
  const Script script{look(microseconds(10'399), kCamera), look(microseconds(1), kCamera),
                      finish(Duration(0))};
  for (const bool concurrent : {false, true}) {
    recorder_ = {};
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

TEST_F(ConcurrentTest, InFreeRunningSeveralRequestsAreOpen) {
  options_.policy = sync::SyncPolicy::kFreeRunning;
  options_.real_time_factor = 1.0;
  const RunReport report =
      run_threads({{read({}, kCamera), read({}, kCamera), read({}, kCamera), finish({})},
                   {look({}, kCamera), read({}, kRange), read({}, kRange)},
                   {turn({}, 0.1)}});
  EXPECT_EQ(report.end, RunEnd::kFinished);
  EXPECT_TRUE(sent_to<link::Due>(1).empty());
  EXPECT_EQ(recorder_.interactions.size(), 8u);
  // The one that has to wait for its camera comes after all that need not.
  EXPECT_EQ(recorder_.interactions.at(6).sensor, "camera");
  EXPECT_EQ(recorder_.interactions.at(6).st_at_release, st_ms(66));
  const auto found_nothing =
      std::count_if(recorder_.interactions.begin(), recorder_.interactions.end(),
                    [](const auto& i) { return i.kind == record::kSensor && !i.sampled_at; });
  EXPECT_EQ(found_nothing, 1);
}

TEST_F(ConcurrentTest, BreaksOfTheProtocolEndTheRun) {
  const link::Request sleeper = request(1, us(50), link::Sleep{us(900)});
  const std::pair<link::Message, const char*> cases[] = {
      {link::Progress{us(10), true}, "a stop at ET 10000 ns, although it had reached 50000 ns"},
      {request(3, us(60), link::SetVelocity{}), "request number 3, expected 2"},
  };
  for (const auto& [message, text] : cases) {
    make();
    const auto peer = add_silent();
    server_->deliver(peer, sleeper);
    server_->deliver(peer, message);
    const RunReport report = coordinator_->run(*server_);
    EXPECT_EQ(report.end, RunEnd::kSutLost);
    EXPECT_THAT(report.reason, HasSubstr(text));
    EXPECT_THAT(refusal(peer).message, HasSubstr(text));
  }
}

// The other SUT's silence keeps ST, and so the reply, back.
TEST_F(ConcurrentTest, GoingOnBeforeItsReplyIsThereEndsTheRun) {
  const std::pair<link::Message, const char*> cases[] = {
      {request(2, us(2'950), link::SetVelocity{}),
       "stamped 2950000 ns while it was stopped for a reply at 2900000 ns"},
      {request(2, us(2'900), link::SetVelocity{}),
       "stamped 2900000 ns while it was stopped for a reply at 2900000 ns"},
      {request(2, us(2'850), link::SetVelocity{}),
       "stamped 2850000 ns while it was stopped for a reply at 2900000 ns"},
      {link::Progress{us(2'950), true},
       "a stop at ET 2950000 ns while it was stopped for a reply at 2900000 ns"},
  };
  for (const auto& [message, reason] : cases) {
    make(2);
    server_->add_sut(hello("uav1"), {});
    link::Hello threads = hello("uav0");
    threads.concurrent = true;
    const auto peer = server_->add_sut(threads, {});
    server_->deliver(peer, request(1, us(50), link::Sleep{us(2'900)}));
    server_->deliver(peer, link::Progress{us(2'900), true});
    server_->deliver(peer, message);
    EXPECT_THAT(coordinator_->run(*server_).reason, HasSubstr(reason));
  }
}

TEST_F(ConcurrentTest, AStampThatGoesBackIsCountedAndNamed) {
  make();
  const auto peer = add_silent();
  server_->deliver(peer, request(1, us(500), link::Sleep{us(90'000)}));
  server_->deliver(peer, request(2, us(400), link::Finish{true, "", ""}));
  server_->deliver(peer, link::Progress{us(500), true});
  EXPECT_EQ(coordinator_->run(*server_).causality_violations, 1u);
  EXPECT_EQ(recorder_.interactions.at(0).violation, "request in the past by 100000 ns");
}

TEST_F(ConcurrentTest, BesideASerialSut) {
  make(2);
  server_->add_sut(hello("uav0"), {turn(milliseconds(5), 1.0), read(milliseconds(1), kRange),
                                   finish(milliseconds(1))});
  server_->add_threads(hello("uav1"), busy_threads(3), microseconds(40));
  EXPECT_EQ(coordinator_->run(*server_).end, RunEnd::kFinished);
  EXPECT_TRUE(std::is_sorted(
      recorder_.interactions.begin(), recorder_.interactions.end(),
      [](const auto& a, const auto& b) { return a.st_at_release < b.st_at_release; }));
}

}  // namespace
}  // namespace tether::coordinator
