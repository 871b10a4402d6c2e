#include "flight.h"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::PlanarVehicle;

Flight fly_path(const PlanarVehicle::Options& world, ClosedPathOptions options = {}) {
  options.convergence.tolerance_px = kTolerance_px;
  ClosedPathTask task("blue_box", options);
  return fly(task, world);
}

TEST(ClosedPathTask, ComesBackToItsStart) {
  for (const double start_yaw_deg : {0.0, -130.0}) {
    const PlanarVehicle::Options world{.anchor_bearing_rad = rad_from_deg(10),
                                       .start_yaw_rad = rad_from_deg(start_yaw_deg),
                                       .camera_ahead_m = 0.1,
                                       .q_BS_imu = uav::from_rpy(0.1, 0.2, 0.3)};
    const Flight flight = fly_path(world);
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    EXPECT_LT(norm(flight.vehicle.position()), 0.15);
    EXPECT_NEAR(flight.vehicle.yaw(), world.start_yaw_rad, rad_from_deg(1));
    EXPECT_EQ(flight.result("legs"), 4);
    EXPECT_NEAR(flight.result("path_length_m"), 4.0, 0.3);
  }
}

TEST(ClosedPathTask, FliesASquareAheadAndToTheLeft) {
  const Flight flight = fly_path({.anchor_bearing_rad = 0.0, .start_yaw_rad = 0.5});
  double most_x = 0.0, most_y = 0.0, least = 0.0;
  for (const json& note : flight.notes("odometry")) {
    most_x = std::max(most_x, note.at("x_m").get<double>());
    most_y = std::max(most_y, note.at("y_m").get<double>());
    least = std::min({least, note.at("x_m").get<double>(), note.at("y_m").get<double>()});
    EXPECT_NEAR(note.at("yaw_rad").get<double>(), 0.0, 1e-9);
  }
  EXPECT_NEAR(flight.notes("odometry").back().at("x_m"), flight.result("end_x_m"), 1e-12);
  const uav::Vec3 p_H0 = rotate(uav::from_rpy(0, 0, -0.5), flight.vehicle.position());
  EXPECT_NEAR(flight.result("end_x_m"), p_H0.x, 0.06);
  EXPECT_NEAR(flight.result("end_y_m"), p_H0.y, 0.06);
  EXPECT_NEAR(most_x, 1.0, 0.1);
  EXPECT_NEAR(most_y, 1.0, 0.1);
  EXPECT_GT(least, -0.1);
}

/// A bias that the task was not told of takes it elsewhere; its estimate by vision says where.
TEST(ClosedPathTask, MeasuresItsDisplacementByVision) {
  ClosedPathOptions options;
  options.rest_time = Duration(0);
  const PlanarVehicle::Options world{.anchor_bearing_rad = rad_from_deg(-10),
                                     .start_yaw_rad = rad_from_deg(70),
                                     .camera_ahead_m = 0.1,
                                     .imu_bias_m_s2 = {0.005, -0.004, 0}};
  const Flight flight = fly_path(world, options);
  ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  const uav::Vec3 p_H0 =
      rotate(uav::from_rpy(0, 0, -world.start_yaw_rad), flight.vehicle.position());
  EXPECT_GT(norm(p_H0), 0.2);
  EXPECT_NEAR(flight.result("displacement_x_m"), p_H0.x, 0.12);
  EXPECT_NEAR(flight.result("displacement_y_m"), p_H0.y, 0.12);
  const auto notes = flight.notes("displacement");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].at("x_m"), flight.result("displacement_x_m"));
  EXPECT_EQ(notes[0].at("y_m"), flight.result("displacement_y_m"));
  EXPECT_DOUBLE_EQ(flight.result("displacement_m"),
                   std::hypot(notes[0].at("x_m").get<double>(), notes[0].at("y_m").get<double>()));
}

TEST(ClosedPathTask, LearnsTheBiasBeforeItStarts) {
  const Flight flight = fly_path({.anchor_bearing_rad = 0.0, .imu_bias_m_s2 = {0.05, -0.05, 0.02}});
  EXPECT_LT(norm(flight.vehicle.position()), 0.15);
}

/// Turned by a gust in its first leg, it flies on along the path's directions and turns back.
struct GustyVehicle : PlanarVehicle {
  using PlanarVehicle::PlanarVehicle;
  Status command_velocity(const uav::VelocityCommand& command) override {
    if (commands().size() == 1) disturb_yaw(0.3);
    return PlanarVehicle::command_velocity(command);
  }
};

