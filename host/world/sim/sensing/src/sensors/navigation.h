#pragma once

#include "sensors/measurement.h"

#include <tether/sim/world.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

/// The samples of sensors that say where a UAV is. Pure.
namespace tether::sim {

/// The true motion of a sensor's frame S.
struct TrueMotion {
  uav::Pose X_WS;
  uav::Vec3 v_WS_W;  ///< [m/s]
  uav::Vec3 w_WS_S;  ///< [rad/s]
};
/// `X_BS` is the sensor's mounting; `motion` that of B.
TrueMotion motion_of_sensor(const uav::Pose& X_WB, const BodyMotion& motion, const uav::Pose& X_BS);

uav::NavSatSample measure_navsat(const NavSatModel& model, const TrueMotion& truth,
                                 const Place& place, const MeasurementKey& key);
uav::MagnetometerSample measure_magnetometer(const MagnetometerModel& model,
                                             const TrueMotion& truth, const uav::Vec3& field_W_T,
                                             const MeasurementKey& key);
uav::BarometerSample measure_barometer(const BarometerModel& model, const TrueMotion& truth,
                                       const Place& place, const MeasurementKey& key);
uav::OdometrySample measure_odometry(const OdometryModel& model, const TrueMotion& truth,
                                     const MeasurementKey& key);

/// Whether a receiver is in an outage.
bool is_out(const NavSatModel& model, const MeasurementKey& key);

}  // namespace tether::sim
