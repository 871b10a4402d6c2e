#pragma once

#include "sensors/measurement.h"

#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

namespace tether::sim {

/// The sample of an IMU mounted at `X_BS`: rotation rate, specific force at its own origin (lever
/// arm included) and attitude, the latter without error. At rest, it measures `at_rest_W`
/// (`felt_at_rest`). Pure.
uav::ImuSample measure_imu(const ImuModel& imu, const uav::Pose& X_BS, const uav::Pose& X_WB,
                           const BodyMotion& motion, const uav::Vec3& at_rest_W,
                           const MeasurementKey& key);

}  // namespace tether::sim
