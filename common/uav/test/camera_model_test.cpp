#include <numbers>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/base/units.h>
#include <tether/uav/camera_model.h>

namespace tether::uav {
namespace {

CameraModel ideal() {
  return CameraModel::from_horizontal_fov(640, 480, rad_from_deg(80));
}

/// A wide webcam lens: barrel distortion with some decentring.
CameraModel distorted() {
  const CameraModel m = ideal();
  return {m.width_px, m.height_px, m.fx_px, m.fy_px, m.cx_px, m.cy_px,
          -0.25,      0.08,        -0.01,   0.001,   -0.0015};
}

TEST(CameraModel, CentredWithTheGivenFieldOfView) {
  const CameraModel m = ideal();
  EXPECT_DOUBLE_EQ(m.cx_px, 319.5);
  EXPECT_DOUBLE_EQ(m.cy_px, 239.5);
  EXPECT_DOUBLE_EQ(m.fx_px, m.fy_px);
  EXPECT_NEAR(m.horizontal_fov_rad(), rad_from_deg(80), 1e-12);
  EXPECT_FALSE(m.has_distortion());
  EXPECT_TRUE(distorted().has_distortion());
}

TEST(CameraModel, ProjectsInTheOpticalFrame) {
  const CameraModel m = ideal();
  const auto right_below = m.project({1, 0.5, 2});
  ASSERT_TRUE(right_below);
  EXPECT_DOUBLE_EQ(right_below->u_px, m.cx_px + 0.5 * m.fx_px);
  EXPECT_DOUBLE_EQ(right_below->v_px, m.cy_px + 0.25 * m.fy_px);
  for (const double z : {0.0, -1.0, std::nan("")}) EXPECT_FALSE(m.project({0.1, 0, z})) << z;
}

TEST(CameraModel, ContainsWholePixels) {
  const CameraModel m = ideal();
  for (const Pixel& pixel : {Pixel{-0.5, -0.5}, {639.49, 479.49}}) EXPECT_TRUE(m.contains(pixel));
  for (const Pixel& pixel : {Pixel{639.5, 0}, {0, 479.5}, {-0.51, 0}, {0, -0.51}})
    EXPECT_FALSE(m.contains(pixel));
}

TEST(CameraModel, BarrelDistortionPullsInwards) {
  const Vec3 p_C{0.7, 0.4, 1};
  EXPECT_LT(distorted().project(p_C)->u_px, ideal().project(p_C)->u_px);
  EXPECT_LT(distorted().project(p_C)->v_px, ideal().project(p_C)->v_px);
}

TEST(CameraModel, UnprojectInvertsProjectAnywhereInTheImage) {
  KeyedRandom random({7, 0, 0});
  for (const CameraModel& m : {ideal(), distorted()}) {
    for (int i = 0; i < 2000; ++i) {
      const Pixel pixel{640 * random.uniform() - 0.5, 480 * random.uniform() - 0.5};
      const auto back = m.project(3.0 * m.unproject(pixel));
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->u_px, pixel.u_px, 1e-6);
      EXPECT_NEAR(back->v_px, pixel.v_px, 1e-6);
    }
  }
}

TEST(PixelRays, HaveNoneWhereTheDistortionFolds) {
  CameraModel m = distorted();
  for (const bool folds : {false, true}) {
    if (folds) m.k1 = -0.9;
    const PixelRays rays(m);
    const auto corner = rays.at({0.0, 0.0});
    EXPECT_EQ(corner.has_value(), !folds);
    const auto middle = rays.at({m.cx_px + 10.0, m.cy_px});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(m.project(*middle)->u_px, m.cx_px + 10.0, 1e-6);
  }
}

TEST(Bearing, IsCounterClockwiseAndThatOfTheVisiblePoint) {
  EXPECT_NEAR(bearing_rad(ideal(), {-0.5, 200}), rad_from_deg(40), 1e-12);
  EXPECT_NEAR(bearing_rad(ideal(), {639.5, 200}), rad_from_deg(-40), 1e-12);
  const CameraModel m = distorted();
  for (double deg = -35; deg <= 35; deg += 5) {
    const double angle = rad_from_deg(deg);
    const Vec3 p_B{2 * std::cos(angle), 2 * std::sin(angle), 0.3};
    const auto pixel = m.project(rotate(inverse(q_body_from_optical()), p_B));
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(bearing_rad(m, *pixel), angle, 1e-9) << deg;
  }
}

}  // namespace
}  // namespace tether::uav
