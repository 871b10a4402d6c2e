#include "fake_vehicle.h"

#include <gtest/gtest.h>

namespace tether::c_api {
namespace {

// What a subscription delivers is tested through the C++ API, in cpp_api_test.
TEST(Subscribing, NeedsTetherExecAPeriodicSensorAndACallback) {
  Flown flown;
  tether_subscription* subscription = nullptr;
  const auto on_range = [](const tether_range_sample*, void*) {};
  const auto subscribe = [&](const char* sensor, tether_on_range callback) {
    return tether_subscribe_range(flown.vehicle, sensor, callback, nullptr, &subscription);
  };
  EXPECT_EQ(subscribe("ahead", on_range), TETHER_INVALID) << "without tether-exec";
  flown.fake->concurrent = true;
  EXPECT_EQ(subscribe("down", on_range), TETHER_INVALID) << "it measures on demand";
  EXPECT_EQ(subscribe("ahead", nullptr), TETHER_INVALID);
  EXPECT_EQ(subscription, nullptr);
  EXPECT_EQ(tether_subscription_status(nullptr), TETHER_INVALID);
  tether_unsubscribe(nullptr);
}

}  // namespace
}  // namespace tether::c_api
