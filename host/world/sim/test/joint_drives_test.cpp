#include <vector>

#include <gmock/gmock.h>

#include <tether/sim/bodies.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

uav::Joint joint(double max_rate_rad_s) {
  return {"joint", {}, {0, 0, 1}, -1, 1, max_rate_rad_s};
}

// Steps of a millisecond.
TEST(JointDrives, TurnEachUavsJointsByItsCommands) {
  World world = testing::test_world();
  world.uavs.push_back(testing::test_uav("beta", {2, 0, 1}));
  world.uavs.push_back(testing::test_uav("gamma", {4, 0, 1}));
  world.uavs[0].joints = {joint(250)};
  world.uavs[2].joints = {joint(125), joint(1000)};
  JointDrives drives(world);
  EXPECT_THAT(drives.angles_rad(), ElementsAre(0, 0, 0));

  drives.command(2, std::vector{0.5, -0.75});
  EXPECT_THAT(drives.angles_rad(), ElementsAre(0, 0, 0)) << "from the next step on";
  drives.step();
  EXPECT_THAT(drives.angles_rad(2), ElementsAre(0.125, -0.75));
  drives.command(0, std::vector{1.0});
  for (int i = 0; i < 3; ++i) drives.step();
  EXPECT_THAT(drives.angles_rad(0), ElementsAre(0.75));
  EXPECT_THAT(drives.angles_rad(1), IsEmpty());
  EXPECT_THAT(drives.angles_rad(), ElementsAre(0.75, 0.5, -0.75));

  drives.reset();
  drives.step();
  EXPECT_THAT(drives.angles_rad(), ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace tether::sim
