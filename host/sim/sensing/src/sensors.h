#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <tether/base/time.h>
#include <tether/sim/world.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

/// What sensors make of what is true, as pure functions.
namespace tether::sim {

/// Which measurement is made.
struct MeasurementKey {
  std::uint64_t seed = 0;
  std::string_view uav;
  std::string_view sensor;
  std::uint64_t index = 0;
  SimTime at;
};

/// What an IMU mounted at `X_BS` measures: rotation rate, specific force of its own point (lever
/// arm included) and attitude, the latter without error.
uav::ImuSample measure_imu(const ImuModel& imu, const uav::Pose& X_BS, const uav::Pose& X_WB,
                           const BodyMotion& motion, double gravity_m_s2,
                           const MeasurementKey& key);

/// How far away a thing may be and still be read as within the limits, whatever the noise [m].
double farthest_read_m(const RangeModel& range);

/// What a rangefinder reports for the true distances along its rays [m] (infinite: nothing there):
/// the nearest of them, dropouts, noise, resolution, limits.
uav::RangeSample measure_range(const RangeModel& range, std::span<const double> distances_m,
                               const MeasurementKey& key);

}  // namespace tether::sim
