#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::kCamera;
using uav::Pose;
using uav::Vec3;

using namespace std::chrono_literals;

// Two UAVs and a loose box, with a shutter that reaches this far back.
World world_with_shutter(double exposure_s, double readout_s) {
  World world = testing::test_world();
  world.uavs.push_back(testing::test_uav("beta", {2.0, 0.0, 1.0}));
  world.models.push_back(testing::box_model("loose", {}, {1.0, 1.0, 1.0}, {}, false));
  auto& camera = std::get<CameraModel>(world.uavs[1].sensors[kCamera].model);
  camera.exposure_s = exposure_s;
  camera.readout_s = readout_s;
  return world;
}

// A state whose numbers are their own indices.
std::vector<double> counted(const StateLayout& layout) {
  std::vector<double> state(layout.size());
  std::iota(state.begin(), state.end(), 0.0);
  return state;
}

TEST(ShutterStepsTest, ReachBackToTheLongestWindowsBeginning) {
  EXPECT_EQ(shutter_steps(world_with_shutter(0.0, 0.0)), 0U);
  EXPECT_EQ(shutter_steps(world_with_shutter(0.0101, 0.0)), 11U);
  World world = world_with_shutter(0.01, 0.0205);
  EXPECT_EQ(shutter_steps(world), 31U);
  world.step = 4ms;
  EXPECT_EQ(shutter_steps(world), 8U);
}

TEST(ShutterStepsTest, RefuseAnImpossibleShutter) {
  for (const auto& [exposure_s, readout_s] :
       {std::pair{-0.01, 0.02}, {0.02, -0.01}, {0.6, 0.6}, {std::nan(""), 0.0}}) {
    EXPECT_THROW(shutter_steps(world_with_shutter(exposure_s, readout_s)), Error);
  }
}

TEST(StateLayoutTest, PosesThenMotionsThenPastPoses) {
  const StateLayout layout(world_with_shutter(0.002, 0.0));
  EXPECT_EQ(layout.bodies(), 3U);
  EXPECT_EQ(layout.uavs(), 2U);
  EXPECT_EQ(layout.past_steps(), 2U);
  EXPECT_EQ(layout.motion_at(1), 21U + 12U);
  EXPECT_EQ(layout.past_at(), 21U + 24U);
  EXPECT_EQ(layout.size(), 45U + 2U * 21U);
  const std::vector<double> state = counted(layout);
  EXPECT_EQ(layout.pose_of(state, 2), (Pose{{14.0, 15.0, 16.0}, {17.0, 18.0, 19.0, 20.0}}));
  const BodyMotion motion = layout.motion_of(state, 1);
  EXPECT_EQ(motion.w_WB_B, (Vec3{33.0, 34.0, 35.0}));
  EXPECT_EQ(motion.a_WB_W, (Vec3{36.0, 37.0, 38.0}));
  EXPECT_EQ(motion.alpha_WB_B, (Vec3{39.0, 40.0, 41.0}));
  EXPECT_EQ(motion.v_WB_W, (Vec3{42.0, 43.0, 44.0}));
  EXPECT_EQ(layout.past_pose_of(state, 1, 0), layout.pose_of(state, 1));
  EXPECT_EQ(layout.past_pose_of(state, 1, 1).p, (Vec3{73.0, 74.0, 75.0})) << "the newest is last";
  EXPECT_EQ(layout.past_pose_of(state, 1, 2).p, (Vec3{52.0, 53.0, 54.0}));
}

}  // namespace
}  // namespace tether::sim
