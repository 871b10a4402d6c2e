#include "controller_links.h"

#include "controller_fixture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

// Flight controllers and their companions: when a message acts, and what is lost.
namespace tether::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Line, TakesTenBitsForAByteAndHasRoomForASecond) {
  Line line(1'000.0, milliseconds(5));
  EXPECT_EQ(line.send(st_ms(0), 10), st_ms(105));
  EXPECT_EQ(line.send(st_ms(1), 10), st_ms(205)) << "after the first one";
  EXPECT_EQ(line.send(st_ms(500), 10), st_ms(605)) << "it was free";
  EXPECT_EQ(line.send(st_ms(500), 101), st_ms(1'615));
  EXPECT_EQ(line.send(st_ms(500), 1), std::nullopt) << "1.11 s are waiting";
  EXPECT_EQ(line.send(st_ms(610), 1), st_ms(1'625));
  EXPECT_EQ(Line(0.0, milliseconds(2)).send(st_ms(7), 1'000'000), st_ms(9));
}

/// Measures twice when it boots, and at each step.
class Measuring final : public autopilot::FlightController {
 public:
  explicit Measuring(std::vector<std::uint64_t>& indices) : indices_(&indices) {}
  void boot(const autopilot::Sensed& at_rest) override {
    EXPECT_EQ(at_rest.at, SimTime{});
    for (int i = 0; i < 2; ++i) measure(at_rest);
  }
  autopilot::Actions step(const autopilot::Sensed& sensed,
                          const std::vector<autopilot::Bytes>&) override {
    measure(sensed);
    return {};
  }

 private:
  void measure(const autopilot::Sensed& sensed) {
    const auto sample = sensed.measure(uav::SensorKind::kImu);
    indices_->push_back(std::visit([](const auto& content) { return content.index; }, *sample));
  }
  std::vector<std::uint64_t>* indices_;
};

TEST_F(ControllerLinksTest, AControllerBootsByItsSensorsEachTimeWithOtherNoise) {
  std::vector<std::uint64_t> indices;
  make_links(1, {});
  options_.uavs[0].controller->make = [&] { return std::make_unique<Measuring>(indices); };
  remake();
  ASSERT_EQ(indices.size(), 2U) << "before the flight";
  run({finish(milliseconds(9))});
  ASSERT_GE(indices.size(), 5U);
  const std::set<std::uint64_t> all(indices.begin(), indices.end());
  EXPECT_EQ(all.size(), indices.size());
}

TEST_F(ControllerLinksTest, AMessageActsAtTheFirstStepAfterItsArrival) {
  make_links(1, {});
  ASSERT_EQ(run({to_controller(microseconds(3'999), 1), to_controller(microseconds(1), 2),
                 to_controller(Duration(1), 3), finish(milliseconds(20))})
                .end,
            RunEnd::kFinished);
  ASSERT_EQ(numbers_taken(0), (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(taken_[0][0].at, st_ms(4));
  EXPECT_EQ(taken_[0][1].at, st_ms(4)) << "sent at the boundary itself";
  EXPECT_EQ(taken_[0][2].at, st_ms(8));
}

TEST_F(ControllerLinksTest, ARoundTripIsAStepAndTheLatencies) {
  make_links(1, {.latency = microseconds(1'500), .own = 0});
  const RunReport report =
      run({to_controller(microseconds(2'500), 9), receive({}, milliseconds(50)), finish({})});
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  const link::Reply reply = replies_to(1).at(1);
  ASSERT_TRUE(reply.message);
  EXPECT_EQ(reply.message->from, link::kAutopilot);
  EXPECT_EQ(number_of(reply.message->bytes), kEcho + 9);
  EXPECT_EQ(reply.message->sent_at, st_ms(4) + Duration(1));
  EXPECT_EQ(reply.resume_at, us(5'500) + Duration(1));
}

TEST_F(ControllerLinksTest, OneReplyHasWhatArrivesAtAnInstant) {
  make_links(1, {.own = 3});
  const RunReport report =
      run({receive(milliseconds(1), milliseconds(5), 9), receive({}, milliseconds(5), 2),
           receive({}, Duration(0), 9), receive(milliseconds(7), Duration(0), 9), finish({})});
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  std::vector<std::vector<std::uint64_t>> received;
  for (const link::Reply& reply : replies_to(1)) {
    if (!reply.message) continue;
    received.push_back({number_of(reply.message->bytes)});
    for (const link::RadioMessage& m : reply.more) received.back().push_back(number_of(m.bytes));
  }
  EXPECT_THAT(received, ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5), ElementsAre(6),
                                    ElementsAre(7, 8, 9)));
  EXPECT_EQ(recorder_.interactions.at(0).received_more, 2U);
  EXPECT_EQ(recorder_.interactions.at(2).received_more, 0U);
}

TEST_F(ControllerLinksTest, WhatItFollowsHoldsFromItsStepOn) {
  make_links(1, {});
  run({to_controller(microseconds(4'100), 1), finish(milliseconds(20))});
  const auto first = std::ranges::find_if(simulator_->applied(), [](const auto& applied) {
    return applied.setpoint.velocity_m_s.x > 0.0;
  });
  ASSERT_NE(first, simulator_->applied().end());
  EXPECT_EQ(first->at, st_ms(8));
  EXPECT_TRUE(recorder_.commands.empty());
}

TEST_F(ControllerLinksTest, TheRecordHasEveryMessage) {
  make_links(1, {.latency = milliseconds(1)});
  run({to_controller(milliseconds(2), 1, 20), receive({}, milliseconds(9)),
       to_controller(milliseconds(9), 2), finish({})});
  std::size_t to = 0, from = 0;
  for (const record::AutopilotMessage& m : recorder_.autopilot) {
    EXPECT_EQ(m.uav, name_of(0));
    ++(m.to_controller ? to : from);
    if (m.to_controller && m.sequence == 1) {
      EXPECT_EQ(m.bytes, 20U);
      EXPECT_EQ(m.sent_at, st_ms(2));
      EXPECT_EQ(m.at, st_ms(3));
      EXPECT_EQ(m.acted_at, st_ms(4));
      EXPECT_EQ(m.outcome, record::kDelivered);
    }
    if (m.to_controller && m.sequence == 3) {
      EXPECT_EQ(m.outcome, record::kWaiting);
    }
  }
  EXPECT_EQ(to, 2U);
  EXPECT_GE(from, 3U);
  ASSERT_TRUE(recorder_.header.suts.at(0).controller);
  EXPECT_EQ(recorder_.header.suts[0].controller->name, "echo");
  EXPECT_EQ(recorder_.header.suts[0].controller->link_latency, milliseconds(1));
}

/// Refuses the second message of a step; a ground station sends to it each time.
class Refusing final : public autopilot::FlightController {
 public:
  autopilot::Actions step(const autopilot::Sensed&,
                          const std::vector<autopilot::Bytes>& received) override {
    autopilot::Actions actions{.setpoint = {}, .sent = {}, .of_station = {bytes_of(77)}};
    if (received.size() > 1) actions.refused = {{1, "not_signed"}};
    return actions;
  }
};

TEST_F(ControllerLinksTest, TheRecordHasWhatIsRefusedAndWhatAGroundStationSends) {
  make_links(1, {});
  options_.uavs[0].controller->make = [] { return std::make_unique<Refusing>(); };
  remake();
  run({to_controller(milliseconds(1), 1), to_controller({}, 2), to_controller({}, 3),
       finish(milliseconds(5))});
  std::vector<std::string> outcomes;
  std::uint64_t of_station = 0;
  for (const record::AutopilotMessage& m : recorder_.autopilot) {
    if (m.to_controller) {
      outcomes.push_back(m.outcome);
      EXPECT_EQ(m.acted_at.has_value(), m.outcome == record::kDelivered);
    }
    if (!m.of_station) continue;
    EXPECT_EQ(m.sequence, ++of_station);
    EXPECT_EQ(m.acted_at, m.sent_at);
    EXPECT_EQ(to_ns(m.at) % 4'000'000, 0);
  }
  EXPECT_THAT(outcomes, ElementsAre("delivered", "not_signed", "delivered"));
  EXPECT_GE(of_station, 2U);
}

TEST_F(ControllerLinksTest, ALineThatIsFullLosesTheNewest) {
  make_links(1, {.baud = 9'600, .own = 0});
  Script script(4, to_controller({}, 1, 500));  // 0.52 s each
  script.push_back(finish(std::chrono::seconds(3)));
  run(std::move(script));
  std::vector<std::string> outcomes;
  for (const auto& m : recorder_.autopilot)
    if (m.to_controller) outcomes.push_back(m.outcome);
  std::ranges::sort(outcomes);
  EXPECT_THAT(outcomes, ElementsAre("delivered", "delivered", "queue_full", "queue_full"));
  EXPECT_EQ(taken_[0].size(), 2U);
}

TEST_F(ControllerLinksTest, AnInboxThatIsFullLosesTheNewestAndLeavesTheRadioAlone) {
  make_links(1, {.own = 300}, 1);
  options_.radio.inbox_messages = 2;
  remake();
  server_->add_sut(hello(name_of(0)), {receive(milliseconds(50), {}), finish({})});
  server_->add_sut(hello(name_of(1)), {send(milliseconds(30)), finish({})});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  std::map<std::string, int> outcomes;
  for (const record::AutopilotMessage& m : recorder_.autopilot) ++outcomes[m.outcome];
  EXPECT_EQ(outcomes["delivered"], 1024);
  EXPECT_EQ(outcomes["inbox_full"], 13 * 300 - 1024);
  ASSERT_EQ(recorder_.radio.size(), 1U);
  EXPECT_EQ(recorder_.radio[0].outcome, record::kDelivered);
}

TEST_F(ControllerLinksTest, ACommandBesideAFlightControllerEndsTheRun) {
  make_links(1, {});
  const RunReport report = run({turn({}, 0.1), finish({})});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("flight controller"));
  EXPECT_THAT(report.reason, HasSubstr("send them to \"autopilot\""));
}

TEST_F(ControllerLinksTest, WithoutAControllerThereIsNoAutopilot) {
  const RunReport report = run({to_controller({}, 1), finish({})});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("\"autopilot\""));
}

TEST_F(ControllerLinksTest, WhateverEndsARunEachMessageThatWasSentHasItsFate) {
  for (std::size_t calls = 8; calls < 16; ++calls) {
    make_links(2, {});
    Script honest(20, to_controller(microseconds(450), 1));
    honest.push_back(finish({}));
    server_->add_sut(hello(name_of(0)), std::move(honest));
    Script wrong(calls, to_controller(microseconds(470), 1));
    wrong.push_back(turn({}, 0.1));
    server_->add_sut(hello(name_of(1)), std::move(wrong));
    EXPECT_EQ(run().end, RunEnd::kSutLost);
    using Message = std::pair<std::string, std::uint64_t>;
    std::vector<Message> sent, fated;
    for (const auto& m : recorder_.interactions)
      if (m.kind == record::kSend) sent.emplace_back(m.uav, m.sequence);
    for (const auto& m : recorder_.autopilot)
      if (m.to_controller) fated.emplace_back(m.uav, m.sequence);
    EXPECT_THAT(sent, testing::SizeIs(testing::Ge(calls)));
    EXPECT_THAT(fated, testing::IsSupersetOf(sent)) << calls;
  }
}

TEST_F(ControllerLinksTest, AFloodLosesWhatIsTooMuchForItsLineAndNothingElse) {
  for (const bool floods : {false, true}) {
    make_links(2, {});
    constexpr std::size_t kLost = 500;
    const std::size_t sent = floods ? kMaxMessagesInASecond + kLost : 1;
    Script flood(sent, to_controller(std::chrono::microseconds(10), 0xFFFF, 2'000));
    flood.push_back(finish(milliseconds(1)));
    server_->add_sut(hello(name_of(0)), std::move(flood));
    Script honest;
    for (std::uint64_t i = 1; i <= 20; ++i) {
      honest.push_back(to_controller(milliseconds(1), i));
      honest.push_back(receive({}, milliseconds(9)));
    }
    honest.push_back(finish(milliseconds(5)));
    server_->add_sut(hello(name_of(1)), std::move(honest));
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kFinished) << report.reason;
    EXPECT_EQ(taken_[0].size(), floods ? sent - kLost : sent);
    EXPECT_EQ(taken_[1].size(), 20U);
    for (std::size_t i = 0; i < taken_[1].size(); ++i) {
      EXPECT_EQ(taken_[1][i].number, i + 1);
      EXPECT_LE(taken_[1][i].at, st_ms(4 * static_cast<std::int64_t>(i) + 4));
    }
  }
}

}  // namespace
}  // namespace tether::coordinator
