#pragma once

#include <stdint.h>

#include <tether/client_types.h>

/// @defgroup c_samples Measurements
/// @ingroup c_api
/// What sensors measure. Each struct may grow at its end.
/// @{

/// One measurement of an inertial measurement unit. May grow.
typedef struct tether_imu_sample {
  int64_t sampled_at_ns;               ///< ST [ns]
  uint64_t index;                      ///< number of the measurement of this sensor
  tether_vec3 angular_velocity_rad_s;  ///< w_WS in S
  tether_vec3 specific_force_m_s2;     ///< a - g in S: +9.81 along "up" at rest
  tether_quat q_WS;                    ///< attitude from the IMU's own filter; NaN if it has none
} tether_imu_sample;

/// One measurement of a rangefinder. May grow.
typedef struct tether_range_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  double range_m;         ///< along S's x [m]; +inf: nothing in reach; -inf: too close (REP-117)
} tether_range_sample;

/// One measurement of a receiver of satellite navigation. May grow.
typedef struct tether_navsat_sample {
  int64_t sampled_at_ns;         ///< ST [ns]
  uint64_t index;                ///< number of the measurement of this sensor
  int32_t has_fix;               ///< 1, or 0: all numbers below are NaN
  int32_t reserved;              ///< 0
  double latitude_deg;           ///< WGS 84
  double longitude_deg;          ///< east of Greenwich
  double altitude_m;             ///< above the ellipsoid
  tether_vec3 velocity_ENU_m_s;  ///< east, north, up
  double horizontal_accuracy_m;  ///< standard deviation along each axis
  double vertical_accuracy_m;    ///< standard deviation
  double speed_accuracy_m_s;     ///< standard deviation along each horizontal axis
} tether_navsat_sample;

/// One measurement of a magnetometer. May grow.
typedef struct tether_magnetometer_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  tether_vec3 field_T;    ///< magnetic flux density in S [T]
} tether_magnetometer_sample;

/// One measurement of a barometer. May grow.
typedef struct tether_barometer_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  double pressure_Pa;     ///< static pressure
  double altitude_m;      ///< of that pressure in the standard atmosphere (ISO 2533)
} tether_barometer_sample;

/// One estimate of pose and velocity, of the sensor's frame S in W. Not the truth. May grow.
typedef struct tether_odometry_sample {
  int64_t sampled_at_ns;            ///< ST [ns]
  uint64_t index;                   ///< number of the measurement of this sensor
  tether_vec3 p_WS;                 ///< position [m]
  tether_quat q_WS;                 ///< attitude
  tether_vec3 v_WS_m_s;             ///< velocity in W
  tether_vec3 w_WS_rad_s;           ///< angular velocity in S
  tether_vec3 position_stddev_m;    ///< along W's axes
  tether_vec3 attitude_stddev_rad;  ///< about W's axes
  tether_vec3 velocity_stddev_m_s;  ///< along W's axes
} tether_odometry_sample;

/// Where the rays of a lidar point. Ray (row, column) is number row x columns + column. May grow.
typedef struct tether_scan_model {
  int32_t columns;           ///< rays of a row
  int32_t rows;              ///< from the lowest elevation
  double min_azimuth_rad;    ///< of the first column; about S's z, from its x
  double max_azimuth_rad;    ///< of the last column
  double min_elevation_rad;  ///< of the first row; up from S's x-y plane
  double max_elevation_rad;  ///< of the last row
  double min_m;              ///< what is closer reads -inf
  double max_m;              ///< what is farther reads +inf
  double sweep_s;            ///< from the first column to the last, which is measured at sampled_at
} tether_scan_model;

/// Describes a scan. May grow.
typedef struct tether_scan_info {
  int64_t sampled_at_ns;  ///< ST of the last column [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  uint64_t rays;          ///< how many distances there are
} tether_scan_info;

/// @}
