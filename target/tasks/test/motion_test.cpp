#include "motion.h"

#include <numbers>

#include <gmock/gmock.h>

#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using testing::PlanarVehicle;

struct Manoeuvre {
  explicit Manoeuvre(const PlanarVehicle::Options& options = {}) : vehicle(options) {}
  PlanarVehicle vehicle;
  TaskContext context{vehicle};
};

TEST(Motion, CommandsWhatTheListingsSay) {
  Manoeuvre f;
  ASSERT_TRUE(turn(f.context, 0.4));
  ASSERT_TRUE(move_direction(f.context, 0.5 * std::numbers::pi, 2.0));
  ASSERT_TRUE(stop(f.context));
  const auto& commands = f.vehicle.commands();
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0], (uav::VelocityCommand{{}, 0.4}));
  EXPECT_NEAR(commands[1].velocity_H_m_s.x, 0.0, 1e-12);
  EXPECT_NEAR(commands[1].velocity_H_m_s.y, 2.0, 1e-12);
  EXPECT_EQ(commands[1].velocity_H_m_s.z, 0.0);
  EXPECT_EQ(commands[1].yaw_rate_rad_s, 0.0);
  EXPECT_EQ(commands[2], uav::VelocityCommand{});
}

TEST(Motion, YawIsThatOfTheBodyHoweverTheImuIsMounted) {
  for (const double mounted : {0.0, 0.5 * std::numbers::pi, -2.0}) {
    Manoeuvre f({.start_yaw_rad = 0.7, .q_BS_imu = uav::from_rpy(0.3, -0.2, mounted)});
    const Result<double> yaw = get_yaw(f.context, "imu");
    ASSERT_TRUE(yaw);
    EXPECT_NEAR(*yaw, 0.7, 1e-9);
  }
}

TEST(Motion, YawNeedsAnImu) {
  Manoeuvre f;
  for (const char* sensor : {"camera", "compass"}) {
    const Result<double> yaw = get_yaw(f.context, sensor);
    ASSERT_FALSE(yaw);
    EXPECT_EQ(yaw.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(yaw.failure().message, ::testing::HasSubstr(sensor));
  }
}

TEST(Motion, PauseFollowsTheImusTimestamps) {
  // Of several seconds at 1 kHz: more readings than those after which standing still is told.
  for (const auto period : {std::chrono::milliseconds(1), std::chrono::milliseconds(50)}) {
    Manoeuvre f({.clock_stands_still = true, .imu_period = period});
    ASSERT_TRUE(pause(f.context, "imu", std::chrono::seconds(2)));
    EXPECT_EQ(f.vehicle.read<uav::ImuSample>("imu", client::Read::kLatest)->sampled_at,
              SimTime(std::chrono::seconds(2)));
  }
  Manoeuvre still({.imu_instants_stand_still = true});
  EXPECT_EQ(pause(still.context, "imu", Duration(1)).failure().kind, Failure::Kind::kInvalid);
  Manoeuvre cut({.disconnect_at = 3});
  EXPECT_EQ(pause(cut.context, "imu", std::chrono::seconds(1)).failure().kind,
            Failure::Kind::kDisconnected);
}

TEST(Motion, AFailureOverrulesAnyOtherEnd) {
  TaskOutcome outcome = TaskOutcome::goal_reached();
  fail_on(ok_status(), outcome);
  EXPECT_TRUE(outcome.reached());
  fail_on(Failure{Failure::Kind::kTimeout, "no answer"}, outcome);
  EXPECT_EQ(outcome.status, TaskStatus::kFailed);
  EXPECT_EQ(outcome.failure, Failure::Kind::kTimeout);
  fail_on(Failure{Failure::Kind::kDisconnected, "gone"}, outcome);
  EXPECT_EQ(outcome.reason, "no answer") << "the first one tells";
}

}  // namespace
}  // namespace tether::tasks
