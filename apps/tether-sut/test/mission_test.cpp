#include "mission.h"

#include <gmock/gmock.h>

#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::sut {
namespace {

using tasks::testing::PlanarVehicle;
using ::testing::HasSubstr;

Mission face_anchor() {
  Mission mission;
  tasks::FaceAnchorOptions options;
  options.convergence.tolerance_px = 2.0;
  options.lost_limit = std::chrono::seconds(1);
  mission.task = options;
  mission.anchor = "blue_box";
  return mission;
}

TEST(Fly, TellsTheCoordinatorThatTheGoalIsReached) {
  PlanarVehicle vehicle({});
  const tasks::TaskOutcome outcome = fly(face_anchor(), vehicle);
  EXPECT_EQ(exit_code(outcome), 0);
  ASSERT_TRUE(vehicle.finished());
  EXPECT_TRUE(vehicle.finished()->reached_goal);
  EXPECT_EQ(vehicle.finished()->outcome, "goal reached");
  EXPECT_THAT(vehicle.finished()->details_json, HasSubstr("\"overshoots\""));
}

TEST(Fly, TellsTheCoordinatorThatItIsNot) {
  PlanarVehicle vehicle({.anchor_is_there = false});
  const tasks::TaskOutcome outcome = fly(face_anchor(), vehicle);
  EXPECT_EQ(exit_code(outcome), 1);
  ASSERT_TRUE(vehicle.finished());
  EXPECT_FALSE(vehicle.finished()->reached_goal);
  EXPECT_EQ(vehicle.finished()->outcome, "anchor never seen");
}

TEST(Fly, RelativePositionReportsItsResults) {
  PlanarVehicle vehicle({});
  Mission mission = face_anchor();
  mission.task = tasks::RelativePositionOptions{.convergence = {.tolerance_px = 2.0}};
  EXPECT_EQ(exit_code(fly(mission, vehicle)), 0);
  EXPECT_THAT(vehicle.finished()->details_json, HasSubstr("\"distance_m\""));
}

TEST(Fly, AnUnknownAnchorIsWrongUseAndEndsTheMission) {
  PlanarVehicle vehicle({});
  Mission mission = face_anchor();
  mission.anchor = "door";
  const tasks::TaskOutcome outcome = fly(mission, vehicle);
  EXPECT_EQ(exit_code(outcome), 2);
  EXPECT_THAT(outcome.reason, HasSubstr("door"));
  ASSERT_TRUE(vehicle.finished());
  EXPECT_FALSE(vehicle.finished()->reached_goal);
}

TEST(Fly, ALostLinkIsExitCode3) {
  PlanarVehicle vehicle({.disconnect_at = 5});
  EXPECT_EQ(exit_code(fly(face_anchor(), vehicle)), 3);
  EXPECT_FALSE(vehicle.finished());
}

TEST(ExitCode, OfEachFailure) {
  EXPECT_EQ(exit_code(Failure{Failure::Kind::kInvalid, ""}), 2);
  EXPECT_EQ(exit_code(Failure{Failure::Kind::kRunEnded, ""}), 1);
  for (const auto kind : {Failure::Kind::kRefused, Failure::Kind::kDisconnected,
                          Failure::Kind::kProtocol, Failure::Kind::kTimeout}) {
    EXPECT_EQ(exit_code(Failure{kind, ""}), 3);
  }
}

}  // namespace
}  // namespace tether::sut
