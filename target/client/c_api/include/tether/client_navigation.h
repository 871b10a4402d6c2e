#pragma once

#include <tether/client.h>

/// @cond
#ifdef __cplusplus
extern "C" {
#endif
/// @endcond

/// @defgroup c_navigation Navigation, lidars and joints
/// @ingroup c_api
/// Sensors that say where the UAV is, lidars, and the angles of joints. Their reads follow the
/// rules of @ref c_reading.
/// @{

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

/// Reads a receiver of satellite navigation. @copydetails tether_read_imu
tether_status tether_read_navsat(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                                 tether_navsat_sample* out, size_t size) TETHER_NOEXCEPT;

/// One measurement of a magnetometer. May grow.
typedef struct tether_magnetometer_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  tether_vec3 field_T;    ///< magnetic flux density in S [T]
} tether_magnetometer_sample;

/// Reads a magnetometer. @copydetails tether_read_imu
tether_status tether_read_magnetometer(tether_vehicle* vehicle, const char* sensor,
                                       tether_read_mode mode, tether_magnetometer_sample* out,
                                       size_t size) TETHER_NOEXCEPT;

/// One measurement of a barometer. May grow.
typedef struct tether_barometer_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  double pressure_Pa;     ///< static pressure
  double altitude_m;      ///< of that pressure in the standard atmosphere (ISO 2533)
} tether_barometer_sample;

/// Reads a barometer. @copydetails tether_read_imu
tether_status tether_read_barometer(tether_vehicle* vehicle, const char* sensor,
                                    tether_read_mode mode, tether_barometer_sample* out,
                                    size_t size) TETHER_NOEXCEPT;

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

/// Reads an estimate of pose and velocity. @copydetails tether_read_imu
tether_status tether_read_odometry(tether_vehicle* vehicle, const char* sensor,
                                   tether_read_mode mode, tether_odometry_sample* out,
                                   size_t size) TETHER_NOEXCEPT;

/// The angles of the UAV's joints. May grow.
typedef struct tether_joint_state_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  uint32_t joints;        ///< how many angles there are, as tether_joint_count()
  uint32_t reserved;      ///< 0
  double angles_rad[4];   ///< in the order of tether_get_joint()
} tether_joint_state_sample;

/// Reads the angles of all joints. @copydetails tether_read_imu
tether_status tether_read_joint_state(tether_vehicle* vehicle, const char* sensor,
                                      tether_read_mode mode, tether_joint_state_sample* out,
                                      size_t size) TETHER_NOEXCEPT;

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

/// Rays of a lidar.
/// @param sensor  the sensor  @param[out] out  its rays  @param size  sizeof *out
/// @return TETHER_OK, or TETHER_INVALID if the sensor is not a lidar
tether_status tether_sensor_scan_model(const tether_sensor* sensor, tether_scan_model* out,
                                       size_t size) TETHER_NOEXCEPT;

/// Describes a scan. May grow.
typedef struct tether_scan_info {
  int64_t sampled_at_ns;  ///< ST of the last column [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  uint64_t rays;          ///< how many distances there are
} tether_scan_info;

/// A scan that a subscription shows. May grow.
typedef struct tether_scan {
  int64_t sampled_at_ns;     ///< ST of the last column [ns]
  uint64_t index;            ///< number of the measurement of this sensor
  uint64_t rays;             ///< how many distances there are
  const float* ranges_m;     ///< as tether_read_scan() has them
  const float* intensities;  ///< as tether_read_scan_intensities() has them; NULL: not known
} tether_scan;

/// Reads a lidar into the caller's memory.
/// @param vehicle  the UAV  @param sensor  its name  @param mode  which scan
/// @param[out] ranges_m  distances, row by row as in tether_scan_model; +inf: nothing in reach;
///   -inf: too close (REP-117); unchanged by a failed call
/// @param capacity  floats that `ranges_m` has room for
/// @param[out] info  the description, or NULL  @param info_size  sizeof *info
/// @return TETHER_OK, TETHER_NOTHING_YET or an @ref interaction error; TETHER_INVALID, before
///   anything is read, if the scan does not fit
tether_status tether_read_scan(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                               float* ranges_m, size_t capacity, tether_scan_info* info,
                               size_t info_size) TETHER_NOEXCEPT;

/// Reads a lidar as tether_read_scan() does, with the intensity of each ray.
/// @param vehicle  the UAV  @param sensor  its name  @param mode  which scan
/// @param[out] ranges_m  distances  @param[out] intensities  of each distance, how much of the
/// light
///   comes back (docs/guide/sensors.md); 0 where it is not finite; NaN if the simulator does not
///   know it
/// @param capacity  floats that each of them has room for
/// @param[out] info  the description, or NULL  @param info_size  sizeof *info
/// @return as tether_read_scan()
tether_status tether_read_scan_intensities(tether_vehicle* vehicle, const char* sensor,
                                           tether_read_mode mode, float* ranges_m,
                                           float* intensities, size_t capacity,
                                           tether_scan_info* info,
                                           size_t info_size) TETHER_NOEXCEPT;

/// @}

#ifdef __cplusplus
}
#endif
