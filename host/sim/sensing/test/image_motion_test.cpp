#include "image_motion.h"

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

const uav::Pose kStart{{1.0, 2.0, 3.0}, uav::from_rpy(0.1, 0.2, 0.3)};

uav::Pose moved(const uav::Vec3& by, const uav::Vec3& axis, double angle_rad) {
  return kStart * uav::Pose{by, uav::from_axis_angle(axis, angle_rad)};
}

TEST(ImageMotionTest, RestIsNoMotion) {
  EXPECT_NEAR(camera_motion_px({kStart, kStart}, 1.0, 500.0), 0.0, 1e-12);
  EXPECT_NEAR(body_motion_px({kStart, kStart}, 1.0, {}, 0.1, 500.0), 0.0, 1e-12);
}

TEST(ImageMotionTest, TurningMovesEverythingAlike) {
  const Movement turn{kStart, moved({}, {0.0, 0.6, 0.8}, 0.01)};
  EXPECT_NEAR(camera_motion_px(turn, 0.1, 500.0), 5.0, 1e-6);
  const Movement back{kStart, moved({}, {0.0, 0.6, 0.8}, -0.01)};
  EXPECT_NEAR(camera_motion_px(back, 100.0, 500.0), 5.0, 1e-6);
}

TEST(ImageMotionTest, ShiftingMovesNearThingsMore) {
  const Movement shift{kStart, moved({0.0, 0.02, 0.0}, {1.0, 0.0, 0.0}, 0.0)};
  EXPECT_NEAR(camera_motion_px(shift, 2.0, 500.0), 5.0, 1e-9);
  EXPECT_NEAR(camera_motion_px(shift, 0.5, 500.0), 20.0, 1e-9);
}

TEST(ImageMotionTest, ABodyMovesAtItsNearestPoint) {
  const Movement shift{{}, {{0.0, 0.02, 0.0}, {}}};
  EXPECT_NEAR(body_motion_px(shift, 0.5, {-2.5, 0.02, 0.0}, 0.1, 500.0), 5.0, 1e-9);
  EXPECT_NEAR(body_motion_px(shift, 5.0, {-2.5, 0.02, 0.0}, 0.1, 500.0), 100.0, 1e-9)
      << "no nearer than the near plane";
  const Movement turn{{}, {{}, uav::from_axis_angle({0.0, 0.0, 1.0}, 0.1)}};
  EXPECT_NEAR(body_motion_px(turn, 0.5, {-2.5, 0.0, 0.0}, 0.1, 500.0), 12.5, 1e-6);
}

}  // namespace
}  // namespace tether::sim
