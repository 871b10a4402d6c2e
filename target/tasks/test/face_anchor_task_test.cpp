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

std::vector<std::string> events(const Flight& flight) {
  std::vector<std::string> events;
  for (const auto& note : flight.notes("task")) {
    if (note.at("task") == "face_anchor") {
      events.push_back(note.at("phase").get<std::string>() + " " +
                       note.at("event").get<std::string>());
    }
  }
  return events;
}

Flight fly_facing(const PlanarVehicle::Options& world, FaceAnchorOptions options = {}) {
  options.convergence.tolerance_px = kTolerance_px;
  FaceAnchorTask task("blue_box", options);
  Flight flight = fly(task, world);
  (void)flight.vehicle.sleep_for(seconds(1));  // until it has come to rest
  return flight;
}

TEST(FaceAnchorTask, AFastComputerDoesNotOvershoot) {
  for (const double bearing_deg : {-35.0, -12.0, 8.0, 35.0}) {
    const Flight flight = fly_facing(
        {.anchor_bearing_rad = rad_from_deg(bearing_deg), .compute_per_image = milliseconds(2)});
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    EXPECT_EQ(flight.result("overshoots"), 0) << bearing_deg;
    EXPECT_LT(std::abs(deg_from_rad(flight.vehicle.bearing())), 4.0) << bearing_deg;
    EXPECT_LT(flight.outcome.results.at("duration_s"), 2.5);
  }
}

TEST(FaceAnchorTask, ASlowComputerOvershootsAndRecovers) {
  double overshoots = 0;
  for (const double bearing_deg : {-33.0, 28.0, 35.0}) {
    const Flight flight = fly_facing(
        {.anchor_bearing_rad = rad_from_deg(bearing_deg), .compute_per_image = milliseconds(300)});
    EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    EXPECT_LT(std::abs(deg_from_rad(flight.vehicle.bearing())), 6.0);
    overshoots += flight.result("overshoots");
  }
  EXPECT_GE(overshoots, 3);
}

TEST(FaceAnchorTask, EachOvershootReversesAndSlowsDown) {
  FaceAnchorOptions options;
  options.precision_rad = rad_from_deg(0.6);
  options.min_yaw_rate_rad_s = rad_from_deg(4.0);
  const Flight flight = fly_facing(
      {.anchor_bearing_rad = rad_from_deg(35), .compute_per_image = milliseconds(300)}, options);
  std::vector<double> rates;
  for (const auto& command : flight.vehicle.commands()) {
    if (command.yaw_rate_rad_s != 0.0) rates.push_back(command.yaw_rate_rad_s);
  }
  ASSERT_GE(rates.size(), 2u);
  EXPECT_DOUBLE_EQ(rates.front(), options.yaw_rate_rad_s);
  for (std::size_t i = 1; i < rates.size(); ++i) {
    const double expected =
        std::max(std::abs(rates[i - 1]) * options.slowdown, options.min_yaw_rate_rad_s);
    EXPECT_DOUBLE_EQ(rates[i], rates[i - 1] > 0 ? -expected : expected);
  }
  EXPECT_EQ(flight.result("overshoots"), static_cast<double>(rates.size()) - 1);
}

TEST(FaceAnchorTask, StopsAtOnceWhereItFacesTheAnchorAlready) {
  const Flight flight = fly_facing({.anchor_bearing_rad = 0});
  EXPECT_TRUE(flight.outcome.reached());
  EXPECT_EQ(flight.vehicle.yaw(), 0.0);
  EXPECT_THAT(flight.vehicle.commands(), ::testing::Each(uav::VelocityCommand{}));
}

TEST(FaceAnchorTask, LooksForAnAnchorOutsideTheImage) {
  const Flight behind = fly_facing({.anchor_bearing_rad = rad_from_deg(120)});
  EXPECT_TRUE(behind.outcome.reached()) << behind.outcome.reason;
  EXPECT_LT(std::abs(deg_from_rad(behind.vehicle.bearing())), 4.0);

  FaceAnchorOptions clockwise;
  clockwise.search_clockwise = true;
  const Flight right = fly_facing({.anchor_bearing_rad = rad_from_deg(-90)}, clockwise);
  EXPECT_TRUE(right.outcome.reached());
  EXPECT_LT(right.vehicle.yaw(), 0.0);
  EXPECT_EQ(right.result("overshoots"), 0);
}

TEST(FaceAnchorTask, EndsWithTheReasonWhyItDidNotReachItsGoal) {
  FaceAnchorOptions soon, late, precise, few;
  soon.lost_limit = seconds(2);
  late.lost_limit = seconds(3);
  precise.precision_rad = rad_from_deg(0.001);
  precise.time_limit = seconds(4);
  few.max_looks = 3;
  struct Case {
    PlanarVehicle::Options world;
    FaceAnchorOptions options;
    std::string reason;
    double duration_s;
  };
  for (const Case& c : std::vector<Case>{
           {{.anchor_is_there = false}, late, "anchor never seen", 3.0},
           {{.anchor_hidden = {milliseconds(500), seconds(100)}}, soon, "anchor lost", 3.0},
           {{.compute_per_image = milliseconds(100)}, precise, "time limit", 4.0},
           {{.anchor_is_there = false, .clock_stands_still = true}, few, "round limit", 0.0}}) {
    const Flight flight = fly_facing(c.world, c.options);
    EXPECT_EQ(flight.outcome.status, TaskStatus::kNotReached);
    EXPECT_EQ(flight.outcome.reason, c.reason);
    EXPECT_NEAR(flight.result("duration_s"), c.duration_s, 1.5) << c.reason;
  }
}

TEST(FaceAnchorTask, FindsAnAnchorThatWasHiddenForAMoment) {
  const Flight flight = fly_facing({.anchor_hidden = {milliseconds(300), milliseconds(900)}});
  EXPECT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
  EXPECT_THAT(events(flight), ::testing::Contains("loop unseen"));
}

TEST(FaceAnchorTask, FailsWhereverTheConnectionEnds) {
  for (int n = 0; n < 12; ++n) {
    const Flight flight = fly_facing({.disconnect_at = n});
    EXPECT_EQ(flight.outcome.status, TaskStatus::kFailed) << n;
    EXPECT_EQ(flight.outcome.failure, Failure::Kind::kDisconnected) << n;
  }
}

TEST(FaceAnchorTask, NotesItsPhases) {
  const Flight flight = fly_facing({.anchor_bearing_rad = rad_from_deg(10)});
  EXPECT_THAT(events(flight),
              ::testing::ElementsAre("initialise start", "initialise rotate", "loop start",
                                     "finalise start", "finalise end"));
}

TEST(FaceAnchorTask, IsDeterministic) {
  const PlanarVehicle::Options slow{.compute_per_image = milliseconds(200)};
  EXPECT_EQ(details_json(fly_facing(slow).outcome), details_json(fly_facing(slow).outcome));
}

}  // namespace
}  // namespace tether::tasks
