#include "flight.h"

#include <gtest/gtest.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

TEST(HoldTask, HoversForItsTime) {
  HoldTask task({.duration = std::chrono::seconds(2)});
  const Flight flight = fly(task, {});
  EXPECT_TRUE(flight.outcome.reached());
  EXPECT_NEAR(flight.result("duration_s"), 2.0, 0.02);
  EXPECT_EQ(norm(flight.vehicle.position()), 0.0);
}

TEST(HoldTask, FailsIfTheTimestampsDoNotAdvance) {
  HoldTask task;
  EXPECT_EQ(fly(task, {.imu_instants_stand_still = true}).outcome.status, TaskStatus::kFailed);
}

}  // namespace
}  // namespace tether::tasks
