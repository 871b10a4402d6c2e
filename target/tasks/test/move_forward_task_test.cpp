#include "flight.h"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/move_forward_task.h>
#include <tether/tasks/task_context.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::PlanarVehicle;

/// An anchor 2 m ahead and 1 m to the left.
PlanarVehicle::Options wall_on_the_left() {
  return {.anchor_bearing_rad = std::atan2(1.0, 2.0), .anchor_distance_m = std::sqrt(5.0)};
}

Flight fly(const PlanarVehicle::Options& world, MoveForwardOptions options = {}) {
  options.face.convergence.tolerance_px = kTolerance_px;
  MoveForwardTask task("blue_box", options);
  return fly(task, world);
}

/// The anchor, a metre to the side, goes by at 9°/s at most.
MoveForwardOptions slow_flight() {
  MoveForwardOptions options;
  options.speed_m_s = 0.15;
  return options;
}

TEST(MoveForwardTask, StopsWhereTheAnchorIsAbeam) {
  for (const double start_yaw_deg : {0.0, 100.0}) {
    PlanarVehicle::Options world = wall_on_the_left();
    world.start_yaw_rad = rad_from_deg(start_yaw_deg);
    const Flight flight = fly(world, slow_flight());
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    const uav::Vec3 p_H0 =
        rotate(uav::from_rpy(0, 0, -world.start_yaw_rad), flight.vehicle.position());
    EXPECT_NEAR(p_H0.x, 2.0, 0.15);
    EXPECT_NEAR(p_H0.y, 0.0, 0.1) << "off the line of the start heading";
    EXPECT_NEAR(deg_from_rad(flight.result("yaw_turned_rad")), 90.0, 6.0);
    EXPECT_GT(flight.result("face_anchors"), 5);
    EXPECT_EQ(flight.result("face_anchors_missed"), 0);
    EXPECT_GT(flight.result("looks"), flight.result("face_anchors"));
  }
}

TEST(MoveForwardTask, AnAnchorOnTheRightTurnsItTheOtherWay) {
  PlanarVehicle::Options world = wall_on_the_left();
  world.anchor_bearing_rad = -world.anchor_bearing_rad;
  const Flight flight = fly(world, slow_flight());
  EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  EXPECT_NEAR(flight.vehicle.position().x, 2.0, 0.15);
  EXPECT_NEAR(deg_from_rad(flight.vehicle.yaw()), -90.0, 5.0);
}

TEST(MoveForwardTask, GoesOnWhileItFacesTheAnchorUnlessToldToStop) {
  for (const bool stop_to_face : {false, true}) {
    MoveForwardOptions options = slow_flight();
    options.stop_to_face = stop_to_face;
    const Flight flight = fly(wall_on_the_left(), options);
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    int turning = 0;
    for (const uav::VelocityCommand& command : flight.vehicle.commands()) {
      if (command.yaw_rate_rad_s == 0.0) continue;
      ++turning;
      EXPECT_NEAR(norm(command.velocity_H_m_s), stop_to_face ? 0.0 : options.speed_m_s, 1e-12);
    }
    EXPECT_GT(turning, 5);
    EXPECT_NEAR(flight.vehicle.position().y, 0.0, 0.1) << "off the line of the start heading";
  }
}

TEST(MoveForwardTask, ASlowComputerOvershootsTheAnchorAndIsFurtherOff) {
  MoveForwardOptions options;
  options.speed_m_s = 0.6;
  PlanarVehicle::Options slow = wall_on_the_left();
  slow.compute_per_image = milliseconds(250);
  const Flight host = fly(wall_on_the_left(), options);
  const Flight target = fly(slow, options);
  EXPECT_TRUE(host.outcome.reached() && target.outcome.reached());
  EXPECT_EQ(host.result("overshoots"), 0);
  const auto error = [](const Flight& flight) { return std::abs(flight.vehicle.position().x - 2); };
  EXPECT_GT(error(target), error(host));
}

TEST(MoveForwardTask, ComesToRestForATimeWhateverTheImusRate) {
  for (const auto period : {milliseconds(5), milliseconds(50)}) {
    PlanarVehicle::Options world = wall_on_the_left();
    world.imu_period = period;
    MoveForwardOptions options;
    options.settle_time = milliseconds(700);
    const Flight settled = fly(world, options);
    options.settle_time = Duration(0);
    const Flight at_once = fly(world, options);
    const Duration waited = settled.vehicle.now() - at_once.vehicle.now();
    EXPECT_GT(waited, milliseconds(700) - period);
    EXPECT_LE(waited, milliseconds(700));
    EXPECT_EQ(settled.result("duration_s"), at_once.result("duration_s"));
  }
}

