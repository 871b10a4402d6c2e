#include "fake_vehicle.h"

#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::c_api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Subscribing : public testing::Test {
 protected:
  Subscribing() {
    flown_.fake->concurrent = true;
    flown_.fake->reads_left = 2;
  }
  ~Subscribing() override { tether_unsubscribe(subscription_); }
  void wait_until_ended() {
    while (tether_subscription_status(subscription_) == TETHER_OK) std::this_thread::yield();
    EXPECT_EQ(tether_subscription_status(subscription_), TETHER_RUN_ENDED);
    EXPECT_STREQ(tether_last_error(), "time limit");
  }

  Flown flown_;
  tether_subscription* subscription_ = nullptr;
  std::vector<double> seen_;
};

void keep(double value, void* user) {
  static_cast<std::vector<double>*>(user)->push_back(value);
}

TEST_F(Subscribing, ShowsImages) {
  const auto on_image = [](const tether_image* image, void* user) {
    tether_image_info info;
    EXPECT_EQ(tether_image_get_info(image, &info, sizeof info), TETHER_OK);
    keep(tether_image_rgb(image)[info.size_bytes - 1], user);
  };
  ASSERT_EQ(tether_subscribe_camera(flown_.vehicle, "camera", on_image, &seen_, &subscription_),
            TETHER_OK);
  wait_until_ended();
  EXPECT_THAT(seen_, ElementsAre(9.0, 9.0));
}

TEST_F(Subscribing, ShowsSamplesOfEachKind) {
  const auto on_imu = [](const tether_imu_sample* sample, void* user) {
    keep(sample->specific_force_m_s2.y, user);
  };
  ASSERT_EQ(tether_subscribe_imu(flown_.vehicle, "imu", on_imu, &seen_, &subscription_), TETHER_OK);
  wait_until_ended();
  tether_unsubscribe(subscription_);
  flown_.fake->reads_left = 1;
  const auto on_range = [](const tether_range_sample* sample, void* user) {
    keep(sample->range_m, user);
  };
  ASSERT_EQ(tether_subscribe_range(flown_.vehicle, "ahead", on_range, &seen_, &subscription_),
            TETHER_OK);
  wait_until_ended();
  EXPECT_THAT(seen_, ElementsAre(5.0, 5.0, 1.5));
}

TEST_F(Subscribing, NeedsTetherExecAndAPeriodicSensor) {
  const auto on_range = [](const tether_range_sample*, void*) {};
  EXPECT_EQ(tether_subscribe_range(flown_.vehicle, "down", on_range, nullptr, &subscription_),
            TETHER_INVALID);
  EXPECT_EQ(tether_subscribe_range(flown_.vehicle, "ahead", nullptr, nullptr, &subscription_),
            TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("callback"));
  flown_.fake->concurrent = false;
  EXPECT_EQ(tether_subscribe_range(flown_.vehicle, "ahead", on_range, nullptr, &subscription_),
            TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("tether-exec"));
  EXPECT_EQ(subscription_, nullptr);
  EXPECT_EQ(tether_subscription_status(nullptr), TETHER_INVALID);
}

}  // namespace
}  // namespace tether::c_api
