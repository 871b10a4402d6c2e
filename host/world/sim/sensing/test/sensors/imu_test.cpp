#include "sensors/imu.h"

#include <array>
#include <numbers>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

constexpr double kGravity = 9.81;

Pose turned(const Vec3& axis, double angle_rad) {
  return {{}, uav::from_axis_angle(axis, angle_rad)};
}

uav::ImuSample imu_of(const Pose& X_BS, const Pose& X_WB, const BodyMotion& motion) {
  return measure_imu({}, X_BS, X_WB, motion, {0.0, 0.0, kGravity}, {});
}

TEST(ImuTest, AtRestMeasuresGravityUpward) {
  const Pose X_BS = turned({1.0, 0.0, 0.0}, std::numbers::pi);
  EXPECT_LT(norm(imu_of({}, {}, {}).specific_force_m_s2 - Vec3{0.0, 0.0, kGravity}), 1e-12);
  EXPECT_LT(norm(imu_of(X_BS, {}, {}).specific_force_m_s2 - Vec3{0.0, 0.0, -kGravity}), 1e-9);
  const Pose pitched = turned({0.0, 1.0, 0.0}, 0.5 * std::numbers::pi);
  EXPECT_LT(norm(imu_of({}, pitched, {}).specific_force_m_s2 - Vec3{-kGravity, 0.0, 0.0}), 1e-9);
  EXPECT_EQ(imu_of(X_BS, pitched, {}).q_WS, pitched.q * X_BS.q);
}

TEST(ImuTest, LeverArmAddsRotationalAcceleration) {
  const BodyMotion motion{{0.0, 0.0, 3.0}, {0.0, 0.0, -kGravity}, {0.0, 0.0, 5.0}};
  const uav::ImuSample sample = imu_of({{0.2, 0.0, 0.0}, {}}, {}, motion);
  EXPECT_LT(norm(sample.specific_force_m_s2 - Vec3{-9.0 * 0.2, 5.0 * 0.2, 0.0}), 1e-12);
  EXPECT_EQ(sample.angular_velocity_rad_s, motion.w_WB_B);
}

// Means of products: the variance on the diagonal, no correlation off it.
TEST(ImuTest, NoiseIsIndependentBetweenAxesAndSamples) {
  ImuModel imu;
  imu.angular_velocity.fill({0.0, 0.5, 0.0, 0.0, 0.0, 0.0});
  imu.linear_acceleration = imu.angular_velocity;
  constexpr int kCount = 20'000;
  double products[7][7] = {};
  std::array<double, 7> errors{};
  for (std::uint64_t n = 0; n < kCount; ++n) {
    const auto s = measure_imu(imu, {}, {}, {}, {0.0, 0.0, kGravity}, {0, "alpha", "imu", n, {}});
    const Vec3 &w = s.angular_velocity_rad_s, &f = s.specific_force_m_s2;
    errors = {w.x, w.y, w.z, f.x, f.y, f.z - kGravity, errors[0]};
    for (std::size_t i = 0; i < 7; ++i) {
      for (std::size_t j = 0; j < 7; ++j) products[i][j] += errors[i] * errors[j] / kCount;
    }
  }
  for (std::size_t i = 0; i < 7; ++i) {
    for (std::size_t j = 0; j < 7; ++j) EXPECT_NEAR(products[i][j], i == j ? 0.25 : 0.0, 0.012);
  }
}

}  // namespace
}  // namespace tether::sim