TEST(MoveForwardTask, FailsWhereTheImusInstantsStandStill) {
  PlanarVehicle::Options world = wall_on_the_left();
  world.imu_instants_stand_still = true;
  const Flight flight = fly(world, {});
  EXPECT_EQ(flight.outcome.failure, Failure::Kind::kInvalid);
  EXPECT_EQ(flight.outcome.reason, "the readings of IMU \"imu\" are all from the same instant");
}

TEST(MoveForwardTask, NeverSeenIsAnOutcome) {
  MoveForwardOptions options;
  options.face.lost_limit = seconds(2);
  PlanarVehicle::Options world = wall_on_the_left();
  world.anchor_is_there = false;
  const Flight flight = fly(world, options);
  EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(flight.outcome.reason, "anchor never seen");
  EXPECT_LT(norm(flight.vehicle.position()), 0.2) << "searches standing still";
}

// A search on the spot may well turn by more than 90°: that is no arrival.
TEST(MoveForwardTask, TurningPastTheSideInASearchIsNoArrival) {
  MoveForwardOptions options;
  options.face.time_limit = seconds(5);
  options.time_limit = seconds(6);
  PlanarVehicle::Options world = wall_on_the_left();
  world.anchor_is_there = false;
  const Flight flight = fly(world, options);
  EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached) << flight.outcome.reason;
  EXPECT_GT(std::abs(flight.result("yaw_turned_rad")), rad_from_deg(90));
}

TEST(MoveForwardTask, AnAnchorThatVanishesIsLost) {
  MoveForwardOptions options;
  options.face.lost_limit = seconds(2);
  PlanarVehicle::Options world = wall_on_the_left();
  world.anchor_hidden = {seconds(3), seconds(1000)};
  const Flight flight = fly(world, options);
  EXPECT_EQ(flight.outcome.reason, "anchor lost");
  EXPECT_TRUE(flight.outcome.results.contains("bearing_rad"));
}

TEST(MoveForwardTask, AnAnchorThatHidesForAMomentIsLookedForOnItsSide) {
  int searches = 0;
  for (const auto hidden_from : {milliseconds(1500), milliseconds(2500), milliseconds(4000)}) {
    PlanarVehicle::Options world = wall_on_the_left();
    world.anchor_bearing_rad = -world.anchor_bearing_rad;
    world.anchor_hidden = {hidden_from, hidden_from + milliseconds(600)};
    const Flight flight = fly(world);
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    for (const auto& annotation : flight.vehicle.annotations()) {
      const auto note = nlohmann::json::parse(annotation.json);
      if (annotation.topic == "task" && note.at("event") == "search") {
        ++searches;
        EXPECT_LT(note.at("yaw_rate_rad_s").get<double>(), 0.0);
      }
    }
  }
  EXPECT_GE(searches, 1);
}

TEST(MoveForwardTask, EndsWhileTheImuSaysThatNothingTurns) {
  MoveForwardOptions options;
  options.time_limit = seconds(10);
  PlanarVehicle::Options world = wall_on_the_left();
  world.imu_is_stuck = true;
  const Flight flight = fly(world, options);
  EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(flight.outcome.reason, "time limit");
  EXPECT_NEAR(flight.result("duration_s"), 10.0, 2.0);
}

TEST(MoveForwardTask, EndsWhileTheClockStandsStill) {
  MoveForwardOptions options;
  options.max_rounds = 5;
  PlanarVehicle::Options world = wall_on_the_left();
  world.clock_stands_still = true;
  const Flight flight = fly(world, options);
  EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(flight.outcome.reason, "round limit");
}

TEST(MoveForwardTask, MovesOnFromAnAnchorThatItCannotFace) {
  MoveForwardOptions options;
  options.face.precision_rad = rad_from_deg(0.001);
  options.face.time_limit = seconds(1);
  options.time_limit = seconds(6);
  const Flight flight = fly(wall_on_the_left(), options);
  EXPECT_GT(flight.result("face_anchors_missed"), 1);
  EXPECT_GT(flight.vehicle.position().x, 0.1);
}

TEST(MoveForwardTask, FailsWithItsReason) {
  MoveForwardOptions options;
  options.face.imu = "compass";
  EXPECT_EQ(fly(wall_on_the_left(), options).outcome.failure, Failure::Kind::kInvalid);
  for (const int n : {0, 1, 2, 5, 9, 20, 40}) {
    PlanarVehicle::Options world = wall_on_the_left();
    world.disconnect_at = n;
    EXPECT_EQ(fly(world).outcome.failure, Failure::Kind::kDisconnected) << n;
  }
}

TEST(MoveForwardTask, IsDeterministic) {
  const auto once = [] { return details_json(fly(wall_on_the_left()).outcome); };
  EXPECT_EQ(once(), once());
}

}  // namespace
}  // namespace tether::tasks
