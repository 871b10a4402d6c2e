#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/sim/simulator.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

/// The contract of every back end (tether/sim/simulator.h), as tests to be instantiated for each:
///
///   INSTANTIATE_TEST_SUITE_P(Name, SimulatorContract, ::testing::Values(SimulatorMaker(…)));
namespace tether::sim::testing {

/// Makes a back end for a world of boxes. Shared: it may be part of a larger object.
using SimulatorMaker = std::function<std::shared_ptr<Simulator>(World world)>;

class SimulatorContract : public ::testing::TestWithParam<SimulatorMaker> {
 protected:
  static SimTime at(Duration d) { return SimTime(d); }
  static std::shared_ptr<Simulator> make(World world) { return GetParam()(std::move(world)); }
};

TEST_P(SimulatorContract, SameSeedSameBytesHoweverTheRunIsSplit) {
  const auto a = make(busy_world());
  const auto b = make(busy_world());
  const Observation whole = fly_in_one_piece(*a, 5);
  EXPECT_EQ(whole, fly_in_pieces(*b, 5));
  EXPECT_EQ(whole, fly_in_one_piece(*a, 5)) << "after a reset";
  EXPECT_NE(whole.numbers, fly_in_one_piece(*a, 6).numbers);
}

TEST_P(SimulatorContract, StartsHoveringAtStZero) {
  const auto simulator = make(test_world());
  EXPECT_EQ(simulator->now(), SimTime{});
  EXPECT_EQ(simulator->ground_truth(0).body.p_WB, (uav::Vec3{0.0, 0.0, 1.0}));
  EXPECT_EQ(simulator->ground_truth(0).body.v_WB, uav::Vec3{});
  simulator->advance_to(at(std::chrono::milliseconds(50)));
  EXPECT_EQ(simulator->now(), at(std::chrono::milliseconds(50)));
  EXPECT_EQ(simulator->ground_truth(0).at, at(std::chrono::milliseconds(50)));
  EXPECT_NEAR(simulator->ground_truth(0).body.p_WB.z, 1.0, 1e-3);
}

TEST_P(SimulatorContract, FollowsTheCommandFromNowOn) {
  const auto simulator = make(test_world());
  simulator->advance_to(at(std::chrono::milliseconds(100)));
  simulator->apply(0, uav::to_setpoint({{9.0, 0.0, 0.0}, 0.0}));
  simulator->apply(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.0}));
  EXPECT_NEAR(simulator->ground_truth(0).body.v_WB.x, 0.0, 1e-6);
  simulator->advance_to(at(std::chrono::seconds(3)));
  EXPECT_NEAR(simulator->ground_truth(0).body.v_WB.x, 1.0, 0.1);
  simulator->reset(1);
  simulator->advance_to(at(std::chrono::seconds(1)));
  EXPECT_NEAR(simulator->ground_truth(0).body.v_WB.x, 0.0, 1e-3) << "commands end with a reset";
}

/// What a UAV must do after a second of a set-point: those that are not near a limit.
struct FlownLevel {
  uav::Setpoint setpoint;
  std::function<bool(const uav::BodyState&)> is_followed;
};
inline std::vector<FlownLevel> flown_levels(const uav::MultirotorParameters& airframe,
                                            double gravity_m_s2) {
  using namespace uav;
  const double weight_N = airframe.mass_kg * gravity_m_s2;
  const double hover_rad_s = hover_state(airframe, gravity_m_s2, 0.0).rotor_speed_rad_s[0];
  const auto ahead_in_W = [](const BodyState& b) { return rotate(b.q_WB, {1, 0, 0}); };
  return {{{.mask = kPosition | kYaw, .in_heading = false, .p_WB_m = {0.3, 0, 1.2}, .yaw_rad = 0.2},
           [=](const BodyState& b) {
             return b.p_WB.x > 0.1 && b.p_WB.z > 1.08 && ahead_in_W(b).y > 0.1;
           }},
          {{.mask = kVelocity, .in_heading = false, .velocity_m_s = {0, 0.5, 0}},
           [](const BodyState& b) { return b.v_WB.y > 0.4; }},
          {{.mask = kAcceleration, .in_heading = false, .acceleration_m_s2 = {0, 0.5, 0.2}},
           [](const BodyState& b) { return b.v_WB.y > 0.3 && b.v_WB.z > 0.15; }},
          {{.mask = kAttitude | kThrust, .q_WB = from_rpy(0.1, 0, 0), .thrust_N = weight_N},
           [](const BodyState& b) {
             return rotate(b.q_WB, {0, 1, 0}).z > 0.09;
           }},
          {{.mask = kBodyRates | kThrust, .w_WB_B_rad_s = {0, 0, 0.5}, .thrust_N = weight_N},
           [](const BodyState& b) { return b.w_WB_B.z > 0.45; }},
          {{.mask = kRotorSpeeds,
            .rotor_speeds_rad_s = std::vector<double>(airframe.rotors.size(), 1.05 * hover_rad_s)},
           [](const BodyState& b) { return b.v_WB.z > 0.7; }}};
}

