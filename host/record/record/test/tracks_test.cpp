#include <chrono>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/record/reader.h>

namespace tether::record {
namespace {

using std::chrono::milliseconds;

constexpr SimTime kAt = SimTime{std::chrono::seconds(2)};

void add_pose(Record& record, const std::string& uav, int ms, double x_m, double yaw_deg) {
  const double half_rad = 0.5 * rad_from_deg(yaw_deg);
  GroundTruth truth{.uav = uav, .at = SimTime(milliseconds(ms)), .p_WB_m = {x_m, 0, 0}};
  truth.q_WB[0] = std::cos(half_rad);
  truth.q_WB[3] = std::sin(half_rad);
  record.ground_truth.push_back({truth.at, 0, truth});
}

Record turning_flight() {
  Record record;
  record.header.ground_truth_period = milliseconds(10);
  add_pose(record, "uav1", 10, 1.0, 170.0);
  add_pose(record, "uav2", 12, 50.0, 0.0);
  add_pose(record, "uav1", 20, 2.0, -170.0);
  add_pose(record, "uav1", 30, 2.0, -90.0);
  return record;
}

std::optional<uav::Pose> pose_at_ms(const Record& record, double ms) {
  return pose_at(record, "uav1", SimTime(duration_from_seconds(ms * 1e-3)));
}

TEST(UavTrack, IsInterpolatedTheShortWayRound) {
  Record record = turning_flight();
  const auto pose = pose_at_ms(record, 12.5);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->p.x, 1.25, 1e-12);
  EXPECT_NEAR(uav::yaw_rad(pose->q), rad_from_deg(175.0), 1e-12);
  EXPECT_EQ(pose_at_ms(record, 20)->p.x, 2.0);
  EXPECT_EQ(pose_at_ms(record, 20)->q.w, std::cos(rad_from_deg(-85.0)));
  EXPECT_NEAR(uav::yaw_rad(pose_at_ms(record, 25)->q), rad_from_deg(-130.0), 1e-12);
  for (double& value : record.ground_truth.back().message.q_WB) value = -value;
  EXPECT_NEAR(uav::yaw_rad(pose_at_ms(record, 25)->q), rad_from_deg(-130.0), 1e-12)
      << "q and -q are one attitude";
}

TEST(UavTrack, OfAStationaryUavIsThatPose) {
  Record record = turning_flight();
  add_pose(record, "uav1", 40, 2.0, -90.0);
  EXPECT_NEAR(uav::yaw_rad(pose_at_ms(record, 33)->q), rad_from_deg(-90.0), 1e-12);
}

TEST(UavTrack, IsNoneFurtherThanAPeriodFromGroundTruth) {
  const Record record = turning_flight();
  EXPECT_EQ(pose_at_ms(record, 0)->p.x, 1.0);
  EXPECT_EQ(pose_at_ms(record, 40)->p.x, 2.0);
  EXPECT_FALSE(pose_at_ms(record, -0.001));
  EXPECT_FALSE(pose_at_ms(record, 40.001));
  EXPECT_FALSE(pose_at(record, "uav3", SimTime(milliseconds(20))));
  EXPECT_FALSE(pose_at_ms({}, 0));
}

TEST(AnchorTrack, OneWithoutAPathIsWhereItWasPlaced) {
  const Record record;
  const AnchorTrack track({.name = "box", .shape = "box", .p_WA_m = {1, 2, 3}}, record);
  EXPECT_EQ(track.at(kAt).p_WA_m[2], 3.0);
  EXPECT_EQ(track.at(kAt).shape, "box");
  EXPECT_FALSE(track.moves());
}

// Its model turns by a quarter, and the anchor is 1 m ahead in it.
TEST(AnchorTrack, FollowsItsModelAboutTheModelsOrigin) {
  const Anchor anchor{.name = "box",
                      .shape = "box",
                      .size_m = {1, 2, 3},
                      .p_WA_m = {1, 0, 0.5},
                      .path = {{Duration{0}, {0, 0, 0}, 0.0},
                               {std::chrono::seconds(1), {5, 0, 0}, 0.5 * std::numbers::pi}},
                      .p_WO_m = {0, 0, 0.5}};
  const Record record;
  const AnchorTrack track(anchor, record);
  EXPECT_TRUE(track.moves());
  const Anchor moved = track.at(kAt);
  EXPECT_NEAR(moved.p_WA_m[0], 5.0, 1e-12);
  EXPECT_NEAR(moved.p_WA_m[1], 1.0, 1e-12);
  EXPECT_NEAR(moved.p_WA_m[2], 0.5, 1e-12);
  EXPECT_NEAR(moved.q_WA[3], std::numbers::sqrt2 / 2.0, 1e-12);
  EXPECT_EQ(moved.size_m[2], 3.0);
  EXPECT_TRUE(moved.path.empty());
}

TEST(AnchorTrack, OfAUavFollowsItsGroundTruth) {
  const Record record = turning_flight();
  const AnchorTrack track(
      {.name = "uav1", .shape = "box", .p_WA_m = {7, 7, 7}, .uav = "uav1", .p_BA_m = {0.5, 0, 0.1}},
      record);
  EXPECT_TRUE(track.moves());
  const Anchor turned = track.at(SimTime(milliseconds(30)));
  EXPECT_NEAR(turned.p_WA_m[0], 2.0, 1e-12);
  EXPECT_NEAR(turned.p_WA_m[1], -0.5, 1e-12);
  EXPECT_NEAR(turned.p_WA_m[2], 0.1, 1e-12);
  EXPECT_NEAR(turned.q_WA[3], -std::numbers::sqrt2 / 2.0, 1e-12);
  EXPECT_EQ(track.at(kAt).p_WA_m[0], 7.0) << "the record ends before";
}

// Half of the way between its two messages.
TEST(MountedAt, ACameraBehindAJointIsTurnedAsTheGroundTruthSays) {
  Record record = turning_flight();
  record.header.suts.emplace_back().uav = "uav1";
  record.header.suts[0].joints = {{"yaw", {1, 0, 0}, {0, 0, 1}, -4, 4, 1}};
  record.ground_truth[0].message.joints_rad = {0.0};
  record.ground_truth[2].message.joints_rad = {std::numbers::pi};
  SensorInfo camera;
  camera.uav = "uav1";
  camera.camera = CameraInfo{.p_BS_m = {3, 0, 0}};
  const auto mounted = [&] { return mounted_at(camera, record, SimTime(milliseconds(15))); };
  EXPECT_EQ(mounted().camera->p_BS_m[0], 3.0) << "it is not behind the joint";
  camera.camera->joints = 1;
  EXPECT_NEAR(mounted().camera->p_BS_m[0], 1.0, 1e-12);
  EXPECT_NEAR(mounted().camera->p_BS_m[1], 2.0, 1e-12);
  EXPECT_NEAR(mounted().camera->q_BS[3], std::sqrt(0.5), 1e-12);
  camera.camera->joints = 7;
  EXPECT_NEAR(mounted().camera->p_BS_m[1], 2.0, 1e-12) << "of a damaged record";
}

}  // namespace
}  // namespace tether::record
