#include "fake_vehicle.h"

#include <gmock/gmock.h>

namespace tether::c_api {
namespace {

TEST(Flying, FailuresAreStatuses) {
  const Flown flown;
  flown.fake->failure = Failure{Failure::Kind::kDisconnected, "the coordinator has gone"};
  EXPECT_EQ(tether_command_velocity(flown.vehicle, 0, 0, 0, 0), TETHER_DISCONNECTED);
  EXPECT_STREQ(tether_last_error(), "the coordinator has gone");
  EXPECT_EQ(tether_sleep_for(flown.vehicle, 1), TETHER_DISCONNECTED);
  EXPECT_EQ(tether_annotate(flown.vehicle, "a", "{}"), TETHER_DISCONNECTED);
  EXPECT_EQ(tether_finish(flown.vehicle, 1, "a", ""), TETHER_DISCONNECTED);
  EXPECT_EQ(tether_stage_begin(flown.vehicle, "detect"), TETHER_DISCONNECTED);
  EXPECT_EQ(tether_stage_end(flown.vehicle), TETHER_DISCONNECTED);
}

TEST(Flying, NullIsInvalid) {
  const Flown flown;
  EXPECT_EQ(tether_now(nullptr), 0);
  EXPECT_EQ(tether_command_velocity(nullptr, 0, 0, 0, 0), TETHER_INVALID);
  EXPECT_EQ(tether_sleep_for(nullptr, 0), TETHER_INVALID);
  EXPECT_EQ(tether_sleep_until(nullptr, 0), TETHER_INVALID);
  EXPECT_EQ(tether_annotate(flown.vehicle, nullptr, "{}"), TETHER_INVALID);
  EXPECT_EQ(tether_stage_begin(flown.vehicle, nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_stage_end(nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_finish(flown.vehicle, 1, "a", nullptr), TETHER_INVALID);
  EXPECT_TRUE(flown.fake->said.empty());
}

}  // namespace
}  // namespace tether::c_api