TEST_P(SimulatorContract, FollowsSetpointsOfEveryLevelIfItTakesThem) {
  const auto simulator = make(test_world());
  if (!simulator->takes_setpoints()) GTEST_SKIP() << "takes velocities only";
  const World& world = simulator->world();
  for (const FlownLevel& level : flown_levels(world.uavs[0].airframe, world.gravity_m_s2)) {
    simulator->reset(1);
    simulator->apply(0, level.setpoint);
    simulator->advance_to(at(std::chrono::seconds(1)));
    EXPECT_TRUE(level.is_followed(simulator->ground_truth(0).body)) << level.setpoint.mask;
  }
}

/// The camera of the test world behind a joint, or mounted as this joint would turn it.
inline World world_with_joint(std::optional<double> mounted_rad) {
  World world = test_world();
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.0}, {0.2, 6.0, 2.0}, {0.8, 0.2, 0.2}));
  Uav& uav = world.uavs[0];
  const std::vector<uav::Joint> joints = {{"yaw", {0.1, 0, 0}, {0, 0, 1}, -1, 1, 2.0}};
  for (const std::size_t sensor : {kCamera, kRange}) {
    uav::Pose& X_BS = uav.sensors[sensor].X_BS;
    if (mounted_rad)
      X_BS = turned(joints, std::vector{*mounted_rad}, X_BS);
    else
      uav.sensors[sensor].joints = 1;
  }
  if (!mounted_rad) uav.joints = joints;
  uav.sensors.push_back({"joint_state", {}, 0.0, JointStateModel{}});
  return world;
}

// At 2 rad/s, it needs 0.2 s.
TEST_P(SimulatorContract, JointsTurnSensorsAtTheirRateAndLeaveTheFlight) {
  const auto turning = make(world_with_joint(std::nullopt));
  const auto mounted = make(world_with_joint(0.4));
  for (const auto& simulator : {turning, mounted}) simulator->reset(1);
  const uav::Setpoint ahead = uav::to_setpoint({{0.5, 0, 0}, 0.1});
  for (const auto& simulator : {turning, mounted}) simulator->apply(0, ahead);
  turning->apply(0, {.mask = uav::kJoints, .joints_rad = {0.4}});
  EXPECT_EQ(turning->ground_truth(0).joints_rad, std::vector{0.0});
  turning->advance_to(at(std::chrono::milliseconds(100)));
  EXPECT_NEAR(turning->ground_truth(0).joints_rad.at(0), 0.2, 1e-9);
  const std::size_t joint_state = turning->world().uavs[0].sensors.size() - 1;
  EXPECT_EQ(measure_now<uav::JointStateSample>(*turning, joint_state).angles_rad,
            turning->ground_truth(0).joints_rad);
  EXPECT_TRUE(measure_now<uav::JointStateSample>(*mounted, joint_state).angles_rad.empty());
  for (const auto& simulator : {turning, mounted})
    simulator->advance_to(at(std::chrono::milliseconds(300)));
  EXPECT_EQ(turning->ground_truth(0).joints_rad, std::vector{0.4});
  EXPECT_TRUE(mounted->ground_truth(0).joints_rad.empty());
  EXPECT_EQ(turning->ground_truth(0).body.p_WB, mounted->ground_truth(0).body.p_WB);
  EXPECT_NEAR(measure_now<uav::RangeSample>(*turning, kRange).range_m,
              measure_now<uav::RangeSample>(*mounted, kRange).range_m, 1e-9);
  EXPECT_EQ(measure_now<uav::CameraSample>(*turning, kCamera).rgb,
            measure_now<uav::CameraSample>(*mounted, kCamera).rgb);
}

