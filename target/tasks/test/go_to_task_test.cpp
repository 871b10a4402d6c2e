#include "flight.h"

#include <gmock/gmock.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

TEST(GoToTask, FliesToARelativePosition) {
  GoToTask task({.ahead_m = 1.0, .left_m = -0.5, .up_m = 0.4});
  const Flight flight = fly(task, {.start_yaw_rad = 0.5,
                                   .q_BS_imu = uav::from_axis_angle({0, 0, 1}, 0.7),
                                   .imu_bias_m_s2 = {0.05, -0.02, 0.03},
                                   .imu_period = std::chrono::milliseconds(1)});
  ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  const uav::Vec3 goal = rotate(uav::from_axis_angle({0, 0, 1}, 0.5), {1.0, -0.5, 0.4});
  EXPECT_LT(norm(flight.vehicle.position() - goal), 0.25);
  EXPECT_NEAR(flight.result("end_z_m"), 0.4, 0.2);
  for (const auto& command : flight.vehicle.commands()) {
    EXPECT_LE(norm(command.velocity_H_m_s), 0.5 + 1e-9);
  }
  EXPECT_FALSE(flight.notes("odometry").empty());
}

TEST(GoToTask, ComesToRestBeforeItMeasuresTheBias) {
  GoToTask task({.ahead_m = 2.0});
  const Flight flight = fly(
      task, {.start_velocity_m_s = {-0.8, 0.4, 0.0}, .imu_period = std::chrono::milliseconds(1)});
  ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  const uav::Vec3 came_to_rest_at{-0.8 * 0.3 / 2, 0.4 * 0.3 / 2, 0.0};
  EXPECT_LT(norm(flight.vehicle.position() - came_to_rest_at - uav::Vec3{2.0, 0.0, 0.0}), 0.25);
}

// The vertical acceleration is over before the IMU is read again.
TEST(GoToTask, ClimbsByItsCommands) {
  GoToTask task({.ahead_m = 0.0, .up_m = 0.6});
  const Flight flight =
      fly(task, {.max_acceleration_m_s2 = 100.0, .imu_period = std::chrono::milliseconds(50)});
  ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  EXPECT_NEAR(flight.vehicle.position().z, 0.45, 0.05);
}

TEST(GoToTask, EndsAtItsLimits) {
  GoToTask slow({.ahead_m = 10.0, .time_limit = std::chrono::seconds(4)});
  EXPECT_EQ(fly(slow, {}).outcome.reason, "time limit");
  GoToTask stuck({.max_readings = 100});
  EXPECT_EQ(fly(stuck, {.imu_instants_stand_still = true}).outcome.reason, "round limit");
  GoToTask without({.imu = "none"});
  EXPECT_EQ(fly(without, {}).outcome.status, TaskStatus::kFailed);
}

}  // namespace
}  // namespace tether::tasks
