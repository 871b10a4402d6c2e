#include "test_simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/sim/range_rays.h>
#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::kCamera;
using testing::kImu;
using testing::kRange;
using testing::make_simulator;
using testing::measure_now;
using testing::test_uav;
using testing::test_world;

using namespace std::chrono_literals;

SimTime at(Duration d) {
  return SimTime(d);
}

// A world in which everything is noisy and blurred, and two UAVs fly past a loose box.
World busy_world() {
  World world = test_world();
  world.uavs.push_back(test_uav("beta", {2.0, 1.0, 1.5}));
  world.models.push_back(box_model("wall", {5.0, 0.0, 1.0}, {0.2, 6.0, 2.0}, {0.8, 0.2, 0.2}));
  Model loose = box_model("loose", {0.5, 1.0, 0.5}, {0.3, 0.3, 0.3}, {0.1, 0.7, 0.1}, false);
  loose.links[0].inertia_kg_m2 = {0.015, 0.015, 0.015};
  world.models.push_back(loose);
  const Noise noise{0.0, 0.02, 0.0, 0.01, 0.001, 100.0};
  for (Uav& uav : world.uavs) {
    auto& camera = std::get<CameraModel>(uav.sensors[kCamera].model);
    camera.pixel_noise = noise;
    camera.exposure_s = 0.008;
    camera.readout_s = 0.0155;
    std::get<ImuModel>(uav.sensors[kImu].model).angular_velocity.fill(noise);
    std::get<ImuModel>(uav.sensors[kImu].model).linear_acceleration.fill(noise);
    auto& range = std::get<RangeModel>(uav.sensors[kRange].model);
    range.noise = noise;
    range.rays_S = cone_of_rays(0.5);
    range.dropout_probability = 0.3;
  }
  return world;
}

// Everything that a run shows at one instant.
struct Observation {
  std::vector<double> numbers;
  std::vector<std::uint8_t> image;
  friend bool operator==(const Observation&, const Observation&) = default;
};

Observation observe(Simulator& simulator, const Snapshot& snapshot, std::uint64_t index) {
  Observation out;
  const auto add = [&](const uav::Vec3& v) {
    out.numbers.insert(out.numbers.end(), {v.x, v.y, v.z});
  };
  for (std::size_t uav = 0; uav < 2; ++uav) {
    const auto imu = std::get<uav::ImuSample>(simulator.measure(snapshot, uav, kImu, index));
    add(imu.angular_velocity_rad_s);
    add(imu.specific_force_m_s2);
    const auto range = std::get<uav::RangeSample>(simulator.measure(snapshot, uav, kRange, index));
    out.numbers.push_back(range.range_m);
  }
  out.image = std::get<uav::CameraSample>(simulator.measure(snapshot, 0, kCamera, index)).rgb;
  return out;
}

const uav::VelocityCommand kForward{{1.0, 0.2, 0.1}, 0.5};

Observation run_in_one_piece(Simulator& simulator, std::uint64_t seed) {
  simulator.reset(seed);
  simulator.advance_to(at(100ms));
  simulator.apply(0, kForward);
  simulator.advance_to(at(900ms));
  Snapshot snapshot;
  simulator.capture(snapshot);
  return observe(simulator, snapshot, 7);
}

// Other measurements in between, the advance in uneven pieces, and the observation long after its
// instant.
Observation run_in_pieces(Simulator& simulator, std::uint64_t seed) {
  simulator.reset(seed);
  KeyedRandom random({1, 2, 3});
  Snapshot snapshot;
  while (simulator.now() < at(900ms)) {
    if (simulator.now() == at(100ms)) simulator.apply(0, kForward);
    const SimTime limit = simulator.now() < at(100ms) ? at(100ms) : at(900ms);
    simulator.advance_to(std::min(limit, simulator.now() + (1 + random.bits() % 40) * 1ms));
    simulator.capture(snapshot);
    observe(simulator, snapshot, random.bits());
  }
  simulator.advance_to(at(1500ms));
  return observe(simulator, snapshot, 7);
}

TEST(MujocoSimulatorTest, SameSeedSameBytesHoweverTheRunWasCut) {
  const auto a = make_simulator(busy_world());
  const auto b = make_simulator(busy_world());
  const Observation whole = run_in_one_piece(*a, 5);
  EXPECT_EQ(whole, run_in_pieces(*b, 5));
  EXPECT_EQ(whole, run_in_one_piece(*a, 5)) << "after a reset";
  EXPECT_NE(whole.numbers, run_in_one_piece(*a, 6).numbers);
}

TEST(MujocoSimulatorTest, StartsHoveringAtStZero) {
  const auto simulator = make_simulator(test_world());
  EXPECT_EQ(simulator->now(), SimTime{});
  EXPECT_EQ(simulator->ground_truth(0).body.p_WB, (uav::Vec3{0.0, 0.0, 1.0}));
  EXPECT_EQ(simulator->ground_truth(0).body.v_WB, uav::Vec3{});
  simulator->advance_to(at(50ms));
  EXPECT_EQ(simulator->now(), at(50ms));
  EXPECT_EQ(simulator->ground_truth(0).at, at(50ms));
}

TEST(MujocoSimulatorTest, SamplesCarryInstantAndIndex) {
  const auto simulator = make_simulator(test_world());
  simulator->advance_to(at(20ms));
  Snapshot snapshot;
  simulator->capture(snapshot);
  simulator->advance_to(at(30ms));
  const auto camera = std::get<uav::CameraSample>(simulator->measure(snapshot, 0, kCamera, 4));
  EXPECT_EQ(camera.sampled_at, at(20ms));
  EXPECT_EQ(camera.index, 4U);
  EXPECT_EQ(camera.width_px, 160);
  EXPECT_EQ(camera.height_px, 120);
  EXPECT_EQ(camera.rgb.size(), 160U * 120U * 3U);
}

TEST(MujocoSimulatorTest, RefusesWhatBreaksTheContract) {
  const auto simulator = make_simulator(test_world());
  simulator->advance_to(at(10ms));
  EXPECT_THROW(simulator->advance_to(at(9ms)), Error);
  EXPECT_THROW(simulator->advance_to(at(10500us)), Error);
  EXPECT_THROW(simulator->apply(1, {}), Error);
  Snapshot snapshot;
  simulator->capture(snapshot);
  EXPECT_THROW(simulator->measure(snapshot, 0, 3, 0), Error);
}

TEST(MujocoSimulatorTest, NamesItself) {
  const auto simulator = make_simulator(test_world());
  EXPECT_THAT(simulator->description(), ::testing::StartsWith("MuJoCo "));
  measure_now<uav::CameraSample>(*simulator, kCamera);
  EXPECT_THAT(simulator->description(), ::testing::HasSubstr(", "));
  EXPECT_TRUE(kHasMujoco);
}

TEST(MujocoSimulatorTest, StopsWhenTheMotionBecomesUnusable) {
  World world = test_world();
  world.gravity_m_s2 = 1e12;
  const auto simulator = make_simulator(world);
  EXPECT_THROW(simulator->advance_to(at(1s)), Error);
}

}  // namespace
}  // namespace tether::sim