// With a coarse tolerance the camera ends elsewhere, at an offset that does not cancel out.
TEST(ClosedPathTask, TurnsBackToTheStartHeadingWithinItsTolerance) {
  for (const double tolerance_rad : {ClosedPathOptions{}.turn_tolerance_rad, 0.5}) {
    const bool turns = tolerance_rad < 0.3;
    GustyVehicle vehicle({.anchor_bearing_rad = 0.0, .camera_ahead_m = turns ? 0.0 : 1.0});
    TaskContext context(vehicle);
    ClosedPathOptions options;
    options.convergence.tolerance_px = kTolerance_px;
    options.turn_tolerance_rad = tolerance_rad;
    ClosedPathTask task("blue_box", options);
    const TaskOutcome outcome = run(task, context);
    ASSERT_TRUE(outcome.reached()) << outcome.reason;
    EXPECT_NEAR(vehicle.yaw(), turns ? 0.0 : 0.3, turns ? 1.5 * tolerance_rad : 1e-9);
    EXPECT_NEAR(outcome.results.at("displacement_x_m"), vehicle.position().x, 0.15);
    EXPECT_NEAR(outcome.results.at("displacement_y_m"), vehicle.position().y, 0.15);
    bool turned = false;
    for (const auto& command : vehicle.commands()) {
      turned = turned || command.yaw_rate_rad_s < 0.0;
      EXPECT_LE(std::abs(command.yaw_rate_rad_s), options.turn_rate_rad_s);
    }
    EXPECT_EQ(turned, turns);
  }
}

TEST(ClosedPathTask, RestsAndSettlesForATimeWhateverTheImusRate) {
  for (const auto period : {milliseconds(5), milliseconds(50)}) {
    const auto duration_s = [period](Duration rest_time, Duration settle_time) {
      ClosedPathOptions options;
      options.rest_time = rest_time;
      options.settle_time = settle_time;
      return fly_path({.anchor_bearing_rad = 0.0, .imu_period = period}, options)
          .result("duration_s");
    };
    const double at_once_s = duration_s(Duration(0), Duration(0));
    // The next image can come later by its period.
    EXPECT_NEAR(duration_s(Duration(0), seconds(1)) - at_once_s, 1.0, 0.04);
    EXPECT_NEAR(duration_s(seconds(1), Duration(0)) - at_once_s, 1.0, 0.04);
  }
}

TEST(ClosedPathTask, EndsWithTheReasonWhyItDidNotReachItsGoal) {
  ClosedPathOptions usual, limited, short_leg, few_readings, few_at_rest, three_seconds;
  limited.time_limit = seconds(6);
  short_leg.rest_time = Duration(0);
  short_leg.distance_m = 0.3;
  short_leg.leg_slack = seconds(2);
  few_at_rest.max_readings = 50;
  few_readings = few_at_rest;
  few_readings.rest_time = Duration(0);
  three_seconds.time_limit = seconds(3);
  struct Case {
    PlanarVehicle::Options world;
    ClosedPathOptions options;
    std::string reason;
    int legs;
  };
  for (const Case& c : std::vector<Case>{
           {{.anchor_is_there = false}, usual, "anchor not seen at the start", 0},
           {{.anchor_bearing_rad = 0, .anchor_hidden = {seconds(5), seconds(99)}},
            usual,
            "anchor not seen at the end",
            4},
           {{.anchor_bearing_rad = 0, .anchor_distance_m = 1.0, .anchor_height_m = 4.0},
            usual,
            "no distance to the anchor at the start",
            0},
           {{.anchor_bearing_rad = 0, .imu_is_stuck = true}, short_leg, "time limit in leg 1", 0},
           {{.anchor_bearing_rad = 0}, limited, "time limit in leg 2", 1},
           {{.anchor_bearing_rad = 0, .imu_is_stuck = true, .clock_stands_still = true},
            few_readings,
            "round limit in leg 1",
            0},
           {{.anchor_bearing_rad = 0, .imu_instants_stand_still = true},
            few_at_rest,
            "round limit at rest before the start",
            0},
           {{.anchor_bearing_rad = 0, .imu_instants_stand_still = true},
            three_seconds,
            "time limit at rest before the start",
            0}}) {
    const Flight flight = fly_path(c.world, c.options);
    EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached);
    EXPECT_EQ(flight.outcome.reason, c.reason);
    EXPECT_EQ(flight.result("legs"), c.legs) << c.reason;
    EXPECT_FALSE(flight.outcome.results.contains("displacement_m"));
  }
}

TEST(ClosedPathTask, FailsWithItsReason) {
  ClosedPathOptions options;
  options.imu = "camera";
  EXPECT_EQ(fly_path({}, options).outcome.failure, Failure::Kind::kInvalid);
  for (const int n : {0, 2, 5, 24, 25, 100}) {
    const Flight flight = fly_path({.anchor_bearing_rad = 0, .disconnect_at = n});
    EXPECT_EQ(flight.outcome.status, TaskStatus::kFailed) << n;
    EXPECT_EQ(flight.outcome.failure, Failure::Kind::kDisconnected) << n;
  }
}

}  // namespace
}  // namespace tether::tasks
