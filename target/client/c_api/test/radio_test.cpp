#include "fake_vehicle.h"

#include <string_view>

#include <gmock/gmock.h>

#include <tether/client.hpp>

namespace tether::c_api {
namespace {

TEST(Radio, SendsToOneOrAll) {
  const Flown flown;
  EXPECT_EQ(tether_send(flown.vehicle, "uav2", "abc", 3), TETHER_OK);
  EXPECT_EQ(tether_send(flown.vehicle, nullptr, nullptr, 0), TETHER_OK);
  EXPECT_THAT(flown.fake->said, testing::ElementsAre("to uav2: abc", "to : "));
}

TEST(Radio, RefusesAnEmptyReceiver) {
  const Flown flown;
  EXPECT_EQ(tether_send(flown.vehicle, "", "abc", 3), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), testing::HasSubstr("empty"));
  EXPECT_THAT(flown.fake->said, testing::IsEmpty());
}

TEST(Radio, ReceivesBytesAndInstants) {
  const Flown flown;
  tether_message* message = nullptr;
  ASSERT_EQ(tether_receive(flown.vehicle, 5, &message), TETHER_OK);
  EXPECT_EQ(flown.fake->et, from_ns<ExecTime>(5));
  EXPECT_STREQ(tether_message_from(message), "uav2");
  EXPECT_EQ(tether_message_sent_at(message), 7);
  EXPECT_EQ(tether_message_arrived_at(message), 9);
  size_t size = 0;
  const auto* bytes = reinterpret_cast<const char*>(tether_message_bytes(message, &size));
  EXPECT_EQ(std::string_view(bytes, size), "hi");
  tether_message_free(message);
}

TEST(Radio, AFailedReceiveGivesNoMessage) {
  const Flown flown;
  flown.fake->failure = Failure{Failure::Kind::kNothingYet, "none"};
  auto* message = reinterpret_cast<tether_message*>(flown.fake);
  EXPECT_EQ(tether_receive(flown.vehicle, 5, &message), TETHER_NOTHING_YET);
  EXPECT_EQ(message, nullptr);
}

TEST(Radio, NamesPeers) {
  const Flown flown;
  EXPECT_EQ(tether_peer_count(flown.vehicle), 2U);
  EXPECT_STREQ(tether_peer_at(flown.vehicle, 1), "uav3");
  EXPECT_EQ(tether_peer_at(flown.vehicle, 2), nullptr);
}

TEST(Radio, NullIsInvalid) {
  const Flown flown;
  tether_message* message = nullptr;
  size_t size = 1;
  EXPECT_EQ(tether_send(nullptr, "uav2", "", 0), TETHER_INVALID);
  EXPECT_EQ(tether_send(flown.vehicle, "uav2", nullptr, 1), TETHER_INVALID);
  EXPECT_EQ(tether_receive(nullptr, 0, &message), TETHER_INVALID);
  EXPECT_EQ(tether_receive(flown.vehicle, 0, nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_message_bytes(nullptr, &size), nullptr);
  EXPECT_EQ(size, 0U);
  EXPECT_STREQ(tether_message_from(nullptr), "");
  EXPECT_EQ(tether_peer_count(nullptr), 0U);
  tether_message_free(nullptr);
}

TEST(Radio, HasACppApi) {
  auto made = std::make_unique<FakeVehicle>();
  FakeVehicle* fake = made.get();
  api::Vehicle vehicle(new tether_vehicle(std::move(made)));
  EXPECT_TRUE(vehicle.send(vehicle.peer_at(0), "x", 1));
  EXPECT_THAT(fake->said, testing::ElementsAre("to uav2: x"));
  const auto message = vehicle.receive(api::Duration(3));
  ASSERT_TRUE(message);
  EXPECT_STREQ(message->from(), "uav2");
  EXPECT_EQ(message->size(), 2U);
  EXPECT_EQ(message->bytes()[1], 'i');
  EXPECT_EQ(message->sent_at().time_since_epoch().count(), 7);
  EXPECT_EQ(message->arrived_at().time_since_epoch().count(), 9);
}

}  // namespace
}  // namespace tether::c_api
