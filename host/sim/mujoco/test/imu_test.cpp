#include "test_simulator.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

// What IMUs of the whole simulator measure, against the motion that the truth shows.
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

TEST(ImuTest, HoversInTheSimulator) {
  const auto simulator = make_simulator(test_world());
  for (const Duration t : {0ms, 1ms, 500ms}) {
    simulator->advance_to(SimTime(t));
    const auto sample = measure_now<uav::ImuSample>(*simulator, kImu);
    EXPECT_LT(norm(sample.specific_force_m_s2 - Vec3{0.0, 0.0, kGravity}), 1e-3) << to_ns(t);
    EXPECT_LT(norm(sample.angular_velocity_rad_s), 1e-6);
  }
}

// At rest under an attitude of its own, and mounted any way: gravity upward, in its own frame.
TEST(ImuTest, TiltedAndTurnedAtRestInTheSimulator) {
  for (const uav::Quat& q_WB : {uav::from_rpy(0.4, 0.0, 0.0), uav::from_rpy(0.0, -0.3, 2.0),
                                uav::from_rpy(1.2, 0.7, -2.5)}) {
    for (const uav::Quat& q_BS : {uav::Quat{}, uav::from_rpy(std::numbers::pi, 0.2, 1.0)}) {
      World world = test_world();
      world.uavs[0].X_WB.q = q_WB;
      world.uavs[0].sensors[kImu].X_BS = {{0.1, 0.2, -0.3}, q_BS};
      const auto sample = measure_now<uav::ImuSample>(*make_simulator(world), kImu);
      const Vec3 up_S = rotate(inverse(q_WB * q_BS), {0.0, 0.0, 1.0});
      EXPECT_LT(norm(sample.specific_force_m_s2 - kGravity * up_S), 1e-9);
      EXPECT_LT(norm(sample.angular_velocity_rad_s), 1e-12);
      EXPECT_LT(norm(rotate(sample.q_WS, sample.specific_force_m_s2) - Vec3{0.0, 0.0, kGravity}),
                1e-9);
    }
  }
}

// A turn at a constant rate about the UAV's centre: an IMU off the centre is drawn towards it.
TEST(ImuTest, TurningAtAConstantRateInTheSimulator) {
  World world = test_world();
  const Pose X_BS{{0.3, 0.1, 0.0}, uav::from_rpy(0.5, -0.4, 0.8)};
  world.uavs[0].sensors[kImu].X_BS = X_BS;
  const auto simulator = make_simulator(world);
  simulator->apply(0, {{}, 1.5});
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

// Integrating the rates must give the attitude, whatever the mounting.
TEST(ImuTest, RatesIntegrateToTheAttitude) {
  World world = test_world();
  world.uavs[0].sensors[kImu].X_BS = {{0.1, -0.05, 0.02}, uav::from_rpy(0.3, -0.2, 1.0)};
  const auto simulator = make_simulator(world);
  simulator->apply(0, {{1.5, -1.0, 0.3}, 1.0});
  uav::Quat q_WS = measure_now<uav::ImuSample>(*simulator, kImu).q_WS;
  uav::Quat truth = q_WS;
  for (int i = 1; i <= 1000; ++i) {
    simulator->advance_to(SimTime(i * 1ms));
    const auto sample = measure_now<uav::ImuSample>(*simulator, kImu);
    const Vec3 w = sample.angular_velocity_rad_s;
    if (norm(w) > 0.0) {
      q_WS = q_WS * uav::from_axis_angle((1.0 / norm(w)) * w, 1e-3 * norm(w));
    }
    truth = sample.q_WS;
  }
  const uav::Quat error = inverse(truth) * q_WS;
  EXPECT_LT(2.0 * uav::norm({error.x, error.y, error.z}), 1e-6);
}

// The six channels of an IMU at rest, less what it truly measures.
std::array<double, 6> imu_errors(Simulator& simulator, const Snapshot& snapshot,
                                 std::uint64_t index) {
  const auto sample = std::get<uav::ImuSample>(simulator.measure(snapshot, 0, kImu, index));
  const Vec3& rate = sample.angular_velocity_rad_s;
  const Vec3& force = sample.specific_force_m_s2;
  return {rate.x, rate.y, rate.z, force.x, force.y, force.z - kGravity};
}

World world_with_imu_noise(const Noise& noise) {
  World world = test_world();
  auto& imu = std::get<ImuModel>(world.uavs[0].sensors[kImu].model);
  imu.angular_velocity.fill(noise);
  imu.linear_acceleration.fill(noise);
  return world;
}

// Means of products: the variance on the diagonal, no correlation off it.
TEST(ImuTest, NoiseIsIndependentBetweenAxesAndSamples) {
  const auto simulator = make_simulator(world_with_imu_noise({0.0, 0.5, 0.0, 0.0, 0.0, 0.0}));
  Snapshot snapshot;
  simulator->capture(snapshot);
  constexpr int kCount = 20'000;
  double products[6][6] = {};
  double with_last[6] = {};
  std::array<double, 6> last{};
  for (int n = 0; n < kCount; ++n) {
    const auto errors = imu_errors(*simulator, snapshot, static_cast<std::uint64_t>(n));
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) products[i][j] += errors[i] * errors[j] / kCount;
      with_last[i] += errors[i] * last[i] / kCount;
    }
    last = errors;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) EXPECT_NEAR(products[i][j], i == j ? 0.25 : 0.0, 0.012);
    EXPECT_NEAR(with_last[i], 0.0, 0.012);
  }
}

