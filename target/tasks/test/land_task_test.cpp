#include "flight.h"

#include <gtest/gtest.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

// The impact is over within a millisecond: most readings at 20 Hz miss it.
TEST(LandTask, DescendsToTheFloor) {
  for (const double height_m : {0.2, 0.93, 1.2, 1.21, 1.22, 1.23}) {
    LandTask task;
    const Flight flight = fly(task, {.height_m = height_m,
                                     .imu_bias_m_s2 = {0.0, 0.0, 0.05},
                                     .imu_period = std::chrono::milliseconds(50)});
    ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    EXPECT_NEAR(flight.vehicle.position().z, -height_m, 0.01);
    EXPECT_NEAR(flight.result("descended_m"), height_m, 0.2);
    EXPECT_LT(flight.result("duration_s"), 2.0 + height_m / 0.2 + 1.0);
  }
}

TEST(LandTask, ComesToRestBeforeItMeasuresTheBias) {
  LandTask task;
  const Flight flight = fly(task, {.start_velocity_m_s = {0.5, 0.0, 0.2}, .height_m = 1.2});
  ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  EXPECT_LT(flight.vehicle.position().z, -1.19);
}

TEST(LandTask, HasLandedOnTheFloorAlready) {
  LandTask task;
  EXPECT_LT(fly(task, {.height_m = 0.0}).result("duration_s"), 3.0);
}

TEST(LandTask, EndsAtItsTimeLimit) {
  LandTask task({.time_limit = std::chrono::seconds(5)});
  EXPECT_EQ(fly(task, {}).outcome.reason, "time limit");
}

}  // namespace
}  // namespace tether::tasks
