#include "test_simulator.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_mujoco/mujoco_simulator.h>

// The worlds that come with Tether, through the whole back end.
namespace tether::sim {
namespace {

class WorldsTest : public ::testing::TestWithParam<const char*> {};

TEST_P(WorldsTest, FliesAndSees) {
  const auto simulator = testing::make_simulator(testing::shipped_world(GetParam()));
  simulator->advance_to(SimTime(std::chrono::seconds(1)));
  EXPECT_LT(norm(simulator->ground_truth(0).body.p_WB - uav::Vec3{1.2, 0.0, 1.2}), 1e-3);
  const auto& sensors = simulator->world().uavs[0].sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].kind() != uav::SensorKind::kCamera) continue;
    const auto image = testing::measure_now<uav::CameraSample>(*simulator, i);
    double sum = 0.0;
    for (const std::uint8_t byte : image.rgb) sum += byte;
    const double mean = sum / static_cast<double>(image.rgb.size());
    EXPECT_GT(mean, 50.0) << "too dark";
    EXPECT_LT(mean, 210.0) << "too bright";
    EXPECT_GT(std::set<std::uint8_t>(image.rgb.begin(), image.rgb.end()).size(), 50U);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, WorldsTest, ::testing::Values("corridor.sdf", "room.sdf"),
                         [](const auto& param_info) {
                           return std::string(param_info.param, 0, 4);
                         });

}  // namespace
}  // namespace tether::sim
