#include "dead_reckoning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/base/units.h>

namespace tether::tasks {
namespace {

using uav::Vec3;

constexpr double kPi = std::numbers::pi;

/// What an IMU reads on a body that accelerates by `a_W` at the attitude `q_WB`.
uav::ImuSample reading(double at_s, const Vec3& a_W, const uav::Quat& q_WB = {},
                       const uav::Quat& q_BS = {}, const Vec3& bias_S = {}) {
  uav::ImuSample sample;
  sample.sampled_at = SimTime(duration_from_seconds(at_s));
  sample.q_WS = q_WB * q_BS;
  sample.specific_force_m_s2 =
      rotate(inverse(sample.q_WS), a_W + Vec3{0, 0, kGravity_m_s2}) + bias_S;
  return sample;
}

uav::Quat heading(double yaw_rad) {
  return uav::from_rpy(0, 0, yaw_rad);
}

TEST(DeadReckoning, StaysAtOriginAtRest) {
  DeadReckoning reckoning;
  for (int i = 0; i < 200; ++i) {
    reckoning.update(reading(0.05 * i, {}, uav::from_rpy(0.1, -0.2, 0.5)));
  }
  EXPECT_NEAR(norm(reckoning.position_m()), 0.0, 1e-9);
  EXPECT_NEAR(reckoning.path_length_m(), 0.0, 1e-9);
  EXPECT_EQ(reckoning.yaw_rad(), 0.0);
}

TEST(DeadReckoning, ConstantAccelerationInTheStartHeadingFrame) {
  DeadReckoning reckoning;
  const double yaw = rad_from_deg(120);
  const Vec3 a_H0{0.4, -0.2, 0.1};
  for (int i = 0; i <= 100; ++i) {
    reckoning.update(reading(3.0 + 0.02 * i, rotate(heading(yaw), a_H0), heading(yaw)));
  }
  // 2 s; the trapezoidal rule takes the position's parabola for straight pieces, without error at
  // their ends.
  EXPECT_NEAR(norm(reckoning.velocity_m_s() - 2.0 * a_H0), 0.0, 1e-9);
  EXPECT_NEAR(norm(reckoning.position_m() - 2.0 * a_H0), 0.0, 1e-9);
  EXPECT_NEAR(reckoning.path_length_m(), 2.0 * std::hypot(0.4, 0.2), 1e-9);
}

/// x = 1 − cos(2πt): a second out and back, with a tilt that goes with it and an IMU mounted askew.
TEST(DeadReckoning, ASwingWithTiltAndMounting) {
  const uav::Quat q_BS = uav::from_rpy(0.2, -0.4, 1.1);
  DeadReckoning reckoning(q_BS);
  double furthest = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    const double a = 4.0 * kPi * kPi * std::cos(2.0 * kPi * t);
    const uav::Quat q_WB = uav::from_rpy(0.0, 0.3 * std::cos(2.0 * kPi * t), 0.0);
    reckoning.update(reading(t, {a, 0, 0}, q_WB, q_BS));
    furthest = std::max(furthest, reckoning.position_m().x);
  }
  EXPECT_NEAR(furthest, 2.0, 2e-3);
  EXPECT_NEAR(norm(reckoning.position_m()), 0.0, 2e-3);
  EXPECT_NEAR(reckoning.path_length_m(), 4.0, 4e-3);
}

TEST(DeadReckoning, ACircleWithTheNoseAlongIt) {
  DeadReckoning reckoning;
  // Radius 1 m at 1 rad/s, but from rest: speed and turn set in over the first second.
  const double dt = 0.005;
  Vec3 p, v;
  double yaw = 0.3;
  for (int i = 0; i <= 1200; ++i) {
    const double speed = std::min(1.0, dt * i);
    const double along = i * dt < 1.0 ? 1.0 : 0.0;
    const Vec3 a_W = rotate(heading(yaw), {along, speed * speed, 0});
    reckoning.update(reading(dt * i, a_W, heading(yaw)));
    p = p + dt * v;
    v = rotate(heading(yaw), {speed, 0, 0});
    yaw += dt * speed;
  }
  const Vec3 p_H0 = rotate(heading(-0.3), p);
  EXPECT_NEAR(norm(reckoning.position_m() - p_H0), 0.0, 0.03);
  EXPECT_NEAR(wrap_angle_rad(reckoning.yaw_rad() - (yaw - dt - 0.3)), 0.0, 1e-6);
}

TEST(DeadReckoning, LearnsTheBiasAtRest) {
  const Vec3 bias{0.05, -0.03, 0.02};
  const uav::Quat q_BS = uav::from_rpy(0, 0, 0.5);
  DeadReckoning blind(q_BS), calibrated(q_BS);
  for (int i = 0; i < 10; ++i) {
    calibrated.calibrate(reading(0.05 * i, {}, heading(1.0), q_BS, bias));
  }
  for (int i = 10; i <= 210; ++i) {
    const auto sample = reading(0.05 * i, {}, heading(1.0), q_BS, bias);
    blind.update(sample);
    calibrated.update(sample);
  }
  EXPECT_NEAR(norm(blind.position_m()), 0.5 * norm(bias) * 100.0, 1e-6);
  EXPECT_NEAR(norm(calibrated.position_m()), 0.0, 1e-9);
}

TEST(DeadReckoning, IgnoresAReadingThatIsNotYounger) {
  DeadReckoning reckoning;
  reckoning.update(reading(1.0, {}));
  reckoning.update(reading(2.0, {1, 0, 0}));
  const Vec3 before = reckoning.position_m();
  reckoning.update(reading(2.0, {5, 0, 0}));
  reckoning.update(reading(0.5, {5, 0, 0}));
  EXPECT_EQ(reckoning.position_m(), before);
}

}  // namespace
}  // namespace tether::tasks
