#include "flight.h"

#include <gtest/gtest.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

TEST(InspectTask, KeepsTheAnchorAheadAtItsDistance) {
  for (const double distance_m : {2.0, 4.0}) {
    InspectTask task("blue_box", {.distance_m = 3.0, .duration = std::chrono::seconds(2)});
    const Flight flight = fly(task, {.anchor_bearing_rad = 0.3, .anchor_distance_m = distance_m});
    ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    EXPECT_LT(std::abs(flight.vehicle.bearing()), 0.12);
    const uav::Vec3 way = flight.vehicle.anchor_position() - flight.vehicle.position();
    EXPECT_NEAR(std::hypot(way.x, way.y), 3.0, 0.4);
    EXPECT_GE(flight.result("held_s"), 2.0);
  }
}

TEST(InspectTask, EndsIfItLosesTheAnchor) {
  InspectTask task("blue_box");
  EXPECT_EQ(fly(task, {.anchor_is_there = false}).outcome.reason, "anchor lost");
  InspectTask brief("blue_box", {.distance_m = 1.0, .time_limit = std::chrono::seconds(1)});
  EXPECT_EQ(fly(brief, {}).outcome.reason, "time limit");
}

TEST(InspectTask, EndsIfTheBatteryIsLow) {
  const InspectOptions options{.duration = std::chrono::seconds(30), .least_charge = 0.5};
  InspectTask task("blue_box", options);
  const Flight flight = fly(task, {.endurance = std::chrono::seconds(20)});
  EXPECT_EQ(flight.outcome.reason, "battery low");
  EXPECT_NEAR(flight.result("duration_s"), 10.0, 0.1);
  EXPECT_TRUE(fly(task, {}).outcome.failure.has_value()) << "without a battery";
}

TEST(InspectTask, CountsOnlyTimeWithoutABreak) {
  InspectTask task("blue_box", {.distance_m = 4.0,
                                .duration = std::chrono::seconds(3),
                                .distance_tolerance_m = 0.5,
                                .time_limit = std::chrono::seconds(5)});
  const Flight flight =
      fly(task, {.anchor_bearing_rad = 0.0,
                 .anchor_hidden = {std::chrono::seconds(2), std::chrono::milliseconds(2500)}});
  EXPECT_EQ(flight.outcome.reason, "time limit");
  EXPECT_LT(flight.result("held_s"), 3.0);
}

}  // namespace
}  // namespace tether::tasks
