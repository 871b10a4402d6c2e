#include "sensors.h"

#include "test_worlds.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::kImu;
using testing::kRange;
using testing::make_simulator;
using testing::measure_now;
using testing::no_warnings;
using testing::test_world;
using uav::Pose;
using uav::Vec3;

using namespace std::chrono_literals;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGravity = 9.81;

Pose turned(const Vec3& axis, double angle_rad) {
  return {{}, uav::from_axis_angle(axis, angle_rad)};
}

uav::ImuSample imu_of(const Pose& X_BS, const Pose& X_WB, const BodyMotion& motion) {
  return measure_imu({}, X_BS, X_WB, motion, kGravity, {});
}

TEST(ImuTest, AtRestMeasuresGravityUpward) {
  const Pose X_BS = turned({1.0, 0.0, 0.0}, std::numbers::pi);
  EXPECT_LT(norm(imu_of({}, {}, {}).specific_force_m_s2 - Vec3{0.0, 0.0, kGravity}), 1e-12);
  EXPECT_LT(norm(imu_of(X_BS, {}, {}).specific_force_m_s2 - Vec3{0.0, 0.0, -kGravity}), 1e-9);
  const Pose pitched = turned({0.0, 1.0, 0.0}, 0.5 * std::numbers::pi);
  EXPECT_LT(norm(imu_of({}, pitched, {}).specific_force_m_s2 - Vec3{-kGravity, 0.0, 0.0}), 1e-9);
}

TEST(ImuTest, FreeFallMeasuresNothing) {
  const BodyMotion falling{{}, {0.0, 0.0, -kGravity}, {}};
  EXPECT_LT(norm(imu_of({}, turned({1.0, 0.0, 0.0}, 0.7), falling).specific_force_m_s2), 1e-12);
}

TEST(ImuTest, LeverArmAddsRotationalAcceleration) {
  const BodyMotion motion{{0.0, 0.0, 3.0}, {0.0, 0.0, -kGravity}, {0.0, 0.0, 5.0}};
  const uav::ImuSample sample = imu_of({{0.2, 0.0, 0.0}, {}}, {}, motion);
  EXPECT_LT(norm(sample.specific_force_m_s2 - Vec3{-9.0 * 0.2, 5.0 * 0.2, 0.0}), 1e-12);
  EXPECT_EQ(sample.angular_velocity_rad_s, motion.w_WB_B);
}

TEST(ImuTest, ReportsAttitudeOfTheSensor) {
  const Pose X_BS = turned({1.0, 0.0, 0.0}, 0.3);
  const Pose X_WB = turned({0.0, 0.0, 1.0}, 1.1);
  const uav::Quat expected = X_WB.q * X_BS.q;
  EXPECT_EQ(imu_of(X_BS, X_WB, {}).q_WS, expected);
}

TEST(ImuTest, HoversInTheSimulator) {
  const auto simulator = make_simulator(test_world());
  for (const Duration t : {0ms, 1ms, 500ms}) {
    simulator->advance_to(SimTime(t));
    const auto sample = measure_now<uav::ImuSample>(*simulator, kImu);
    EXPECT_LT(norm(sample.specific_force_m_s2 - Vec3{0.0, 0.0, kGravity}), 1e-3) << to_ns(t);
    EXPECT_LT(norm(sample.angular_velocity_rad_s), 1e-6);
  }
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

RangeModel range_model(double min_m, double max_m, double resolution_m) {
  return {min_m, max_m, resolution_m, {}};
}

TEST(RangeTest, LimitsAndResolution) {
  const RangeModel model = range_model(0.2, 4.0, 0.25);
  EXPECT_EQ(measure_range(model, 1.1, {}).range_m, 1.0);
  EXPECT_EQ(measure_range(model, 3.9, {}).range_m, 4.0);
  EXPECT_EQ(measure_range(model, 4.2, {}).range_m, kInfinity);
  EXPECT_EQ(measure_range(model, 0.1, {}).range_m, -kInfinity);
  EXPECT_EQ(measure_range(model, kInfinity, {}).range_m, kInfinity);
  EXPECT_EQ(measure_range(range_model(0.2, 4.0, 0.0), 1.1, {}).range_m, 1.1);
}

TEST(RangeTest, MeasuresTheNearestWallAhead) {
  World world = test_world();
  world.models.push_back(box_model("wall", {3.1, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  world.models.push_back(box_model("behind", {5.0, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m, 3.0, 1e-12);
  world.uavs[0].X_WB.q = uav::from_axis_angle({0.0, 0.0, 1.0}, 0.5);
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m,
              3.0 / std::cos(0.5), 1e-12);
  world.uavs[0].sensors[kRange].X_BS.q = uav::from_rpy(0.0, 0.5 * std::numbers::pi, 0.0);
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m, 1.0, 1e-12)
      << "the floor, through its own body";
}

TEST(RangeTest, SeesOtherUavs) {
  World world = test_world();
  world.uavs.push_back(testing::test_uav("beta", {2.2, 0.0, 1.0}));
  EXPECT_NEAR(measure_now<uav::RangeSample>(*make_simulator(world), kRange).range_m, 2.0, 1e-12);
}

TEST(RangeTest, MeasuresAsOfTheSnapshot) {
  World world = test_world();
  world.models.push_back(box_model("wall", {3.1, 0.0, 1.0}, {0.2, 6.0, 3.0}, {1.0, 1.0, 1.0}));
  const auto simulator = make_simulator(world);
  Snapshot snapshot;
  simulator->capture(snapshot);
  simulator->apply(0, {{1.0, 0.0, 0.0}, 0.0});
  simulator->advance_to(SimTime(1s));
  const auto then = std::get<uav::RangeSample>(simulator->measure(snapshot, 0, kRange, 0));
  EXPECT_NEAR(then.range_m, 3.0, 1e-12);
  EXPECT_LT(measure_now<uav::RangeSample>(*simulator, kRange).range_m, 2.9);
}

}  // namespace
}  // namespace tether::sim
