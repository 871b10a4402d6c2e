#include "test_simulator.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_testing/simulator_contract.h>

namespace tether::sim::testing {

using namespace std::chrono_literals;

std::unique_ptr<Simulator> make_ahead(World world) {
  return make_mujoco_simulator(std::move(world), no_warnings(), 2);
}

INSTANTIATE_TEST_SUITE_P(Mujoco, SimulatorContract, ::testing::Values(SimulatorMaker(make_ahead)));

TEST(MujocoSimulatorTest, DrawsWhatIsExpectedAfterTheFirstPicture) {
  const auto simulator = make_ahead(test_world());
  Snapshot snapshot;
  simulator->capture(snapshot);
  simulator->expect(snapshot, 0, kCamera, 0);
  simulator->measure(snapshot, 0, kCamera, 0);
  simulator->expect(snapshot, 0, kCamera, 1);
  while (simulator->work()->drawn_ahead == 0) continue;  // CTest ends it if nothing is drawn
  simulator->measure(snapshot, 0, kCamera, 1);
  SimulatorWork work = *simulator->work();
  EXPECT_GT(std::exchange(work.drawing, {}), Duration(0));
  EXPECT_EQ(work, (SimulatorWork{.pictures = 2, .drawn_ahead = 1, .drawn_in_vain = 0}));
}

/// "beta", 1.5 m ahead, with an arm of 0.6 m on a joint or held as the joint would hold it.
World world_with_arm(std::optional<double> held_rad) {
  World world = test_world();
  world.uavs.push_back(test_uav("beta", {1.5, 0.0, 1.0}));
  for (Uav& uav : world.uavs) {
    const std::vector<uav::Joint> joints = {{"roll", {}, {1, 0, 0}, -2, 2, 10.0}};
    Visual arm = box_visual({0.05, 0.6, 0.05}, {1.0, 0.0, 0.0});
    arm.X_LV.p.y = 0.2;
    if (held_rad) {
      arm.X_LV = turned(joints, std::vector{*held_rad}, arm.X_LV);
    } else {
      arm.joints = 1;
      uav.joints = joints;
    }
    uav.body.visuals.push_back(arm);
  }
  return world;
}

TEST(MujocoSimulatorTest, OthersSeePartsAtTheAnglesOfTheirJoints) {
  const auto turning = make_simulator(world_with_arm(std::nullopt));
  const auto at_rest = make_simulator(world_with_arm(0.0));
  const auto turned = make_simulator(world_with_arm(1.2));
  const auto seen = [](Simulator& simulator) {
    return measure_now<uav::CameraSample>(simulator, kCamera).rgb;
  };
  EXPECT_EQ(seen(*turning), seen(*at_rest));
  for (std::size_t uav = 0; uav < 2; ++uav)
    turning->apply(uav, {.mask = uav::kJoints, .joints_rad = {1.2}});
  for (Simulator* simulator : {turning.get(), turned.get()}) simulator->advance_to(SimTime(500ms));
  EXPECT_EQ(seen(*turning), seen(*turned));
  EXPECT_NE(seen(*turning), seen(*at_rest));
}

TEST(MujocoSimulatorTest, NamesItself) {
  EXPECT_THAT(make_simulator(test_world())->description(), ::testing::StartsWith("MuJoCo "));
  EXPECT_TRUE(kHasMujoco);
}

TEST(MujocoSimulatorTest, StopsWhenTheMotionBecomesUnusable) {
  World world = test_world();
  world.gravity_m_s2 = 1e12;
  const auto simulator = make_simulator(world);
  EXPECT_THROW(simulator->advance_to(SimTime(1s)), Error);
}

// A file may write any character into a name.
TEST(MujocoSimulatorTest, WarnsInPrintableLines) {
  World world = test_world();
  Collision plane;
  plane.name = "flo\nor";
  plane.geometry = PlaneGeometry{{0.0, 0.0, 1.0}, 1.0, 1.0};
  world.uavs[0].body.collisions = {plane};
  std::vector<std::string> warnings;
  make_mujoco_simulator(world,
                        [&](const Warning& warning) { warnings.push_back(to_line(warning)); });
  EXPECT_THAT(warnings, ::testing::ElementsAre(::testing::HasSubstr("'flo?or'")));
}

}  // namespace tether::sim::testing
