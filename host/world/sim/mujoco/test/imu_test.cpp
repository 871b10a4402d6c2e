#include "test_simulator.h"

#include <gtest/gtest.h>

// IMU samples of the whole simulator against the true motion.
namespace tether::sim {
namespace {

using testing::kImu;
using testing::make_simulator;
using testing::measure_now;
using testing::test_world;
using uav::Pose;
using uav::Vec3;

using namespace std::chrono_literals;

constexpr double kGravity = 9.81;

// A turn at a constant rate about the UAV's centre: an IMU off the centre is drawn towards it.
TEST(ImuTest, TurningAtAConstantRateInTheSimulator) {
  World world = test_world();
  const Pose X_BS{{0.3, 0.1, 0.0}, uav::from_rpy(0.5, -0.4, 0.8)};
  world.uavs[0].sensors[kImu].X_BS = X_BS;
  const auto simulator = make_simulator(world);
  simulator->apply(0, uav::to_setpoint({{}, 1.5}));
  simulator->advance_to(SimTime(5s));
  const auto sample = measure_now<uav::ImuSample>(*simulator, kImu);
  const double rate_rad_s = simulator->ground_truth(0).body.w_WB_B.z;
  EXPECT_NEAR(rate_rad_s, 1.5, 0.02);
  const Vec3 rate_B = rotate(X_BS.q, sample.angular_velocity_rad_s);
  const Vec3 force_B = rotate(X_BS.q, sample.specific_force_m_s2);
  EXPECT_LT(norm(rate_B - Vec3{0.0, 0.0, rate_rad_s}), 1e-3);
  const Vec3 centripetal = -rate_rad_s * rate_rad_s * X_BS.p;
  EXPECT_LT(norm(force_B - centripetal - Vec3{0.0, 0.0, kGravity}), 5e-3);
}

// Integrating the measurements must give the true motion, whatever the mounting.
TEST(ImuTest, IntegratesToTheTrueMotion) {
  World world = test_world();
  const Pose X_BS{{0.1, -0.05, 0.02}, uav::from_rpy(0.3, -0.2, 1.0)};
  world.uavs[0].sensors[kImu].X_BS = X_BS;
  const auto simulator = make_simulator(world);
  const auto at_rest = measure_now<uav::ImuSample>(*simulator, kImu);
  EXPECT_LT(norm(rotate(X_BS.q, at_rest.specific_force_m_s2) - Vec3{0.0, 0.0, kGravity}), 1e-9);
  simulator->apply(0, uav::to_setpoint({{1.0, 0.4, 0.3}, 1.0}));
  Vec3 v_W{};
  uav::Quat q_WS = at_rest.q_WS, truth = q_WS;
  for (int i = 1; i <= 1000; ++i) {
    simulator->advance_to(SimTime(i * 1ms));
    const auto sample = measure_now<uav::ImuSample>(*simulator, kImu);
    const Vec3 w = sample.angular_velocity_rad_s;
    if (norm(w) > 0.0) q_WS = q_WS * uav::from_axis_angle((1.0 / norm(w)) * w, 1e-3 * norm(w));
    truth = sample.q_WS;
    v_W = v_W + 1e-3 * (rotate(truth, sample.specific_force_m_s2) - Vec3{0.0, 0.0, kGravity});
  }
  const uav::Quat error = inverse(truth) * q_WS;
  EXPECT_LT(2.0 * norm(Vec3{error.x, error.y, error.z}), 1e-6);
  const uav::BodyState body = simulator->ground_truth(0).body;
  const Vec3 v_WS = body.v_WB + rotate(body.q_WB, cross(body.w_WB_B, X_BS.p));
  EXPECT_GT(norm(v_WS), 0.5);
  EXPECT_LT(norm(v_W - v_WS), 0.01);
}

}  // namespace
}  // namespace tether::sim
