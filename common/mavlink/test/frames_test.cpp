#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <tether/mavlink/frame.h>

namespace tether::mavlink {
namespace {

using uav::Quat;
using uav::Vec3;

constexpr double kPi = std::numbers::pi;

TEST(Frames, NorthEastDownIsEastNorthUp) {
  EXPECT_EQ(ned_from_enu(Vec3{1.0, 2.0, 3.0}), (Vec3{2.0, 1.0, -3.0}));
  EXPECT_EQ(enu_from_ned(ned_from_enu(Vec3{1.0, 2.0, 3.0})), (Vec3{1.0, 2.0, 3.0}));
  EXPECT_EQ(frd_from_flu(Vec3{1.0, 2.0, 3.0}), (Vec3{1.0, -2.0, -3.0}));
}

TEST(Frames, YawIsClockwiseFromNorth) {
  EXPECT_NEAR(ned_from_enu_yaw(0.0), kPi / 2.0, 1e-12);
  EXPECT_NEAR(ned_from_enu_yaw(kPi / 2.0), 0.0, 1e-12);
  EXPECT_NEAR(ned_from_enu_yaw(-kPi / 2.0), kPi, 1e-12);
  for (const double yaw : {-3.0, -1.0, 0.3, 2.9})
    EXPECT_NEAR(enu_from_ned_yaw(ned_from_enu_yaw(yaw)), yaw, 1e-12);
}

// A vector of the body has the same direction in the world, whichever frames it is written in.
TEST(Frames, AttitudesTurnVectorsAlike) {
  for (const double roll : {-0.7, 0.0, 0.4})
    for (const double pitch : {-0.5, 0.0, 1.2})
      for (const double yaw : {-3.0, 0.0, 1.0}) {
        const Quat q_WB = uav::from_rpy(roll, pitch, yaw);
        const Quat q_NED = ned_from_enu(q_WB);
        const Vec3 v_flu{0.3, -1.1, 0.7};
        const Vec3 expected = ned_from_enu(rotate(q_WB, v_flu));
        const Vec3 got = rotate(q_NED, frd_from_flu(v_flu));
        EXPECT_LT(norm(expected - got), 1e-12);
        EXPECT_LT(norm(rotate(enu_from_ned(q_NED), v_flu) - rotate(q_WB, v_flu)), 1e-12);
      }
}

// The heading of the quaternion is that of the yaw alone, at any tilt that has a heading.
TEST(Frames, YawsOfAttitudesAreYaws) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> yaws(-kPi, kPi), tilts(-1.4, 1.4);
  for (int i = 0; i < 500; ++i) {
    const double yaw = yaws(random);
    const Quat q_NED = ned_from_enu(uav::from_rpy(tilts(random), tilts(random), yaw));
    const double turned = uav::yaw_rad(q_NED) - ned_from_enu_yaw(yaw);
    EXPECT_NEAR(std::remainder(turned, 2.0 * kPi), 0.0, 1e-9);
    EXPECT_NEAR(std::remainder(enu_from_ned_yaw(ned_from_enu_yaw(yaw)) - yaw, 2.0 * kPi), 0.0,
                1e-12);
  }
}

// Rotations of vectors between the frames keep lengths and the sense of cross products.
TEST(Frames, AreRightHanded) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Vec3 a{normal(random), normal(random), normal(random)};
    const Vec3 b{normal(random), normal(random), normal(random)};
    EXPECT_LT(norm(ned_from_enu(cross(a, b)) - cross(ned_from_enu(a), ned_from_enu(b))), 1e-12);
    EXPECT_LT(norm(frd_from_flu(cross(a, b)) - cross(frd_from_flu(a), frd_from_flu(b))), 1e-12);
    EXPECT_EQ(enu_from_ned(ned_from_enu(a)), a);
    EXPECT_EQ(flu_from_frd(frd_from_flu(a)), a);
  }
}

TEST(Frames, AnUprightVehicleThatHeadsNorthIsTheIdentity) {
  const Quat q = ned_from_enu(uav::from_rpy(0.0, 0.0, kPi / 2.0));
  EXPECT_NEAR(q.w, 1.0, 1e-12);
}

}  // namespace
}  // namespace tether::mavlink
