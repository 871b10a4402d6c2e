#include "coordinator_fixture.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/radio/medium.h>

// Messages between UAVs: the rules of time hold for them as for samples and commands.
namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class RadioTest : public CoordinatorTest {
 protected:
  // "uav1", "uav2", …
  RunReport run_all(std::vector<Script> scripts) {
    make(scripts.size());
    for (std::size_t i = 0; i < scripts.size(); ++i)
      server_->add_sut(hello(name_of(i)), std::move(scripts[i]));
    return run();
  }
  void set_channel() {
    options_.radio.model = radio::Model::kLogDistance;
    options_.radio.slot = microseconds(9);
  }
};

TEST_F(RadioTest, AMessageIsReceivedAtTheInstantOfItsSending) {
  const RunReport report = run_all({{send(microseconds(2'345)), finish(milliseconds(50))},
                                    {receive(microseconds(100), milliseconds(20)), finish({})}});
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  const auto replies = replies_to(2);
  ASSERT_TRUE(replies.at(0).message);
  EXPECT_EQ(replies[0].resume_at, us(2'345));
  EXPECT_EQ(replies[0].message->from, name_of(0));
  EXPECT_EQ(replies[0].message->sent_at, same_instant(us(2'345)));
  EXPECT_EQ(replies[0].message->arrived_at, same_instant(us(2'345)));
  EXPECT_THAT(replies[0].message->bytes, testing::SizeIs(10));
}

TEST_F(RadioTest, AReceiveWithoutAMessageEndsAtItsTimeout) {
  run_all({{finish(milliseconds(50))},
           {receive(microseconds(100), microseconds(3'400)), receive({}, {}), finish({})}});
  const auto replies = replies_to(2);
  EXPECT_FALSE(replies.at(0).message);
  EXPECT_EQ(replies[0].resume_at, us(3'500));
  EXPECT_FALSE(replies.at(1).message);
  EXPECT_EQ(replies[1].resume_at, us(3'500));
}

// Of the camera: sampled at 33 ms, available 10.4 ms later; the first one at once.
TEST_F(RadioTest, AWaitForASensorEndsWhenItsMeasurementIsAvailable) {
  const auto receive_or = [](Duration timeout) {
    return Act{{}, link::ReceiveMessage{timeout, {kCamera}}};
  };
  run_all({{finish(milliseconds(90))},
           {receive_or(milliseconds(5)), receive_or(milliseconds(50)), receive_or({}),
            read({}, kCamera), receive_or(milliseconds(50)), finish({})}});
  const auto replies = replies_to(2);
  EXPECT_EQ(replies.at(0).resume_at, us(5'000)) << "the timeout is earlier";
  EXPECT_EQ(replies.at(1).resume_at, us(10'400));
  EXPECT_EQ(replies.at(2).resume_at, us(10'400)) << "still there";
  EXPECT_EQ(replies.at(3).resume_at, us(10'400));
  EXPECT_EQ(replies.at(4).resume_at, us(43'400));
  EXPECT_FALSE(replies.at(4).message);
}

// Long before its timeout. What the camera had by then is still there.
TEST_F(RadioTest, AReadAfterAMessageGetsWhatWasAvailableThen) {
  const RunReport report = run_all(
      {{send(milliseconds(40)), finish(milliseconds(50))},
       {receive(microseconds(100), std::chrono::seconds(1)), read({}, kCamera), finish({})}});
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  const auto replies = replies_to(2);
  ASSERT_TRUE(replies.at(1).sample);
  EXPECT_EQ(replies.at(1).resume_at, us(40'000));
  EXPECT_EQ(std::get<uav::CameraSample>(*replies.at(1).sample).index, 0U);
}

TEST_F(RadioTest, AMessageEndsAWaitForASensor) {
  run_all({{send(microseconds(2'345)), finish(milliseconds(50))},
           {{{}, link::ReceiveMessage{milliseconds(20), {kCamera}}}, finish({})}});
  EXPECT_TRUE(replies_to(2).at(0).message);
  EXPECT_EQ(replies_to(2)[0].resume_at, us(2'345));
}

TEST_F(RadioTest, AMessageWaitsForItsReceiver) {
  run_all(
      {{send(microseconds(10)), send(microseconds(10)), finish(milliseconds(1))},
       {receive(milliseconds(9), {}), receive({}, milliseconds(9)), receive({}, {}), finish({})}});
  const auto replies = replies_to(2);
  EXPECT_EQ(replies.at(0).message->arrived_at, same_instant(us(10)));
  EXPECT_EQ(replies.at(1).message->arrived_at, same_instant(us(20)));
  EXPECT_EQ(replies[1].resume_at, us(9'000));
  EXPECT_FALSE(replies.at(2).message);
}

TEST_F(RadioTest, MessagesOfOneInstantAreOrderedBySenderAndSequence) {
  run_all({{receive(milliseconds(5), {}), receive({}, {}), receive({}, {}), finish({})},
           {send(milliseconds(1)), send({}), finish({})},
           {send(milliseconds(1)), finish({})}});
  std::vector<std::string> order;
  for (const record::Interaction& entry : recorder_.interactions)
    if (entry.received)
      order.push_back(entry.received->from + " " + std::to_string(entry.received->sequence));
  EXPECT_THAT(order, ElementsAre(name_of(1) + " 1", name_of(1) + " 2", name_of(2) + " 1"));
}

TEST_F(RadioTest, ByDistributionMessagesOvertakeAndAreReceivedWhenTheyArrive) {
  options_.radio.model = radio::Model::kDistribution;
  options_.radio.data_rate_bit_s = 0.0;
  options_.radio.delay = microseconds(100);
  options_.radio.drawn_delay = uav::EmpiricalDelay{{microseconds(250), milliseconds(4)}};
  options_.radio.loss_probability = 0.2;
  constexpr int kMessages = 40;
  Script sender(kMessages, send(milliseconds(1)));
  sender.push_back(finish({}));
  Script receiver(kMessages, receive({}, milliseconds(20)));
  receiver.push_back(finish({}));
  ASSERT_EQ(run_all({std::move(sender), std::move(receiver)}).end, RunEnd::kFinished);
  std::vector<std::uint64_t> received;
  for (const record::Interaction& entry : recorder_.interactions) {
    if (!entry.received) continue;
    EXPECT_EQ(entry.reply_at, std::max(entry.request_at, same_instant(entry.received->arrived_at)));
    received.push_back(entry.received->sequence);
  }
  int dropped = 0;
  for (const record::RadioMessage& entry : recorder_.radio) {
    const Duration delay = entry.at - entry.sent_at;
    EXPECT_TRUE(delay == microseconds(350) || delay == microseconds(4'100)) << delay.count();
    EXPECT_FALSE(entry.began_at || entry.distance_m || entry.snr_db);
    dropped += entry.outcome == "dropped" ? 1 : 0;
  }
  EXPECT_FALSE(std::ranges::is_sorted(received));
  EXPECT_NEAR(dropped, 8, 7);
  EXPECT_EQ(received.size() + static_cast<std::size_t>(dropped), std::size_t{kMessages});
  EXPECT_EQ(recorder_.header.radio.model, "distribution");
}

TEST_F(RadioTest, TheRecordHasEachMessageAtEachReceiver) {
  set_channel();
  run_all({{send(milliseconds(1)), finish(milliseconds(20))},
           {finish(milliseconds(20))},
           {finish(milliseconds(20))}});
  ASSERT_THAT(recorder_.radio, testing::SizeIs(2));
  const record::RadioMessage& entry = recorder_.radio[0];
  EXPECT_EQ(entry.uav, name_of(0));
  EXPECT_EQ(entry.sequence, 1u);
  EXPECT_EQ(entry.to, name_of(1));
  EXPECT_EQ(entry.bytes, 10u);
  EXPECT_EQ(entry.sent_at, st_ms(1));
  EXPECT_EQ(entry.outcome, record::kDelivered);
  EXPECT_EQ(entry.at, *entry.began_at + radio::air_time(options_.radio, 10));
  EXPECT_TRUE(entry.distance_m && entry.walls && entry.snr_db);
  EXPECT_EQ(recorder_.header.radio.model, "log_distance");
}

TEST_F(RadioTest, WhatIsSentAfterTheEndIsNotInTheRecord) {
  for (const bool is_in_step : {true, false}) {
    make(2);
    server_->add_sut(hello(name_of(0)), {send(microseconds(is_in_step ? 300 : 5'300))});
    const link::PeerId lost = add_silent(false, name_of(1));
    hooks_.should_stop = [&, polls = 0]() mutable -> std::optional<Ending> {
      if (++polls == 5) server_->disconnect(lost);
      return std::nullopt;
    };
    EXPECT_EQ(run().end, RunEnd::kSutLost);
    EXPECT_EQ(recorder_.footer->st_at_end, st_ms(0));
    ASSERT_EQ(recorder_.radio.size(), is_in_step ? 1u : 0u) << "ST is 0 ms at the end";
    for (const record::RadioMessage& message : recorder_.radio)
      EXPECT_EQ(message.at, same_instant(us(300))) << "not before it was sent";
  }
}

TEST_F(RadioTest, WhatIsStillInTransitAtTheEndIsInTheRecord) {
  options_.radio.delay = std::chrono::seconds(5);
  run_all({{send(milliseconds(1)), finish({})}, {finish({})}});
  ASSERT_THAT(recorder_.radio, testing::SizeIs(1));
  EXPECT_EQ(recorder_.radio[0].outcome, "waiting");
}

TEST_F(RadioTest, AFullInboxLosesTheNewest) {
  options_.radio.inbox_messages = 2;
  run_all({{send({}), send({}), send({}), finish({})}, {finish(milliseconds(9))}});
  std::vector<std::string> outcomes;
  for (const auto& entry : recorder_.radio) outcomes.push_back(entry.outcome);
  EXPECT_THAT(outcomes, ElementsAre("delivered", "delivered", "inbox_full"));
}

TEST_F(RadioTest, AFlooderLosesItsSessionAndTheOthersFinish) {
  struct Flood {
    int pause_us;
    std::size_t bytes;
    bool has_channel;
  };
  // All in one step; while the queue is full; while it has room now and then; with an ideal radio.
  for (const auto& [pause_us, bytes, has_channel] : std::initializer_list<Flood>{
           {0, 60'000, true}, {2, 60'000, true}, {100, 1'000, true}, {50, 60'000, false}}) {
    options_.radio = {};
    if (has_channel) set_channel();
    options_.radio.queue_messages = 2;
    std::vector<Act> flood(4'000, send(microseconds(pause_us), "", bytes));
    const RunReport report = run_all({flood, {finish(milliseconds(300))}});
    EXPECT_EQ(report.end, RunEnd::kFlooded);
    EXPECT_THAT(report.reason, HasSubstr(name_of(0)));
    EXPECT_TRUE(report.suts.at(1).finish) << "the other one is unharmed";
    EXPECT_THAT(recorder_.footer.value().expelled, ElementsAre(name_of(0)));
    EXPECT_EQ(refusal(1).reason, link::Refusal::Reason::kBadRequest);
    EXPECT_LT(recorder_.radio.size(), flood.size());
  }
}

TEST_F(RadioTest, AMessageToNobodyIsAFault) {
  for (const std::string& to : {std::string("nobody"), std::string("self")}) {
    make(2);
    server_->add_sut(hello(name_of(0)), {send({}, to == "self" ? name_of(0) : to)});
    server_->add_sut(hello(name_of(1)), {finish(milliseconds(1))});
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kSutLost);
    EXPECT_THAT(report.reason, HasSubstr("no other UAV"));
  }
  EXPECT_EQ(run_all({{send({})}}).end, RunEnd::kSutLost) << "to all others, of which there is none";
}

TEST_F(RadioTest, FreeRunningDeliversToo) {
  set_free_running(1.0);
  const RunReport report = run_all({{receive({}, milliseconds(5)), send({}), finish({})},
                                    {receive({}, milliseconds(500)), finish({})}});
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  EXPECT_FALSE(replies_to(1).at(0).message);
  EXPECT_TRUE(replies_to(2).at(0).message);
}

// Whatever the order in which requests reach the coordinator, each SUT receives the same.
TEST_F(RadioTest, SchedulesDoNotMatter) {
  for (const bool has_channel : {false, true}) {
    for (std::uint64_t program = 1; program <= 20; ++program) {
      std::string first;
      for (std::uint64_t schedule = 1; schedule <= 4; ++schedule) {
        options_.radio = {};
        if (has_channel) set_channel();
        if (has_channel && program % 2) options_.radio.access = radio::Access::kTdma;
        if (has_channel && program % 2) options_.radio.slot = milliseconds(1);
        KeyedRandom random({.seed = program});
        const std::size_t suts = 2 + random.bits() % 3;
        std::vector<Script> scripts(suts);
        for (Script& script : scripts) {
          for (int k = 0; k < 60; ++k) {
            const Duration compute = microseconds(50) * (random.bits() % 40);
            const Duration timeout = microseconds(50) * (random.bits() % 60);
            const std::uint32_t kind = random.bits() % 4;
            if (kind == 0) script.push_back(send(compute, "", random.bits() % 300));
            if (kind == 1) script.push_back(receive(compute, timeout));
            if (kind == 2) script.push_back(sleep(compute, timeout));
            if (kind == 3) script.push_back(turn(compute, 0.1));
          }
          script.push_back(finish({}));
        }
        make(suts);
        for (std::size_t i = 0; i < suts; ++i) server_->add_sut(hello(name_of(i)), scripts[i]);
        KeyedRandom order({.seed = schedule, .stream = 1});
        server_->choose = [&](std::size_t waiting) { return order.bits() % waiting; };
        ASSERT_EQ(run().end, RunEnd::kFinished);
        std::string heard;
        for (const record::Interaction& i : recorder_.interactions)
          heard += i.uav + " " + i.kind + std::to_string(to_ns(i.reply_at)) +
                   (i.received ? i.received->from + std::to_string(i.received->sequence) : "") +
                   "\n";
        for (const record::RadioMessage& m : recorder_.radio)
          heard += m.uav + m.to + m.outcome + std::to_string(to_ns(m.at)) + "\n";
        if (first.empty()) first = heard;
        ASSERT_EQ(heard, first) << "program " << program << ", schedule " << schedule;
      }
    }
  }
}

TEST_F(RadioTest, AConcurrentSutStopsForAMessage) {
  make(2);
  server_->add_threads(hello(name_of(0)),
                       {{receive(microseconds(100), milliseconds(50)), finish(milliseconds(1))},
                        {sleep({}, milliseconds(7)), sleep({}, milliseconds(70))}},
                       microseconds(30));
  server_->add_sut(hello(name_of(1)), {send(microseconds(5'250)), finish(milliseconds(100))});
  const RunReport report = run();
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  const auto replies = replies_to(1);
  ASSERT_TRUE(replies.at(0).message);
  EXPECT_EQ(replies[0].resume_at, us(5'250));
  EXPECT_TRUE(std::ranges::any_of(recorder_.stops, [](const record::Stop& stop) {
    return stop.at >= us(5'250) && stop.at < us(8'000);
  }));
}

// The first stop had not heard that a message moved the reply up: it resumes without it.
TEST_F(RadioTest, AStopNamesOnlyRepliesThatItKnewOf) {
  make(2);
  const link::PeerId threads = add_silent(true, name_of(0));
  const link::PeerId sender =
      server_->add_sut(hello(name_of(1)), {send(milliseconds(1)), finish(milliseconds(50))});
  const auto say = [&](std::int64_t at_us, bool stopped, std::uint64_t dues_heard, int times = 1) {
    for (int i = 0; i < times; ++i)
      server_->deliver(threads, link::Progress{us(at_us), stopped, 0, dues_heard});
  };
  server_->deliver(threads, request(1, us(100), link::ReceiveMessage{milliseconds(100)}));
  say(100, true, 0);
  say(2'000, false, 1, 20);
  say(2'500, true, 1);
  say(2'600, false, 1);
  say(3'000, true, 2);
  server_->deliver(threads, request(2, us(3'000), link::Finish{true, "done", "{}"}));
  say(3'000, true, 3);
  server_->choose = [&](std::size_t) { return server_->first_of(sender); };
  const RunReport report = run();
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  ASSERT_GE(recorder_.stops.size(), 3U);
  EXPECT_EQ(recorder_.stops[1].at, us(2'500));
  EXPECT_EQ(recorder_.stops[1].reply_at, std::nullopt);
  EXPECT_EQ(recorder_.stops[2].at, us(3'000));
  EXPECT_EQ(recorder_.stops[2].reply_at, us(1'000));
}

// A message that arrives while the SUT is stopped for the reply's timeout moves that reply up, and
// the SUT reports its stop again.
TEST_F(RadioTest, AStopThatIsReportedAgainIsOneStop) {
  make(2);
  const link::PeerId threads = add_silent(true, name_of(0));
  const link::PeerId sender =
      server_->add_sut(hello(name_of(1)), {send(microseconds(700)), finish(milliseconds(50))});
  server_->deliver(threads, request(1, us(100), link::ReceiveMessage{microseconds(900)}));
  for (const std::uint64_t dues_heard : {1U, 2U})
    server_->deliver(threads, link::Progress{us(1'000), true, 0, dues_heard});
  server_->deliver(threads, request(2, us(1'100), link::Finish{true, "done", "{}"}));
  server_->deliver(threads, link::Progress{us(1'200), true, 0, 3});
  // Both join; then the receive and its stop arrive before the message.
  std::size_t picks = 0;
  server_->choose = [&](std::size_t) {
    return server_->first_of(picks++ == 1 || picks > 4 ? sender : threads);
  };
  const RunReport report = run();
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  ASSERT_TRUE(replies_to(threads).at(0).message);
  EXPECT_EQ(replies_to(threads)[0].resume_at, us(700));
  ASSERT_EQ(recorder_.stops.size(), 2U);
  EXPECT_EQ(recorder_.stops[0].at, us(1'000));
  EXPECT_EQ(recorder_.stops[0].reply_at, us(1'000));
}

}  // namespace
}  // namespace tether::coordinator
