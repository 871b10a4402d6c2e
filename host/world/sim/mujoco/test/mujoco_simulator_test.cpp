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
