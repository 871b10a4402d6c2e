#include "scripted_coordinator.h"

#include <optional>

#include <gmock/gmock.h>

#include <tether/client/simulated_vehicle.h>

namespace tether::client {
namespace {

using std::chrono::milliseconds;

class RadioOfVehicle : public testing::Test {
 protected:
  static link::Message greeting() {
    link::Welcome welcome = welcome_with_sensors();
    welcome.peers = {"other", "third"};
    return welcome;
  }
  std::vector<link::Message> answer(const link::Request& request) {
    link::Reply reply{request.sequence, request.issued_at, std::nullopt};
    if (const auto* receive = std::get_if<link::ReceiveMessage>(&request.body)) {
      reply.resume_at += ready_after_.value_or(receive->timeout);
      reply.message = incoming_;
      reply.more = more_;
    }
    return {reply};
  }
  std::unique_ptr<Vehicle> vehicle(link::Message welcome = greeting()) {
    coordinator_.emplace(std::move(welcome),
                         [this](const auto& request) { return answer(request); });
    ConnectOptions options;
    options.time = make_scripted_source(milliseconds(1));
    return connect(coordinator_->connect(), std::move(options)).value();
  }

  std::optional<link::RadioMessage> incoming_;
  std::vector<link::RadioMessage> more_;
  std::optional<Duration> ready_after_;  // a sensor
  std::optional<ScriptedCoordinator> coordinator_;
};

TEST_F(RadioOfVehicle, SendsToAPeer) {
  const auto sender = vehicle();
  EXPECT_THAT(sender->peers(), testing::ElementsAre("other", "third"));
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  ASSERT_TRUE(sender->send("third", bytes).ok());
  const auto sent = std::get<link::SendMessage>(coordinator_->requests().at(0).body);
  EXPECT_EQ(sent.to, "third");
  EXPECT_EQ(sent.bytes, bytes);
}

TEST_F(RadioOfVehicle, RefusesUnknownPeersAndLongMessagesWithoutARequest) {
  const auto sender = vehicle();
  EXPECT_EQ(sender->send("nobody", {}).failure().kind, Failure::Kind::kInvalid);
  const std::vector<std::uint8_t> long_one(link::kMaxRadioBytes + 1);
  const Failure too_long = sender->send("other", long_one).failure();
  EXPECT_EQ(too_long.kind, Failure::Kind::kInvalid);
  EXPECT_THAT(too_long.message, testing::HasSubstr("has 65537 bytes; at most 65536"));
  EXPECT_TRUE(coordinator_->requests().empty());
  EXPECT_TRUE(sender->send("", {}).ok()) << "the vehicle is still usable";
}

TEST_F(RadioOfVehicle, HasNobodyToSendToAlone) {
  const auto alone = vehicle(welcome_with_sensors());
  EXPECT_EQ(alone->send("", {}).failure().kind, Failure::Kind::kInvalid);
}

TEST_F(RadioOfVehicle, ReceivesAMessage) {
  incoming_ = {"other", from_ns<SimTime>(5), from_ns<SimTime>(6), {9}};
  const auto receiver = vehicle();
  const auto message = receiver->receive(milliseconds(3));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->from, "other");
  EXPECT_EQ(message->sent_at, from_ns<SimTime>(5));
  EXPECT_EQ(message->arrived_at, from_ns<SimTime>(6));
  EXPECT_THAT(message->bytes, testing::ElementsAre(9));
}

TEST_F(RadioOfVehicle, ReceivesNothingByTheTimeout) {
  const auto receiver = vehicle();
  EXPECT_EQ(receiver->receive(milliseconds(3)).failure().kind, Failure::Kind::kNothingYet);
  EXPECT_EQ(receiver->receive(-milliseconds(3)).failure().kind, Failure::Kind::kNothingYet);
  EXPECT_EQ(std::get<link::ReceiveMessage>(coordinator_->requests().at(1).body).timeout,
            Duration(0));
}

// Whether it was for a sensor follows from the time of the reply.
TEST_F(RadioOfVehicle, AWaitForASensorEndsWithNothingWhenThatIsReady) {
  const auto receiver = vehicle();
  const std::vector<std::string_view> sensors{"camera"};
  ready_after_ = milliseconds(1);
  const auto nothing = receiver->receive_or_measure(milliseconds(30), sensors, 1);
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->empty());
  EXPECT_THAT(std::get<link::ReceiveMessage>(coordinator_->requests().at(0).body).sensors,
              testing::SizeIs(1));
  ready_after_.reset();
  EXPECT_EQ(receiver->receive_or_measure(milliseconds(30), sensors, 1).failure().kind,
            Failure::Kind::kNothingYet);
  const std::vector<std::string_view> none{"no such sensor"};
  EXPECT_EQ(receiver->receive_or_measure(milliseconds(30), none, 1).failure().kind,
            Failure::Kind::kInvalid);
}

TEST_F(RadioOfVehicle, ReceivesWhatElseHasArrived) {
  incoming_ = {"autopilot", from_ns<SimTime>(5), from_ns<SimTime>(6), {9}};
  more_ = {{"autopilot", from_ns<SimTime>(5), from_ns<SimTime>(6), {8}}};
  const auto receiver = vehicle();
  const auto both = receiver->receive_or_measure(milliseconds(3), {}, 7);
  ASSERT_TRUE(both);
  ASSERT_THAT(*both, testing::SizeIs(2));
  EXPECT_THAT(both->at(0).bytes, testing::ElementsAre(9));
  EXPECT_THAT(both->at(1).bytes, testing::ElementsAre(8));
  EXPECT_EQ(std::get<link::ReceiveMessage>(coordinator_->requests().at(0).body).most, 7U);
  more_[0].arrived_at = from_ns<SimTime>(60'000'000);
  EXPECT_EQ(receiver->receive_or_measure(milliseconds(3), {}, 7).failure().kind,
            Failure::Kind::kProtocol);
}

TEST_F(RadioOfVehicle, SkipsWhatASensorHas) {
  const auto skipper = vehicle();
  ASSERT_TRUE(skipper->set_queue("camera", 7));
  EXPECT_TRUE(skipper->skip("camera"));
  const auto read = std::get<link::ReadSensor>(coordinator_->requests().at(0).body);
  EXPECT_TRUE(read.skips);
  EXPECT_EQ(read.queue, 7U);
  EXPECT_EQ(skipper->skip("imu").failure().kind, Failure::Kind::kInvalid) << "on demand";
}

TEST_F(RadioOfVehicle, RefusesAMessageFromTheFuture) {
  incoming_ = {"other", from_ns<SimTime>(5), from_ns<SimTime>(60'000'000), {}};
  const auto receiver = vehicle();
  EXPECT_EQ(receiver->receive(milliseconds(3)).failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::client
