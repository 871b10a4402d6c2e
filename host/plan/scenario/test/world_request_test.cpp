#include "test_files.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

TEST(WorldRequest, PlacesTheUavsWithAStartYawFromItsSpreadBySeed) {
  const ScratchFolder scratch;
  const Scenario scenario = load_scenario(write_project(scratch, kFullScenario));
  EXPECT_EQ(world_request(scenario, 1).world, scenario.world);
  EXPECT_THAT(world_request(scenario, 1).anchors, testing::ElementsAre("blue_box", "red_box"));
  double least = 1e9, greatest = -1e9;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const sim::WorldRequest request = world_request(scenario, seed);
    ASSERT_EQ(request.uavs.size(), 2u);
    EXPECT_EQ(request.uavs[0].yaw_rad, world_request(scenario, seed).uavs[0].yaw_rad);
    EXPECT_EQ(request.uavs[1].name, "uav2");
    const std::vector<Varied> drawn = start_yaws(scenario, seed);
    ASSERT_EQ(drawn.size(), 1u);
    EXPECT_EQ(drawn[0].what, "the start yaw of uav1");
    EXPECT_NEAR(drawn[0].value,
                deg_from_rad(request.uavs[0].yaw_rad - scenario.uavs[0].placement.yaw_rad), 1e-9);
    EXPECT_EQ(request.uavs[1].yaw_rad, scenario.uavs[1].placement.yaw_rad);
    least = std::min(least, deg_from_rad(request.uavs[0].yaw_rad));
    greatest = std::max(greatest, deg_from_rad(request.uavs[0].yaw_rad));
  }
  EXPECT_NEAR(least, 87.5, 0.1);
  EXPECT_NEAR(greatest, 92.5, 0.1);
}

}  // namespace
}  // namespace tether::scenario