// Over many runs: each channel's constant bias, and the walking bias with the variance
// stddev²·τ/2·(1 − exp(−2t/τ)) at each time, independent of the other channels'.
TEST(ImuTest, BiasesOfManyRunsHaveTheirVariances) {
  constexpr double kTau_s = 0.2;
  constexpr double kStddev = 2.0;
  const auto simulator =
      make_simulator(world_with_imu_noise({0.0, 0.0, 0.7, 0.3, kStddev, kTau_s}));
  const std::array<Duration, 3> times{0ms, 60ms, 400ms};
  constexpr int kRuns = 600;
  double mean = 0.0;
  std::array<double, 3> variance{};
  double between_channels = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    simulator->reset(run);
    for (std::size_t t = 0; t < times.size(); ++t) {
      simulator->advance_to(SimTime(times[t]));
      Snapshot snapshot;
      simulator->capture(snapshot);
      const auto errors = imu_errors(*simulator, snapshot, 0);
      EXPECT_EQ(errors, imu_errors(*simulator, snapshot, 1)) << "a bias is not drawn per sample";
      for (std::size_t i = 0; i < 6; ++i) {
        if (t == 0) mean += errors[i] / (6 * kRuns);
        variance[t] += (errors[i] - 0.7) * (errors[i] - 0.7) / (6 * kRuns);
        between_channels += (errors[i] - 0.7) * (errors[(i + 1) % 6] - 0.7) / (18 * kRuns);
      }
    }
  }
  EXPECT_NEAR(mean, 0.7, 0.02);
  for (std::size_t t = 0; t < times.size(); ++t) {
    const double walked =
        0.5 * kStddev * kStddev * kTau_s * (1.0 - std::exp(-2.0 * to_seconds(times[t]) / kTau_s));
    EXPECT_NEAR(variance[t], 0.09 + walked, 0.1 * (0.09 + walked)) << t;
  }
  EXPECT_NEAR(between_channels, 0.0, 0.015);
}

// Integrating what the IMU measured must give the motion that the truth shows.
TEST(ImuTest, IntegratesToTheTrueMotion) {
  World world = test_world();
  world.uavs[0].sensors[kImu].X_BS = {{0.1, -0.05, 0.02}, uav::from_rpy(0.3, -0.2, 1.0)};
  const Pose X_BS = world.uavs[0].sensors[kImu].X_BS;
  const auto simulator = make_simulator(world);
  simulator->apply(0, {{1.0, 0.4, 0.3}, 1.0});
  Vec3 v_W{};
  Vec3 force_W{};
  for (int i = 1; i <= 1000; ++i) {
    simulator->advance_to(SimTime(i * 1ms));
    const auto sample = measure_now<uav::ImuSample>(*simulator, kImu);
    force_W = rotate(sample.q_WS, sample.specific_force_m_s2);
    v_W = v_W + 1e-3 * (force_W - Vec3{0.0, 0.0, kGravity});
  }
  const uav::BodyState body = simulator->ground_truth(0).body;
  const Vec3 v_WS = body.v_WB + rotate(body.q_WB, cross(body.w_WB_B, X_BS.p));
  EXPECT_GT(norm(v_WS), 0.5);
  EXPECT_LT(norm(v_W - v_WS), 0.01);
}

}  // namespace
}  // namespace tether::sim
