#include "full_scenario.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

sim::Sensor sensor(const std::string& name, double update_rate_hz) {
  return {.name = name, .X_BS = {}, .update_rate_hz = update_rate_hz, .model = sim::ImuModel{}};
}

sim::World world_of_two() {
  sim::World world;
  world.uavs.resize(2);
  world.uavs[0].name = "uav1";
  world.uavs[0].sensors = {sensor("range", 7.0), sensor("imu", 100.0), sensor("camera", 60.0)};
  world.uavs[1].name = "uav2";
  world.uavs[1].sensors = {sensor("imu", 20.0), sensor("range", 0.0)};
  return world;
}

class Resolve : public testing::Test {
 protected:
  Scratch scratch_;
  Scenario scenario_ = load_scenario(write_project(scratch_, kFullScenario));
};

TEST_F(Resolve, WorldRequestPlacesTheUavs) {
  const sim::WorldRequest request = world_request(scenario_, 1);
  EXPECT_EQ(request.world, scenario_.world);
  ASSERT_EQ(request.uavs.size(), 2u);
  EXPECT_EQ(request.uavs[1].name, "uav2");
  EXPECT_THAT(request.anchors, testing::ElementsAre("blue_box", "red_box"));
}

TEST_F(Resolve, TheStartYawIsDrawnFromItsSpreadBySeed) {
  double least = 1e9, greatest = -1e9;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const sim::WorldRequest request = world_request(scenario_, seed);
    EXPECT_EQ(request.uavs[0].yaw_rad, world_request(scenario_, seed).uavs[0].yaw_rad);
    EXPECT_EQ(request.uavs[1].yaw_rad, scenario_.uavs[1].placement.yaw_rad);
    least = std::min(least, deg_from_rad(request.uavs[0].yaw_rad));
    greatest = std::max(greatest, deg_from_rad(request.uavs[0].yaw_rad));
  }
  EXPECT_NEAR(least, 87.5, 0.1);
  EXPECT_NEAR(greatest, 92.5, 0.1);
}

TEST_F(Resolve, TimingsFollowTheOrderOfTheWorldsSensors) {
  const auto timings = resolve_timings(scenario_, world_of_two());
  ASSERT_EQ(timings.size(), 2u);
  ASSERT_EQ(timings[0].size(), 3u);
  EXPECT_TRUE(std::holds_alternative<uav::OnDemandTiming>(timings[0][0]));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[0][1]).period, milliseconds(50));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[0][2]).phase, milliseconds(3));
}

TEST_F(Resolve, ASensorThatTheScenarioDoesNotTimeFollowsSdf) {
  const auto timings = resolve_timings(scenario_, world_of_two());
  const auto& imu = std::get<uav::PeriodicTiming>(timings[1][0]);
  EXPECT_EQ(imu.period, milliseconds(50));
  EXPECT_EQ(imu.phase, Duration{0});
  EXPECT_EQ(std::get<uav::ConstantDelay>(imu.delay).value, Duration{0});
  const auto& range = std::get<uav::OnDemandTiming>(timings[1][1]);
  EXPECT_EQ(std::get<uav::ConstantDelay>(range.delay).value, Duration{0});
}

TEST_F(Resolve, ATimedSensorThatTheUavLacksIsAnErrorAtItsLine) {
  sim::World world = world_of_two();
  world.uavs[0].sensors[2].name = "camera1";
  const std::string message = bad_file_message([&] { (void)resolve_timings(scenario_, world); });
  EXPECT_THAT(message, HasSubstr("scenario.toml:17: the UAV 'uav1' has no sensor 'camera'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'camera1'?"));
}

TEST_F(Resolve, AMetricOfASensorThatTheUavLacksIsAnErrorAtItsLine) {
  Scenario scenario = scenario_;
  scenario.metrics.back().sensor = "rang";
  const std::string message =
      bad_file_message([&] { (void)resolve_timings(scenario, world_of_two()); });
  EXPECT_THAT(message, HasSubstr("scenario.toml:91: the UAV 'uav1' has no sensor 'rang'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'range'?"));
}

}  // namespace
}  // namespace tether::scenario
