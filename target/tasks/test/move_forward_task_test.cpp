#include "flight.h"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
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

Flight fly_forward(const PlanarVehicle::Options& world, MoveForwardOptions options = {}) {
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
    const double side = start_yaw_deg == 0.0 ? 1.0 : -1.0;  // to the left, to the right
    world.anchor_bearing_rad *= side;
    world.start_yaw_rad = rad_from_deg(start_yaw_deg);
    const Flight flight = fly_forward(world, slow_flight());
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    const uav::Vec3 p_H0 =
        rotate(uav::from_rpy(0, 0, -world.start_yaw_rad), flight.vehicle.position());
    EXPECT_NEAR(p_H0.x, 2.0, 0.15);
    EXPECT_NEAR(p_H0.y, 0.0, 0.1) << "off the line of the start heading";
    EXPECT_NEAR(deg_from_rad(flight.result("yaw_turned_rad")), side * 90.0, 6.0);
    EXPECT_GT(flight.result("face_anchors"), 5);
    EXPECT_EQ(flight.result("face_anchors_missed"), 0);
    EXPECT_GT(flight.result("looks"), flight.result("face_anchors"));
  }
}

TEST(MoveForwardTask, GoesOnWhileItFacesTheAnchorUnlessToldToStop) {
  for (const bool stop_to_face : {false, true}) {
    MoveForwardOptions options = slow_flight();
    options.stop_to_face = stop_to_face;
    const Flight flight = fly_forward(wall_on_the_left(), options);
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
  const Flight host = fly_forward(wall_on_the_left(), options);
  const Flight target = fly_forward(slow, options);
  EXPECT_TRUE(host.outcome.reached() && target.outcome.reached());
  EXPECT_EQ(host.result("overshoots"), 0);
  const auto error = [](const Flight& flight) { return std::abs(flight.vehicle.position().x - 2); };
  EXPECT_GT(error(target), error(host));
}

TEST(MoveForwardTask, EndsWithTheReasonWhyItDidNotReachItsGoal) {
  MoveForwardOptions lost, searching, limited, few;
  lost.face.lost_limit = seconds(2);
  searching.face.time_limit = seconds(5);
  searching.time_limit = seconds(6);
  limited.time_limit = seconds(10);
  few.max_rounds = 5;
  const PlanarVehicle::Options usual = wall_on_the_left();
  PlanarVehicle::Options none = usual, vanishing = usual, stuck = usual, still = usual;
  none.anchor_is_there = false;
  vanishing.anchor_hidden = {seconds(3), seconds(1000)};
  stuck.imu_is_stuck = true;
  still.clock_stands_still = true;
  struct Case {
    PlanarVehicle::Options world;
    MoveForwardOptions options;
    std::string reason;
  };
  for (const Case& c : std::vector<Case>{{none, lost, "anchor never seen"},
                                         {vanishing, lost, "anchor lost"},
                                         {stuck, limited, "time limit"},
                                         {still, few, "round limit"}}) {
    const Flight flight = fly_forward(c.world, c.options);
    EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached);
    EXPECT_EQ(flight.outcome.reason, c.reason);
  }
  // A search on the spot can turn by more than 90°, which is no arrival.
  const Flight searched = fly_forward(none, searching);
  EXPECT_EQ(searched.outcome.status, TaskStatus::kNotReached) << searched.outcome.reason;
  EXPECT_GT(std::abs(searched.result("yaw_turned_rad")), rad_from_deg(90));
  EXPECT_LT(norm(searched.vehicle.position()), 0.2);
}

TEST(MoveForwardTask, SearchesForHiddenAnchorOnItsSide) {
  int searches = 0;
  for (const auto hidden_from : {milliseconds(1500), milliseconds(2500), milliseconds(4000)}) {
    PlanarVehicle::Options world = wall_on_the_left();
    world.anchor_bearing_rad = -world.anchor_bearing_rad;
    world.anchor_hidden = {hidden_from, hidden_from + milliseconds(600)};
    const Flight flight = fly_forward(world);
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

TEST(MoveForwardTask, MovesOnFromAnAnchorThatItCannotFace) {
  MoveForwardOptions options;
  options.face.precision_rad = rad_from_deg(0.001);
  options.face.time_limit = seconds(1);
  options.time_limit = seconds(6);
  const Flight flight = fly_forward(wall_on_the_left(), options);
  EXPECT_GT(flight.result("face_anchors_missed"), 1);
  EXPECT_GT(flight.vehicle.position().x, 0.1);
}

TEST(MoveForwardTask, FailsWithItsReason) {
  MoveForwardOptions options;
  options.face.imu = "compass";
  EXPECT_EQ(fly_forward(wall_on_the_left(), options).outcome.failure, Failure::Kind::kInvalid);
  PlanarVehicle::Options still = wall_on_the_left();
  still.imu_instants_stand_still = true;
  EXPECT_EQ(fly_forward(still).outcome.failure, Failure::Kind::kInvalid);
  for (const int n : {0, 1, 2, 5, 9, 20, 40}) {
    PlanarVehicle::Options world = wall_on_the_left();
    world.disconnect_at = n;
    EXPECT_EQ(fly_forward(world).outcome.failure, Failure::Kind::kDisconnected) << n;
  }
}

}  // namespace
}  // namespace tether::tasks
