#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <tether/rig/mission.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::rig {
namespace {

using tasks::testing::PlanarVehicle;
using ::testing::HasSubstr;

Mission mission_with(TaskOptions options) {
  TaskSpec spec;
  spec.options = std::move(options);
  spec.anchor = "blue_box";
  spec.sensor = "range";
  return {{spec}, false};
}

tasks::ConvergenceOptions convergence() {
  return {.tolerance_px = 2.0};
}

Mission face_anchor() {
  tasks::FaceAnchorOptions options;
  options.convergence = convergence();
  options.lost_limit = std::chrono::seconds(1);
  return mission_with(options);
}

TEST(Fly, ReportsTheOutcomeToTheCoordinator) {
  for (const bool is_there : {true, false}) {
    for (const bool is_sequence : {true, false}) {
      PlanarVehicle vehicle({.anchor_is_there = is_there});
      Mission mission = face_anchor();
      mission.is_sequence = is_sequence;
      EXPECT_EQ(exit_code(fly(mission, vehicle)), is_there ? 0 : 1);
      ASSERT_TRUE(vehicle.finished());
      EXPECT_EQ(vehicle.finished()->reached_goal, is_there);
      EXPECT_THAT(vehicle.finished()->outcome,
                  ::testing::EndsWith(is_there ? "goal reached" : "anchor never seen"));
      EXPECT_THAT(vehicle.finished()->details_json, HasSubstr("\"overshoots\""));
    }
  }
}

TEST(Fly, EachTaskReportsItsResults) {
  tasks::MoveForwardOptions forward;
  forward.face.convergence = convergence();
  forward.speed_m_s = 1.0;
  const std::vector<std::pair<TaskOptions, std::string>> expected = {
      {tasks::SensorCharacterizationOptions{}, "mean_s"},
      {tasks::RelativePositionOptions{.convergence = convergence()}, "distance_m"},
      {forward, "face_anchors"},
      {tasks::ClosedPathOptions{.convergence = convergence()}, "displacement_m"}};
  for (const auto& [options, result] : expected) {
    PlanarVehicle vehicle({});
    EXPECT_EQ(exit_code(fly(mission_with(options), vehicle)), 0) << result;
    ASSERT_TRUE(vehicle.finished());
    EXPECT_THAT(vehicle.finished()->details_json, HasSubstr("\"" + result + "\""));
  }
}

TEST(Fly, MissionReportsEachTask) {
  PlanarVehicle vehicle({});
  Mission mission = face_anchor();
  mission.tasks.push_back(
      mission_with(tasks::RelativePositionOptions{.convergence = convergence()}).tasks.front());
  mission.is_sequence = true;
  EXPECT_EQ(exit_code(fly(mission, vehicle)), 0);
  const auto& details = vehicle.finished()->details_json;
  EXPECT_THAT(details, HasSubstr("\"task\":\"face_anchor\""));
  EXPECT_THAT(details, HasSubstr("\"task\":\"relative_position\""));
}

TEST(Fly, FailureIsNoOutcome) {
  PlanarVehicle vehicle({}), lost({.disconnect_at = 5});
  Mission unknown = face_anchor();
  unknown.tasks.front().anchor = "door";
  const tasks::TaskOutcome outcome = fly(unknown, vehicle);
  EXPECT_EQ(exit_code(outcome), 2);
  EXPECT_THAT(outcome.reason, HasSubstr("door"));
  EXPECT_EQ(exit_code(fly(face_anchor(), lost)), 3);
  EXPECT_FALSE(vehicle.finished() || lost.finished());
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
}  // namespace tether::rig
