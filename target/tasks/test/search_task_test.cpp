#include "flight.h"

#include <gtest/gtest.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

TEST(SearchTask, TurnsUntilItSeesTheAnchor) {
  for (const bool clockwise : {false, true}) {
    SearchTask task("blue_box", {.clockwise = clockwise});
    const Flight flight = fly(task, {.anchor_bearing_rad = clockwise ? -2.0 : 2.0});
    ASSERT_TRUE(flight.outcome.reached()) << flight.outcome.reason;
    EXPECT_EQ(flight.vehicle.yaw() > 0.0, !clockwise);
    EXPECT_LT(std::abs(flight.vehicle.yaw()), 2.0);
    EXPECT_NEAR(flight.result("bearing_rad"), flight.vehicle.bearing(), 0.2);
  }
}

TEST(SearchTask, EndsIfThereIsNone) {
  SearchTask task("blue_box", {.time_limit = std::chrono::seconds(5)});
  const Flight flight = fly(task, {.anchor_is_there = false});
  EXPECT_EQ(flight.outcome.reason, "time limit");
  EXPECT_EQ(flight.outcome.results.count("bearing_rad"), 0u);
  SearchTask unknown("green_box");
  EXPECT_EQ(fly(unknown, {}).outcome.status, TaskStatus::kFailed);
}

}  // namespace
}  // namespace tether::tasks
