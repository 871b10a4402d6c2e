// The expected figures are worked out by hand in the comments: rays from a pinhole.
#include "flight.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/campaign/metrics.h>

namespace tether::campaign {
namespace {

using std::chrono::milliseconds;

record::SensorInfo camera_turned(double yaw_rad, double pitch_rad = 0.0) {
  record::SensorInfo sensor = camera();
  const uav::Quat q = uav::from_rpy(0.0, pitch_rad, yaw_rad);
  double* const q_BS = sensor.camera->q_BS;
  q_BS[0] = q.w, q_BS[1] = q.x, q_BS[2] = q.y, q_BS[3] = q.z;
  return sensor;
}

record::Anchor anchor(const std::string& shape, const uav::Vec3& size_m, const uav::Vec3& p_WA_m) {
  return {
      "box", shape, {size_m.x, size_m.y, size_m.z}, {p_WA_m.x, p_WA_m.y, p_WA_m.z}, {1, 0, 0, 0}};
}
record::Anchor cube_at(double x_m, double y_m, double z_m = 0.0) {
  return anchor("box", {1.0, 1.0, 1.0}, {x_m, y_m, z_m});
}

void expect_rect(const std::optional<PixelRect>& roi, const PixelRect& expected,
                 double within_px = 1e-9) {
  ASSERT_TRUE(roi);
  EXPECT_NEAR(roi->left_px, expected.left_px, within_px);
  EXPECT_NEAR(roi->top_px, expected.top_px, within_px);
  EXPECT_NEAR(roi->right_px, expected.right_px, within_px);
  EXPECT_NEAR(roi->bottom_px, expected.bottom_px, within_px);
}

// ---- true_roi

TEST(TrueRoi, OfABoxReachesFromEdgeToEdge) {
  // Ahead, the front face is 4 m from the camera: slopes of 0.5 / 4, 40 px.
  const PixelRect ahead{279.5, 199.5, 359.5, 279.5};
  expect_rect(true_roi(camera(), {}, cube_at(4.6, 0.0)), ahead);
  // Left: the near corner, 2.5 / 4, 200 px. Right: the far corner, 1.5 / 5, 96 px.
  expect_rect(true_roi(camera(), {}, cube_at(4.6, 2.0)), {119.5, 199.5, 223.5, 279.5});
  // Above: from the far lower corner, 1.5 / 5, to the near upper one, 2.5 / 4.
  expect_rect(true_roi(camera(), {}, cube_at(4.6, 0.0, 2.0)), {279.5, 39.5, 359.5, 143.5});
  // Turned with the UAV, and with the mounting.
  const uav::Pose north{{7.0, -3.0, 0.0}, uav::from_rpy(0.0, 0.0, rad_from_deg(90.0))};
  expect_rect(true_roi(camera(), north, cube_at(7.0, 1.6)), ahead);
  expect_rect(true_roi(camera_turned(rad_from_deg(90.0)), {}, cube_at(0.1, 4.5)), ahead);
  // Beyond the image.
  expect_rect(true_roi(camera(), {}, cube_at(1.6, 1.0)),
              {319.5 - 480.0, 79.5, 319.5 - 80.0, 399.5});
}

// Turned by 45 degrees about its z, a cube of 1 m shows an edge, 0.7071 m nearer than its centre,
// and is 1.4142 m wide; left and right corners are 4.5 m away.
TEST(TrueRoi, TurnsWithTheAnchor) {
  record::Anchor cube = cube_at(4.6, 0.0);
  cube.q_WA[0] = std::cos(rad_from_deg(22.5));
  cube.q_WA[3] = std::sin(rad_from_deg(22.5));
  const double half_width_px = 320.0 * std::sqrt(0.5) / 4.5;
  const double half_height_px = 320.0 * 0.5 / (4.5 - std::sqrt(0.5));
  expect_rect(true_roi(camera(), {}, cube), {319.5 - half_width_px, 239.5 - half_height_px,
                                             319.5 + half_width_px, 239.5 + half_height_px});
}

// Tangents to a sphere of 0.5 m at 4 m make an angle of asin(1 / 8) with its direction.
TEST(TrueRoi, OfASphereIsItsSilhouette) {
  const record::Anchor ahead = anchor("sphere", {1.0, 1.0, 1.0}, {4.1, 0.0, 0.0});
  const double half_px = 320.0 * std::tan(std::asin(0.125));
  expect_rect(true_roi(camera(), {}, ahead),
              {319.5 - half_px, 239.5 - half_px, 319.5 + half_px, 239.5 + half_px}, 0.01);

  const double aside_rad = rad_from_deg(30.0);
  const record::Anchor aside = anchor(
      "sphere", {1.0, 1.0, 1.0}, {0.1 + 4.0 * std::cos(aside_rad), 4.0 * std::sin(aside_rad), 0.0});
  const auto roi = true_roi(camera(), {}, aside);
  ASSERT_TRUE(roi);
  EXPECT_NEAR(roi->left_px, 319.5 - 320.0 * std::tan(aside_rad + std::asin(0.125)), 0.02);
  EXPECT_NEAR(roi->right_px, 319.5 - 320.0 * std::tan(aside_rad - std::asin(0.125)), 0.02);
  EXPECT_NEAR(roi_bearing_rad(camera(), *roi), aside_rad, 1e-4);
}

// As wide as the sphere; as high as the nearest points of its rims, 1 m up and down at 3.5 m.
TEST(TrueRoi, OfACylinderReachesToItsRims) {
  const record::Anchor column = anchor("cylinder", {1.0, 1.0, 2.0}, {4.1, 0.0, 0.0});
  const double half_width_px = 320.0 * std::tan(std::asin(0.125));
  const double half_height_px = 320.0 / 3.5;
  expect_rect(true_roi(camera(), {}, column),
              {319.5 - half_width_px, 239.5 - half_height_px, 319.5 + half_width_px,
               239.5 + half_height_px},
              0.01);
}

// k1 = −0.2 draws the corners (r² = 0.03125) further in than the middles of the edges (0.015625),
// which then bound the rectangle: 40 px · (1 − 0.2 · 0.015625).
TEST(TrueRoi, FollowsTheLens) {
  record::SensorInfo barrel = camera();
  barrel.camera->k1 = -0.2;
  expect_rect(true_roi(barrel, {}, cube_at(4.6, 0.0)), {279.625, 199.625, 359.375, 279.375});
}

TEST(TrueRoi, IsNoneIfThereIsNoImage) {
  EXPECT_FALSE(true_roi(camera(), {}, cube_at(-4.0, 0.0)));
  EXPECT_FALSE(true_roi(camera(), {}, cube_at(0.4, 2.0)));  // half behind
  EXPECT_FALSE(true_roi(camera(), {}, anchor("sphere", {1, 1, 1}, {0.3, 0.0, 0.0})));  // within it
  EXPECT_FALSE(true_roi(camera(), {}, anchor("teapot", {1, 1, 1}, {4.0, 0.0, 0.0})));
  record::SensorInfo unknown = camera();
  unknown.camera.reset();
  EXPECT_FALSE(true_roi(unknown, {}, cube_at(4.6, 0.0)));
}

// At a slope of 2 this polynomial gives 2 · (1 − 0.3 · 4) = −0.4: in the image, on the other side.
TEST(TrueRoi, IsNoneWhereTheDistortionFoldsBack) {
  record::SensorInfo barrel = camera();
  barrel.camera->k1 = -0.3;
  EXPECT_FALSE(true_roi(barrel, {}, anchor("box", {0.1, 0.1, 0.1}, {2.1, 4.0, 0.0})));
  EXPECT_TRUE(true_roi(barrel, {}, anchor("box", {0.1, 0.1, 0.1}, {2.1, 0.4, 0.0})));
}

// ---- visible_part, is_cut

TEST(VisiblePart, IsWithinTheImage) {
  const PixelRect inside{10.0, 20.0, 30.0, 40.0}, beside{640.0, 0.0, 700.0, 10.0};
  const PixelRect across{-160.5, 79.5, 239.5, 700.0};
  EXPECT_EQ(visible_part(camera(), inside), inside);
  EXPECT_EQ(visible_part(camera(), across), (PixelRect{-0.5, 79.5, 239.5, 479.5}));
  EXPECT_FALSE(visible_part(camera(), beside));
  EXPECT_FALSE(is_cut(camera(), inside));
  EXPECT_TRUE(is_cut(camera(), across) && is_cut(camera(), beside));
}

// ---- roi_bearing_rad

TEST(RoiBearing, IsHalfwayAsAnAngle) {
  const auto roi = true_roi(camera(), {}, cube_at(4.6, 2.0));
  ASSERT_TRUE(roi);
  EXPECT_NEAR(roi_bearing_rad(camera(), *roi), 0.5 * (std::atan(0.625) + std::atan(0.3)), 1e-12);
}

TEST(RoiBearing, IsRelativeToTheBodysHeading) {
  const PixelRect middle{309.5, 229.5, 329.5, 249.5};
  EXPECT_NEAR(roi_bearing_rad(camera_turned(rad_from_deg(30.0)), middle), rad_from_deg(30.0),
              1e-12);
  const double through_the_back_rad =
      roi_bearing_rad(camera_turned(rad_from_deg(180.0)), {309.5, 229.5, 349.5, 249.5});
  EXPECT_NEAR(wrap_angle_rad(through_the_back_rad + std::numbers::pi),
              -0.5 * (std::atan(30.0 / 320.0) - std::atan(10.0 / 320.0)), 1e-12);
}

// Looking down by 30 degrees, a ray of slope 0.5 to the left has components (cos 30°, 0.5).
TEST(RoiBearing, IsTheHorizontalAngleOfAPitchedCamera) {
  const record::SensorInfo down = camera_turned(0.0, rad_from_deg(30.0));
  const PixelRect thin{159.5, 229.5, 159.5, 249.5};
  EXPECT_NEAR(roi_bearing_rad(down, thin), std::atan2(0.5, std::cos(rad_from_deg(30.0))), 1e-12);
}

}  // namespace
}  // namespace tether::campaign
