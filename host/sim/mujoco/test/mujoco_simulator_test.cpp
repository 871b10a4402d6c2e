#include "test_simulator.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_testing/simulator_contract.h>

namespace tether::sim::testing {

using namespace std::chrono_literals;

INSTANTIATE_TEST_SUITE_P(Mujoco, SimulatorContract,
                         ::testing::Values(SimulatorMaker(make_simulator)));

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
