#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <tether/base/time.h>
#include <tether/sim/world.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

/// Samples from true values, as pure functions.
namespace tether::sim {

/// Identifies a measurement.
struct MeasurementKey {
  std::uint64_t seed = 0;
  std::string_view uav;
  std::string_view sensor;
  std::uint64_t index = 0;
  SimTime at;
};

/// The sample of an IMU mounted at `X_BS`: rotation rate, specific force at its own origin (lever
/// arm included) and attitude, the latter without error.
uav::ImuSample measure_imu(const ImuModel& imu, const uav::Pose& X_BS, const uav::Pose& X_WB,
                           const BodyMotion& motion, double gravity_m_s2,
                           const MeasurementKey& key);

/// The largest distance that noise can turn into a reading within the limits [m].
double farthest_read_m(const RangeModel& range);

/// The sample of a rangefinder from the true distances along its rays [m] (infinite: no hit): the
/// nearest of them, with dropouts, noise, resolution and limits.
uav::RangeSample measure_range(const RangeModel& range, std::span<const double> distances_m,
                               const MeasurementKey& key);

}  // namespace tether::sim
