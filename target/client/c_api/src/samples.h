#pragma once

#include <algorithm>
#include <cstdint>

#include <tether/base/time.h>
#include <tether/client.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>

/// Measurements as <tether/client.h> has them.
namespace tether::c_api {

inline tether_vec3 to_c(const uav::Vec3& v) {
  return {v.x, v.y, v.z};
}
inline tether_quat to_c(const uav::Quat& q) {
  return {q.w, q.x, q.y, q.z};
}

inline tether_image_info to_c(const uav::CameraSample& sample) {
  return {to_ns(sample.sampled_at), sample.index, sample.width_px, sample.height_px,
          sample.rgb.size()};
}
inline tether_imu_sample to_c(const uav::ImuSample& sample) {
  return {to_ns(sample.sampled_at), sample.index, to_c(sample.angular_velocity_rad_s),
          to_c(sample.specific_force_m_s2), to_c(sample.q_WS)};
}
inline tether_range_sample to_c(const uav::RangeSample& sample) {
  return {to_ns(sample.sampled_at), sample.index, sample.range_m};
}
inline tether_navsat_sample to_c(const uav::NavSatSample& sample) {
  return {to_ns(sample.sampled_at),
          sample.index,
          sample.has_fix ? 1 : 0,
          0,
          sample.latitude_deg,
          sample.longitude_deg,
          sample.altitude_m,
          to_c(sample.velocity_ENU_m_s),
          sample.horizontal_accuracy_m,
          sample.vertical_accuracy_m,
          sample.speed_accuracy_m_s};
}
inline tether_magnetometer_sample to_c(const uav::MagnetometerSample& sample) {
  return {to_ns(sample.sampled_at), sample.index, to_c(sample.field_T)};
}
inline tether_barometer_sample to_c(const uav::BarometerSample& sample) {
  return {to_ns(sample.sampled_at), sample.index, sample.pressure_Pa, sample.altitude_m};
}
inline tether_odometry_sample to_c(const uav::OdometrySample& sample) {
  return {to_ns(sample.sampled_at),
          sample.index,
          to_c(sample.p_WS),
          to_c(sample.q_WS),
          to_c(sample.v_WS_m_s),
          to_c(sample.w_WS_rad_s),
          to_c(sample.position_stddev_m),
          to_c(sample.attitude_stddev_rad),
          to_c(sample.velocity_stddev_m_s)};
}
/// @pre at most as many angles as the struct has room for
inline tether_joint_state_sample to_c(const uav::JointStateSample& sample) {
  tether_joint_state_sample c{to_ns(sample.sampled_at),
                              sample.index,
                              static_cast<std::uint32_t>(sample.angles_rad.size()),
                              0,
                              {}};
  std::copy(sample.angles_rad.begin(), sample.angles_rad.end(), c.angles_rad);
  return c;
}
/// Shows the distances of `sample`.
inline tether_scan to_c(const uav::ScanSample& sample) {
  return {to_ns(sample.sampled_at), sample.index, sample.ranges_m.size(), sample.ranges_m.data(),
          sample.intensities.empty() ? nullptr : sample.intensities.data()};
}

/// `catalogue`: that of the UAV.
inline tether_battery_sample to_c(const uav::BatterySample& sample,
                                  const uav::Catalogue& catalogue) {
  return {to_ns(sample.sampled_at), sample.voltage_V, sample.current_A, sample.charge,
          catalogue.battery_capacity_C};
}

}  // namespace tether::c_api
