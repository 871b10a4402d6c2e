#include <algorithm>
#include <chrono>

#include <tether/base/random.h>
#include <tether/sim/bodies.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {
namespace {

using namespace std::chrono_literals;

const uav::VelocityCommand kForward{{1.0, 0.2, 0.1}, 0.5};
constexpr SimTime kCommanded{100ms};
constexpr SimTime kObserved{500ms};

void add(const uav::Vec3& v, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), {v.x, v.y, v.z});
}

}  // namespace

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

Observation observe(Simulator& simulator, const Snapshot& snapshot, std::uint64_t index) {
  Observation out;
  for (std::size_t uav = 0; uav < 2; ++uav) {
    const auto imu = std::get<uav::ImuSample>(simulator.measure(snapshot, uav, kImu, index));
    add(imu.angular_velocity_rad_s, out.numbers);
    add(imu.specific_force_m_s2, out.numbers);
    const auto range = std::get<uav::RangeSample>(simulator.measure(snapshot, uav, kRange, index));
    out.numbers.push_back(range.range_m);
  }
  out.image = std::get<uav::CameraSample>(simulator.measure(snapshot, 0, kCamera, index)).rgb;
  return out;
}

Observation fly_in_one_piece(Simulator& simulator, std::uint64_t seed) {
  simulator.reset(seed);
  simulator.advance_to(kCommanded);
  simulator.apply(0, to_setpoint(kForward));
  simulator.advance_to(kObserved);
  Snapshot snapshot;
  simulator.capture(snapshot);
  return observe(simulator, snapshot, 7);
}

Observation fly_in_pieces(Simulator& simulator, std::uint64_t seed) {
  simulator.reset(seed);
  KeyedRandom random({1, 2, 3});
  Snapshot snapshot;
  while (simulator.now() < kObserved) {
    if (simulator.now() == kCommanded) simulator.apply(0, to_setpoint(kForward));
    const SimTime limit = simulator.now() < kCommanded ? kCommanded : kObserved;
    simulator.advance_to(std::min(limit, simulator.now() + (1 + random.bits() % 40) * 1ms));
    simulator.capture(snapshot);
    observe(simulator, snapshot, random.bits());
  }
  simulator.advance_to(SimTime(800ms));
  return observe(simulator, snapshot, 7);
}

}  // namespace tether::sim::testing
