#include "fake_vehicle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::c_api {
namespace {

TEST(Flying, CommandsAreInTheHeadingFrame) {
  const Flown flown;
  ASSERT_EQ(tether_command_velocity(flown.vehicle, 1.0, -2.0, 0.5, 0.25), TETHER_OK);
  EXPECT_EQ(flown.fake->commands.at(0), (uav::VelocityCommand{{1.0, -2.0, 0.5}, 0.25}));
}

TEST(Flying, TimeIsNanosecondsOfEt) {
  const Flown flown;
  ASSERT_EQ(tether_sleep_until(flown.vehicle, 5'000'000'000), TETHER_OK);
  ASSERT_EQ(tether_sleep_for(flown.vehicle, 7), TETHER_OK);
  EXPECT_EQ(tether_now(flown.vehicle), 5'000'000'007);
}

TEST(Flying, WordsForTheRecordArriveWhole) {
  const Flown flown;
  ASSERT_EQ(tether_annotate(flown.vehicle, "roi", "{\"u_px\": 3}"), TETHER_OK);
  ASSERT_EQ(tether_finish(flown.vehicle, 7, "there", "{}"), TETHER_OK);
  ASSERT_EQ(tether_finish(flown.vehicle, 0, "lost", ""), TETHER_OK);
  EXPECT_THAT(flown.fake->said,
              testing::ElementsAre("roi {\"u_px\": 3}", "reached there {}", "missed lost "));
}

TEST(Flying, FailuresAreStatuses) {
  const Flown flown;
  flown.fake->failure = Failure{Failure::Kind::kDisconnected, "the coordinator has gone"};
  EXPECT_EQ(tether_command_velocity(flown.vehicle, 0, 0, 0, 0), TETHER_DISCONNECTED);
  EXPECT_STREQ(tether_last_error(), "the coordinator has gone");
  EXPECT_EQ(tether_sleep_for(flown.vehicle, 1), TETHER_DISCONNECTED);
  EXPECT_EQ(tether_annotate(flown.vehicle, "a", "{}"), TETHER_DISCONNECTED);
  EXPECT_EQ(tether_finish(flown.vehicle, 1, "a", ""), TETHER_DISCONNECTED);
}

TEST(Flying, NullIsInvalid) {
  const Flown flown;
  EXPECT_EQ(tether_now(nullptr), 0);
  EXPECT_EQ(tether_command_velocity(nullptr, 0, 0, 0, 0), TETHER_INVALID);
  EXPECT_EQ(tether_sleep_for(nullptr, 0), TETHER_INVALID);
  EXPECT_EQ(tether_sleep_until(nullptr, 0), TETHER_INVALID);
  EXPECT_EQ(tether_annotate(flown.vehicle, nullptr, "{}"), TETHER_INVALID);
  EXPECT_EQ(tether_finish(flown.vehicle, 1, "a", nullptr), TETHER_INVALID);
  EXPECT_TRUE(flown.fake->said.empty());
}

}  // namespace
}  // namespace tether::c_api