TEST_P(SimulatorContract, SamplesCarryInstantAndIndex) {
  const auto simulator = make(test_world());
  simulator->advance_to(at(std::chrono::milliseconds(20)));
  Snapshot snapshot;
  simulator->capture(snapshot);
  simulator->advance_to(at(std::chrono::milliseconds(30)));
  const auto camera = std::get<uav::CameraSample>(simulator->measure(snapshot, 0, kCamera, 4));
  EXPECT_EQ(camera.sampled_at, at(std::chrono::milliseconds(20)));
  EXPECT_EQ(camera.index, 4U);
  EXPECT_EQ(camera.width_px, 160);
  EXPECT_EQ(camera.height_px, 120);
  EXPECT_EQ(camera.rgb.size(), 160U * 120U * 3U);
}

// Whatever is expected, in whatever order it is measured.
TEST_P(SimulatorContract, ExpectationsChangeNoMeasurement) {
  const auto told = make(test_world());
  const auto untold = make(test_world());
  KeyedRandom random({.seed = 8});
  std::vector<Snapshot> snapshots(40);
  const auto any_of_last = [&](std::size_t count) {
    return count - 1 - random.bits() % std::min<std::size_t>(count, 4);
  };
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    for (const auto& simulator : {told, untold}) {
      simulator->apply(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.5}));
      simulator->advance_to(at(i * std::chrono::milliseconds(20)));
      simulator->capture(snapshots[i]);
    }
    for (std::uint64_t n = random.bits() % 4; n > 0; --n) {
      const std::size_t k = any_of_last(i + 1);
      told->expect(snapshots[k], 0, random.bits() % 4 == 0 ? kRange : kCamera, k);
    }
    if (random.bits() % 2 == 0) continue;
    const std::size_t k = any_of_last(i + 1);
    EXPECT_EQ(std::get<uav::CameraSample>(told->measure(snapshots[k], 0, kCamera, k)).rgb,
              std::get<uav::CameraSample>(untold->measure(snapshots[k], 0, kCamera, k)).rgb)
        << k << " at " << i;
  }
}

TEST_P(SimulatorContract, RaysEndAtTheNextObject) {
  World world = test_world();
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.0}, {0.2, 6.0, 2.0}, {0.8, 0.2, 0.2}));
  const auto simulator = make(std::move(world));
  EXPECT_NEAR(measure_now<uav::RangeSample>(*simulator, kRange).range_m, 4.9, 1e-6);
}

/// The image of a camera of that kind at the start of `test_world` with a wall 4.7 m ahead of it;
/// none: the back end refuses such a camera, and says which.
inline std::optional<uav::CameraSample> image_of_wall(const SimulatorMaker& make,
                                                      uav::CameraKind kind) {
  World world = test_world();
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.0}, {0.2, 6.0, 2.0}, {0.8, 0.2, 0.2}));
  auto& camera = std::get<CameraModel>(world.uavs[0].sensors[kCamera].model);
  camera.kind = kind;
  camera.depth_min_m = 0.5;
  camera.depth_max_m = 20.0;
  try {
    return measure_now<uav::CameraSample>(*make(std::move(world)), kCamera);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("camera"));
    return std::nullopt;
  }
}

TEST_P(SimulatorContract, DepthsAndLabelsAreOfTheGeometryIfThereAreAny) {
  const std::size_t centre = 60 * 160 + 80, below = 115 * 160 + 80;
  const auto coloured = image_of_wall(GetParam(), uav::CameraKind::kColor);
  for (const auto kind : {uav::CameraKind::kDepth, uav::CameraKind::kRgbd}) {
    const auto image = image_of_wall(GetParam(), kind);
    if (!image) continue;
    ASSERT_EQ(image->depth_m.size(), 160U * 120U);
    EXPECT_NEAR(image->depth_m[centre], 4.7, 1e-4);
    EXPECT_LT(image->depth_m[below], 4.7);
    EXPECT_EQ(image->rgb.empty(), kind == uav::CameraKind::kDepth);
    if (kind == uav::CameraKind::kRgbd) {
      EXPECT_EQ(image->rgb, coloured->rgb);
    }
  }
  const auto labels = image_of_wall(GetParam(), uav::CameraKind::kSegmentation);
  if (!labels) return;
  ASSERT_EQ(labels->labels.size(), 160U * 120U);
  EXPECT_EQ(labels->labels[centre], 2U) << "the second model";
  EXPECT_EQ(labels->labels[below], 1U) << "the floor";
}

