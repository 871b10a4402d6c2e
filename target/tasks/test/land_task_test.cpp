#include "flight.h"

#include <gtest/gtest.h>

#include <tether/tasks/land_task.h>

namespace tether::tasks {
namespace {

TEST(LandTask, DescendsToTheFloor) {
  LandTask task;
  const Flight flight = fly(task, {.height_m = 1.2, .imu_bias_m_s2 = {0.0, 0.0, 0.05}});
  ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  EXPECT_NEAR(flight.vehicle.position().z, -1.2, 0.01);
  EXPECT_NEAR(flight.result("descended_m"), 1.2, 0.1);
}

TEST(LandTask, EndsAtItsTimeLimit) {
  LandTask task({.time_limit = std::chrono::seconds(5)});
  EXPECT_EQ(fly(task, {}).outcome.reason, "time limit");
}

}  // namespace
}  // namespace tether::tasks
