#include "test_simulator.h"

#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>

namespace tether::sim {
namespace {

using namespace std::chrono_literals;

class SteppingTest : public ::testing::TestWithParam<double> {};

// With a shutter, every step is remembered.
TEST_P(SteppingTest, SteppingAndCapturingAllocateNothing) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  World world = testing::test_world();
  world.models.push_back(
      testing::box_model("wall", {1.0, 0.0, 1.0}, {0.2, 4.0, 3.0}, {1.0, 1.0, 1.0}));
  std::get<CameraModel>(world.uavs[0].sensors[testing::kCamera].model).readout_s = GetParam();
  const auto simulator = testing::make_simulator(world);
  Snapshot snapshot;
  simulator->capture(snapshot);
  AllocationCount count;
  simulator->apply(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.3}));
  simulator->advance_to(SimTime(3s));  // into the wall
  simulator->capture(snapshot);
  simulator->ground_truth(0);
  simulator->reset(2);
  simulator->capture(snapshot);
  simulator->advance_to(SimTime(100ms));
  EXPECT_EQ(count.stop(), 0);
}

INSTANTIATE_TEST_SUITE_P(Readout_s, SteppingTest, ::testing::Values(0.0, 0.03));

}  // namespace
}  // namespace tether::sim