TEST_P(SimulatorContract, ABatteryIsSpentByTheFlightIfItIsSimulated) {
  const auto left_after = [](bool climbs) -> std::optional<double> {
    const auto simulator = make(world_with_battery(0.8, 0.05));
    if (climbs) simulator->apply(0, uav::to_setpoint({{0.0, 0.0, 1.0}, 0.0}));
    const auto before = simulator->battery(0);
    simulator->advance_to(at(std::chrono::milliseconds(500)));
    const auto after = simulator->battery(0);
    EXPECT_EQ(before.has_value(), after.has_value());
    if (!after) return std::nullopt;
    EXPECT_EQ(before->charge, 0.8);
    EXPECT_LT(after->charge, 0.8);
    EXPECT_GT(after->current_A, 0.0);
    return after->charge;
  };
  const auto hovering = left_after(false), climbing = left_after(true);
  if (!hovering) GTEST_SKIP() << "simulates no batteries";
  EXPECT_LT(*climbing, *hovering);
}

// Without noise, each says what the ground truth says.
TEST_P(SimulatorContract, NavigationSensorsMeasureTheGroundTruth) {
  World world = test_world();
  world.place = Place{10.0, 20.0, 300.0, 0.0};
  auto& sensors = world.uavs[0].sensors;
  const std::size_t first = sensors.size();
  sensors.push_back({"navsat", {}, 0.0, NavSatModel{}});
  sensors.push_back({"magnetometer", {}, 0.0, MagnetometerModel{}});
  sensors.push_back({"barometer", {}, 0.0, BarometerModel{}});
  sensors.push_back({"odometry", {}, 0.0, OdometryModel{}});
  const uav::Vec3 field_T = world.magnetic_field_T;
  const auto simulator = make(std::move(world));
  simulator->apply(0, uav::to_setpoint({{1.0, 0.5, 0.25}, 0.5}));
  simulator->advance_to(at(std::chrono::seconds(1)));
  const uav::BodyState truth = simulator->ground_truth(0).body;
  ASSERT_GT(truth.v_WB.x, 0.2);

  const auto odometry = measure_now<uav::OdometrySample>(*simulator, first + 3);
  EXPECT_EQ(odometry.p_WS, truth.p_WB);
  EXPECT_EQ(odometry.q_WS, truth.q_WB);
  EXPECT_EQ(odometry.v_WS_m_s, truth.v_WB);
  EXPECT_EQ(odometry.w_WS_rad_s, truth.w_WB_B);
  const auto navsat = measure_now<uav::NavSatSample>(*simulator, first);
  EXPECT_TRUE(navsat.has_fix);
  EXPECT_EQ(navsat.velocity_ENU_m_s, truth.v_WB);
  EXPECT_NEAR(navsat.altitude_m, 300.0 + truth.p_WB.z, 1e-6);
  EXPECT_NEAR((navsat.longitude_deg - 20.0) * 109'639.0, truth.p_WB.x, 1e-3)
      << "metres of a degree of longitude at 10 degrees north";
  const auto magnetometer = measure_now<uav::MagnetometerSample>(*simulator, first + 1);
  EXPECT_LT(norm(rotate(truth.q_WB, magnetometer.field_T) - field_T), 1e-15);
  const auto barometer = measure_now<uav::BarometerSample>(*simulator, first + 2);
  EXPECT_NEAR(barometer.altitude_m, 300.0 + truth.p_WB.z, 1e-6);
}

// Without noise: the acceleration of the last step, with gravity, and the rate of rotation.
TEST_P(SimulatorContract, AnImuMeasuresTheMotionOfTheLastStep) {
  World world = test_world();
  world.uavs[0].sensors[kImu] = {"imu", {}, 0.0, ImuModel{}};
  const Duration step = world.step;
  const uav::Vec3 at_rest_W = felt_at_rest(world);
  const auto simulator = make(std::move(world));
  simulator->apply(0, uav::to_setpoint({{1.0, 0.5, 0.0}, 0.8}));
  simulator->advance_to(at(std::chrono::milliseconds(200)));
  const uav::BodyState before = simulator->ground_truth(0).body;
  simulator->advance_to(simulator->now() + step);
  const uav::BodyState truth = simulator->ground_truth(0).body;
  const auto imu = measure_now<uav::ImuSample>(*simulator, kImu);
  const uav::Vec3 a_W = (1.0 / to_seconds(step)) * (truth.v_WB - before.v_WB);
  EXPECT_GT(norm(a_W), 0.5);
  EXPECT_LT(norm(rotate(truth.q_WB, imu.specific_force_m_s2) - a_W - at_rest_W), 1e-6);
  EXPECT_LT(norm(imu.angular_velocity_rad_s - truth.w_WB_B), 1e-9);
  EXPECT_LT(norm(rotate(imu.q_WS, {1, 0, 0}) - rotate(truth.q_WB, {1, 0, 0})), 1e-9);
}

// The UAV turns: the first column of a spinning lidar was measured earlier, with another heading.
TEST_P(SimulatorContract, AScanMeasuresEachColumnInItsOwnInstant) {
  World world = test_world();
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.0}, {0.2, 40.0, 2.0}, {0.8, 0.2, 0.2}));
  ScanModel scan{{.columns = 5,
                  .rows = 2,
                  .min_azimuth_rad = -0.4,
                  .max_azimuth_rad = 0.4,
                  .max_elevation_rad = 0.01,
                  .min_m = 0.1,
                  .max_m = 30.0},
                 0.0,
                 {}};
  auto& sensors = world.uavs[0].sensors;
  const std::size_t first = sensors.size();
  sensors.push_back({"still", {}, 0.0, scan});
  scan.rays.sweep_s = 0.1;
  sensors.push_back({"spinning", {}, 0.0, scan});
  const auto simulator = make(std::move(world));
  const auto fly_to = [&](Duration time) {
    simulator->apply(0, uav::to_setpoint({{}, 1.0}));
    simulator->advance_to(at(time));
    return measure_now<uav::ScanSample>(*simulator, first).ranges_m;
  };
  const auto earlier = fly_to(std::chrono::milliseconds(500));
  const auto halfway = fly_to(std::chrono::milliseconds(550));
  const auto now = fly_to(std::chrono::milliseconds(600));
  const auto spinning = measure_now<uav::ScanSample>(*simulator, first + 1);
  EXPECT_EQ(spinning.sampled_at, at(std::chrono::milliseconds(600)));
  ASSERT_EQ(spinning.ranges_m.size(), 10U);
  EXPECT_EQ(spinning.ranges_m[0], earlier[0]);
  EXPECT_EQ(spinning.ranges_m[2], halfway[2]);
  EXPECT_EQ(spinning.ranges_m[9], now[9]);
  EXPECT_NE(earlier[0], now[0]);
}

TEST_P(SimulatorContract, RefusesInvalidCalls) {
  const auto simulator = make(test_world());
  simulator->advance_to(at(std::chrono::milliseconds(10)));
  EXPECT_THROW(simulator->advance_to(at(std::chrono::milliseconds(9))), Error);
  EXPECT_THROW(simulator->advance_to(at(std::chrono::microseconds(10500))), Error);
  EXPECT_THROW(simulator->apply(1, {}), Error);
  EXPECT_THROW(simulator->ground_truth(1), Error);
  Snapshot snapshot;
  simulator->capture(snapshot);
  EXPECT_THROW(simulator->measure(snapshot, 0, 3, 0), Error);
}

TEST_P(SimulatorContract, NamesItsRendererAfterTheFirstImage) {
  const auto simulator = make(test_world());
  const std::string before = simulator->description();
  EXPECT_FALSE(before.empty());
  measure_now<uav::CameraSample>(*simulator, kCamera);
  EXPECT_THAT(simulator->description(), ::testing::StartsWith(before + ", "));
}

}  // namespace tether::sim::testing
