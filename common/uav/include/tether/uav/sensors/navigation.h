#pragma once

#include <cstdint>
#include <limits>

#include <tether/base/time.h>
#include <tether/uav/math.h>

/// Sensors that say where a UAV is. Each has what its catalogue says of it (`…Properties`) and what
/// it measures (`…Sample`).
namespace tether::uav {

/// Satellite navigation.
struct NavSatProperties {};
struct NavSatSample {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  SimTime sampled_at;
  std::uint64_t index = 0;       ///< number of this measurement of the sensor
  bool has_fix = false;          ///< without a fix, the numbers below are NaN
  double latitude_deg = kNone;   ///< WGS 84, of the sensor's own origin
  double longitude_deg = kNone;  ///< east of Greenwich
  double altitude_m = kNone;     ///< above the ellipsoid
  Vec3 velocity_ENU_m_s{kNone, kNone, kNone};
  double horizontal_accuracy_m = kNone;  ///< standard deviation along each axis
  double vertical_accuracy_m = kNone;
  double speed_accuracy_m_s = kNone;
};

struct MagnetometerProperties {};
struct MagnetometerSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  Vec3 field_T;  ///< magnetic flux density in S [T]
};

struct BarometerProperties {};
struct BarometerSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  double pressure_Pa = 0.0;
  double altitude_m = 0.0;  ///< of that pressure in the standard atmosphere (ISO 2533)
};

/// What a state estimator gives: an estimate, not the truth.
struct OdometryProperties {};
struct OdometrySample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  Vec3 p_WS;  ///< of the sensor's frame; without a mounting, that is the body's
  Quat q_WS;
  Vec3 v_WS_m_s;             ///< in W
  Vec3 w_WS_rad_s;           ///< in S
  Vec3 position_stddev_m;    ///< along W's axes
  Vec3 attitude_stddev_rad;  ///< about W's axes
  Vec3 velocity_stddev_m_s;  ///< along W's axes
};

}  // namespace tether::uav
