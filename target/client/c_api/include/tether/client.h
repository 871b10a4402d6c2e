#pragma once

#include <stddef.h>
#include <stdint.h>

#include <tether/client_types.h>

/// @defgroup c_api C: <tether/client.h>
/// The client library of Tether in C99: what a UAV's own program, the software under test (SUT),
/// links to. In C++, <tether/client.hpp> is more convenient. The guide is
/// docs/guide/your-own-sut.md; the rules of time are in docs/design.md, section 2.
///
/// **Time** is int64_t nanoseconds. ET is the SUT's execution time: it advances while the SUT
/// computes, and is stopped while a call is held. ST is simulated time; measurements carry ST.
/// Under the barrier, a call that returns at ET t has observed the world at ST t.
///
/// **Units and frames**: lengths are metres, angles radians; yaw is counter-clockwise seen from
/// above. W: world (east, north, up). B: body (ahead, left, up). H: heading (W turned by the UAV's
/// yaw only). S: a sensor (ahead, left, up; also a camera's mounting). C: a camera's optical frame
/// (right, down, ahead). `q_WS` turns coordinates from S to W; `X_BS` is the pose of S in B.
///
/// **Errors**: a function that can fail returns a status; tether_last_error() has the message. A
/// failed call sets its outputs to NULL or zero. A pointer that is NULL without permission is an
/// error: TETHER_INVALID, or the value that the function names. Every function that returns a
/// status can also fail with TETHER_NO_MEMORY or TETHER_INTERNAL. Text is UTF-8 and ends with a
/// zero byte. The library never ends the program, prints nothing, and handles no signal.
///
/// @anchor interaction
/// **Interactions** are calls that talk to the coordinator: reads, commands, sleeps, messages and
/// tether_finish(). They can block. An interaction error is TETHER_INVALID (an argument is wrong,
/// or the mission is finished), TETHER_REFUSED, TETHER_DISCONNECTED, TETHER_PROTOCOL or
/// TETHER_RUN_ENDED. After any of these except TETHER_INVALID, every later interaction of the
/// vehicle fails with the same status.
///
/// **Threads**: several threads can call any function; nothing may be freed, and no options
/// changed, while another thread uses them. If tether_is_concurrent() is 0, calls of one vehicle
/// take turns: under the barrier, a call during another thread's call ends the run. Under
/// tether-exec each thread waits for its own reply only. After fork(), the child must connect for
/// itself.
///
/// **Stability**: within TETHER_CLIENT_ABI_VERSION functions and constants are only added. A struct
/// that may grow at its end is passed with its size (`sizeof *out`). The library fills the members
/// that the caller knows; members that only the caller knows are set to zero.
/// @{

/// @cond
#ifdef __cplusplus
#define TETHER_NOEXCEPT noexcept
extern "C" {
#else
#define TETHER_NOEXCEPT
#endif
/// @endcond

/// @defgroup c_status Versions and statuses
/// @{

/// Increases when a function or constant changes or is removed; the number after ".so.".
#define TETHER_CLIENT_ABI_VERSION 1

/// Version of the loaded library's ABI.
/// @return its TETHER_CLIENT_ABI_VERSION
int32_t tether_client_abi_version(void) TETHER_NOEXCEPT;
/// Version of the loaded library.
/// @return "0.1.0" or "0.1.0+COMMIT"; never NULL, always valid
const char* tether_client_version(void) TETHER_NOEXCEPT;

/// What a call ended with: one of TETHER_OK, TETHER_INVALID, ...
typedef int32_t tether_status;
/// Values of tether_status.
enum {
  TETHER_OK = 0,            ///< the call succeeded
  TETHER_INVALID = 1,       ///< an argument cannot be used; the next call may succeed
  TETHER_NOTHING_YET = 2,   ///< a read that does not wait found no measurement; not an error
  TETHER_REFUSED = 3,       ///< the coordinator refused: wrong name, token or version
  TETHER_DISCONNECTED = 4,  ///< the connection ended, or no coordinator is there
  TETHER_PROTOCOL = 5,      ///< the coordinator sent what the protocol does not allow
  TETHER_TIMEOUT = 6,       ///< no answer within the limit
  TETHER_RUN_ENDED = 7,     ///< the coordinator ended the run, or another thread finished it
  TETHER_NO_MEMORY = 8,     ///< out of memory
  TETHER_INTERNAL = 9       ///< an error in the library
};

/// Name of a status.
/// @param status  any number
/// @return "ok", "invalid", ...; "unknown" if `status` is none. Never NULL, always valid.
const char* tether_status_name(tether_status status) TETHER_NOEXCEPT;

/// Message of the calling thread's last failed call.
/// @return one line for a person, at most 511 bytes (cut if longer); "" if no call has failed.
///   Never NULL; the thread's next failed call changes the text.
const char* tether_last_error(void) TETHER_NOEXCEPT;

/// @}
/// @defgroup c_connecting Connecting
/// @{

/// The UAV as its own program sees it.
typedef struct tether_vehicle tether_vehicle;
/// How to reach the coordinator.
typedef struct tether_options tether_options;

/// Makes options for the only UAV, the wall clock and this program's file name; without address and
/// token.
/// @param[out] out  the options; free them with tether_options_free()
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_options_new(tether_options** out) TETHER_NOEXCEPT;
/// Makes options from the variables that `tether run` and tether-exec set: TETHER_ADDRESS,
/// TETHER_TOKEN, TETHER_UAV, TETHER_CLOCK, TETHER_EXEC (see tether-client(3)). What is set
/// afterwards replaces them. No other thread may change the environment during this function and
/// tether_connect().
/// @param[out] out  the options; free them with tether_options_free()
/// @return TETHER_OK, or TETHER_INVALID with a message that names the variable
tether_status tether_options_from_environment(tether_options** out) TETHER_NOEXCEPT;
/// Frees options. @param options  the options, or NULL
void tether_options_free(tether_options* options) TETHER_NOEXCEPT;

/// Sets the coordinator's address. It is not looked up before tether_connect().
/// @param options  the options  @param address  "HOST:PORT" or "[IPV6]:PORT"
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_options_set_address(tether_options* options,
                                         const char* address) TETHER_NOEXCEPT;
/// Sets the token that admits this program to the run.
/// @param options  the options  @param token  as the coordinator prints it
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_options_set_token(tether_options* options, const char* token) TETHER_NOEXCEPT;
/// Sets which UAV of the scenario to fly.
/// @param options  the options  @param uav  its name; "" for the only UAV
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_options_set_uav(tether_options* options, const char* uav) TETHER_NOEXCEPT;
/// Sets the program's name and version, for the record.
/// @param options  the options  @param name  any text  @return TETHER_OK or TETHER_INVALID
tether_status tether_options_set_sut_name(tether_options* options,
                                          const char* name) TETHER_NOEXCEPT;
/// Sets how ET is measured. The coordinator refuses a clock that the scenario does not ask for.
/// @param options  the options
/// "cpu" counts the CPU time of this process, except the library's own thread, and of all its
/// descendants. With it, orphaned descendants become children of this process, and interactions
/// fail with TETHER_REFUSED if a process ignores SIGCHLD.
/// @param clock  as in TETHER_CLOCK: "wall", "cpu", "cpu*FACTOR", "scripted*MILLISECONDS", ...
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_options_set_clock(tether_options* options, const char* clock) TETHER_NOEXCEPT;
/// Sets the limits of tether_connect(), in nanoseconds of wall time; each must be above 0.
/// @param options  the options
/// @param connect_ns  for the connection (10 s if not set)
/// @param welcome_ns  then for the coordinator's Welcome (60 s if not set), which can load a world
///   or wait for other SUTs before
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_options_set_timeouts(tether_options* options, int64_t connect_ns,
                                          int64_t welcome_ns) TETHER_NOEXCEPT;

/// Connects to the coordinator. Blocks until its Welcome, with which ET starts.
/// @param options  NULL: those of the environment. They stay the caller's and can be used again.
/// @param[out] out  the vehicle; free it with tether_disconnect()
/// @return TETHER_OK; TETHER_INVALID if the options cannot be used, or have no address or token;
///   TETHER_DISCONNECTED or TETHER_TIMEOUT if no coordinator is there or answers; TETHER_REFUSED
///   with the coordinator's message; TETHER_PROTOCOL
tether_status tether_connect(const tether_options* options, tether_vehicle** out) TETHER_NOEXCEPT;
/// Closes the connection and frees the vehicle with its sensors and anchors. Images that were read
/// stay valid. The run fails if tether_finish() was not called. @param vehicle  the UAV, or NULL
void tether_disconnect(tether_vehicle* vehicle) TETHER_NOEXCEPT;

/// Whether the SUT runs under tether-exec, which measures all its threads and processes together.
/// @param vehicle  the UAV
/// @return 1 if it does; 0 if not, or if `vehicle` is NULL. Never blocks.
int32_t tether_is_concurrent(const tether_vehicle* vehicle) TETHER_NOEXCEPT;

/// @}
/// @defgroup c_catalogue Sensors and anchors
/// What the SUT knows beforehand. These functions never block. Anchors are objects of the world
/// that the SUT knows by name, shape, size and colour; it has to find out where they are.
/// @{

/// A sensor of the UAV. Owned by the vehicle, never changes.
typedef struct tether_sensor tether_sensor;
/// An anchor of the UAV's world. Owned by the vehicle, never changes.
typedef struct tether_anchor tether_anchor;

/// Kind of a sensor: TETHER_CAMERA, TETHER_IMU, ...; a later library may have more.
typedef int32_t tether_sensor_kind;
/// Values of tether_sensor_kind.
enum {
  TETHER_CAMERA = 0,  ///< colour camera
  TETHER_IMU = 1,     ///< inertial measurement unit
  TETHER_RANGE = 2,   ///< rangefinder
  // Read by tether_read_camera().
  TETHER_DEPTH_CAMERA = 3,         ///< camera that measures a depth in each pixel
  TETHER_RGBD_CAMERA = 4,          ///< camera that measures colour and depth in each pixel
  TETHER_SEGMENTATION_CAMERA = 5,  ///< camera that finds which model each pixel shows
  TETHER_NAVSAT = 6,               ///< receiver of satellite navigation
  TETHER_MAGNETOMETER = 7,         ///< magnetometer
  TETHER_BAROMETER = 8,            ///< barometer
  TETHER_ODOMETRY = 9,             ///< estimate of pose and velocity
  TETHER_SCAN = 10,                ///< lidar
  TETHER_JOINT_STATE = 11          ///< angles of the UAV's joints
};

/// Shape of an anchor: TETHER_BOX, TETHER_CYLINDER, TETHER_SPHERE.
typedef int32_t tether_anchor_shape;
/// Values of tether_anchor_shape.
enum {
  TETHER_BOX = 0,       ///< box
  TETHER_CYLINDER = 1,  ///< cylinder along its own z
  TETHER_SPHERE = 2     ///< sphere
};

/// A pinhole camera with Brown-Conrady distortion, as in SDF and OpenCV. Without distortion, a
/// point (x, y, z) of C appears at u = fx * x/z + cx, v = fy * y/z + cy; (0, 0) is the centre of
/// the top left pixel. May grow.
typedef struct tether_camera_model {
  int32_t width_px;   ///< width of an image [px]
  int32_t height_px;  ///< height of an image [px]
  double fx_px;       ///< focal length along u [px]
  double fy_px;       ///< focal length along v [px]
  double cx_px;       ///< principal point, u [px]
  double cy_px;       ///< principal point, v [px]
  double k1;          ///< radial distortion, 2nd order; if all five are 0, there is none
  double k2;          ///< radial distortion, 4th order
  double p1;          ///< tangential distortion, first coefficient
  double p2;          ///< tangential distortion, second coefficient
  double k3;          ///< radial distortion, 6th order
} tether_camera_model;

/// Name of the UAV.
/// @param vehicle  the UAV  @return the name, owned by the vehicle; "" only if `vehicle` is NULL
const char* tether_uav_name(const tether_vehicle* vehicle) TETHER_NOEXCEPT;

/// Number of the UAV's sensors.
/// @param vehicle  the UAV  @return the number; 0 if `vehicle` is NULL
size_t tether_sensor_count(const tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// A sensor by its index.
/// @param vehicle  the UAV  @param index  from 0
/// @return the sensor; NULL if `index` is not below tether_sensor_count()
const tether_sensor* tether_sensor_at(const tether_vehicle* vehicle, size_t index) TETHER_NOEXCEPT;
/// A sensor by its name.
/// @param vehicle  the UAV  @param name  as in the scenario
/// @return the sensor; NULL if the UAV has no such sensor
const tether_sensor* tether_find_sensor(const tether_vehicle* vehicle,
                                        const char* name) TETHER_NOEXCEPT;
/// Name of a sensor, unique within the UAV.
/// @param sensor  the sensor  @return the name, owned by the vehicle; "" only if `sensor` is NULL
const char* tether_sensor_name(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// Kind of a sensor.
/// @param sensor  the sensor  @return its kind; -1 if `sensor` is NULL
tether_sensor_kind tether_sensor_get_kind(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// Rate of a periodic sensor.
/// @param sensor  the sensor
/// @return the rate [Hz]; 0 if the sensor measures on demand, or if `sensor` is NULL
double tether_sensor_rate_hz(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// Where a sensor is mounted. A camera's S looks along its x; its optical frame C is S turned.
/// @param sensor  the sensor  @param[out] out  X_BS
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_sensor_mounting(const tether_sensor* sensor, tether_pose* out) TETHER_NOEXCEPT;
/// How many of the UAV's joints turn a sensor: the first ones, see tether_get_joint(). Its mounting
/// is that of joints at 0.
/// @param sensor  the sensor  @return the number; 0 if it does not turn, or if `sensor` is NULL
size_t tether_sensor_joints(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// Optics of a camera of any kind.
/// @param sensor  the sensor  @param[out] out  its model  @param size  sizeof *out
/// @return TETHER_OK, or TETHER_INVALID if the sensor is not a camera
tether_status tether_sensor_camera_model(const tether_sensor* sensor, tether_camera_model* out,
                                         size_t size) TETHER_NOEXCEPT;
/// The distances that a rangefinder, or the depths that a depth or RGBD camera, can measure.
/// @param sensor  the sensor  @param[out] min_m,max_m  least and largest [m]
/// @return TETHER_OK, or TETHER_INVALID if the sensor measures no distances
tether_status tether_sensor_range_limits(const tether_sensor* sensor, double* min_m,
                                         double* max_m) TETHER_NOEXCEPT;
/// The model that a label of a segmentation camera's images means.
/// @param sensor  the sensor  @param label  from 1; 0 means no model
/// @return the model's name, owned by the vehicle; NULL if the sensor has no such label
const char* tether_sensor_label_model(const tether_sensor* sensor, uint16_t label) TETHER_NOEXCEPT;

/// Number of anchors.
/// @param vehicle  the UAV  @return the number; 0 if `vehicle` is NULL
size_t tether_anchor_count(const tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// An anchor by its index.
/// @param vehicle  the UAV  @param index  from 0
/// @return the anchor; NULL if `index` is not below tether_anchor_count()
const tether_anchor* tether_anchor_at(const tether_vehicle* vehicle, size_t index) TETHER_NOEXCEPT;
/// An anchor by its name.
/// @param vehicle  the UAV  @param name  as in the scenario
/// @return the anchor; NULL if there is no such anchor
const tether_anchor* tether_find_anchor(const tether_vehicle* vehicle,
                                        const char* name) TETHER_NOEXCEPT;
/// Name of an anchor.
/// @param anchor  the anchor  @return the name, owned by the vehicle; "" only if `anchor` is NULL
const char* tether_anchor_name(const tether_anchor* anchor) TETHER_NOEXCEPT;
/// Shape of an anchor.
/// @param anchor  the anchor  @return its shape; -1 if `anchor` is NULL
tether_anchor_shape tether_anchor_get_shape(const tether_anchor* anchor) TETHER_NOEXCEPT;
/// Size of an anchor.
/// @param anchor  the anchor
/// @param[out] out_m  [m] of a box the edge lengths along its own axes; of a cylinder diameter,
///   diameter, length; of a sphere the diameter three times
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_anchor_size(const tether_anchor* anchor, tether_vec3* out_m) TETHER_NOEXCEPT;
/// Colour of an anchor. Light and shade change what a camera sees.
/// @param anchor  the anchor  @param[out] out  red, green, blue as x, y, z, each 0 to 1, sRGB
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_anchor_color(const tether_anchor* anchor, tether_vec3* out) TETHER_NOEXCEPT;

/// @}
/// @defgroup c_reading Reading sensors
/// A read is an @ref interaction that returns at the ET at which the measurement is available. If
/// the UAV has no sensor of that name and kind, it fails with TETHER_INVALID, and the message lists
/// the sensors that it has.
/// @{

/// Which measurement to read.
typedef int32_t tether_read_mode;
/// Values of tether_read_mode.
enum {
  /// The newest measurement that this SUT has not read; waits for the next if there is none. A
  /// sensor that measures on demand measures now.
  TETHER_READ_NEXT = 0,
  /// The newest measurement, also if it was read before.
  TETHER_READ_LATEST = 1,
  /// The newest measurement that was not read, at once; TETHER_NOTHING_YET if there is none.
  /// TETHER_INVALID for a sensor that measures on demand.
  TETHER_READ_IF_AVAILABLE = 2
};

/// Lets measurements of a periodic sensor wait, as a driver's queue does. A read then gets the
/// oldest that was not read (TETHER_READ_LATEST: still the newest); if more wait, the oldest are
/// lost, which the samples' `index` shows. To get all that have arrived, read with
/// TETHER_READ_IF_AVAILABLE until TETHER_NOTHING_YET. The queue fills from the next read on. No
/// interaction. In free running, only the newest waits; the
/// result says how many had no place.
/// @param vehicle  the UAV  @param sensor  its name
/// @param depth  how many wait; 1 to 4096; 1, as at first: only the newest
/// @return TETHER_OK; TETHER_INVALID for another depth, if there is no such sensor, or if it
///   measures on demand
tether_status tether_set_queue(tether_vehicle* vehicle, const char* sensor,
                               uint32_t depth) TETHER_NOEXCEPT;

/// Describes an image. May grow.
typedef struct tether_image_info {
  int64_t sampled_at_ns;  ///< ST of the exposure [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  int32_t width_px;       ///< width [px]
  int32_t height_px;      ///< height [px]
  uint64_t size_bytes;    ///< of the colours: height x width x 3, or 0 if the image has none
} tether_image_info;

/// An image in memory of the library. It belongs to no vehicle, may outlive it, and never changes.
typedef struct tether_image tether_image;

/// Reads a camera of any kind into memory of the library, without copying pixels.
/// @param vehicle  the UAV  @param sensor  name of the camera  @param mode  which image
/// @param[out] out  the image; free it with tether_image_free()
/// @return TETHER_OK, TETHER_NOTHING_YET or an @ref interaction error
tether_status tether_read_camera(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                                 tether_image** out) TETHER_NOEXCEPT;
/// Copies an image with its pixels, for instance to keep one that a subscription shows.
/// @param image  the image  @param[out] out  the copy; free it with tether_image_free()
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_image_copy(const tether_image* image, tether_image** out) TETHER_NOEXCEPT;
/// Frees an image. @param image  the image, or NULL
void tether_image_free(tether_image* image) TETHER_NOEXCEPT;
/// Size, time and number of an image.
/// @param image  the image  @param[out] out  the description  @param size  sizeof *out
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_image_get_info(const tether_image* image, tether_image_info* out,
                                    size_t size) TETHER_NOEXCEPT;
/// Pixels of an image. @param image  the image
/// @return height x width x 3 sRGB bytes R, G, B, row by row from the top left without gaps; valid
///   until tether_image_free(). NULL if `image` is, or if the camera measures no colours.
const uint8_t* tether_image_rgb(const tether_image* image) TETHER_NOEXCEPT;
/// Depths of an image. @param image  the image
/// @return height x width numbers, laid out as the pixels of tether_image_rgb(): depth along the
///   optical axis [m] (REP-118); +inf: nothing in reach; -inf: too close; NaN: the lens maps no
///   direction to the pixel. NULL if `image` is, or if the camera measures no depths.
const float* tether_image_depth_m(const tether_image* image) TETHER_NOEXCEPT;
/// Labels of an image. @param image  the image
/// @return height x width numbers, laid out as the pixels of tether_image_rgb(): which model the
///   pixel shows, see tether_sensor_label_model(); 0: none. NULL if `image` is, or if the camera is
///   not a segmentation camera.
const uint16_t* tether_image_labels(const tether_image* image) TETHER_NOEXCEPT;

/// Reads an image of each of several cameras, all of one instant: a stereo pair, or colour and
/// depth. The cameras need one rate and phase, and a queue of a few images (tether_set_queue()).
/// Stamps are equal, or of cameras whose driver stamps, within half of the shortest period.
/// @param vehicle  the UAV  @param cameras  names  @param count  how many; at least 1
/// @param[out] out  `count` images; free each with tether_image_free()
/// @return TETHER_OK or an @ref interaction error; TETHER_INVALID if a camera is named
///   twice, or if there is no common instant
tether_status tether_read_together(tether_vehicle* vehicle, const char* const* cameras,
                                   size_t count, tether_image** out) TETHER_NOEXCEPT;

/// Reads the colours of a camera into the caller's memory, with one copy.
/// @param vehicle  the UAV  @param sensor  name of the camera  @param mode  which image
/// @param[out] rgb  the pixels, laid out as in tether_image_rgb(); unchanged by a failed call
/// @param capacity  bytes that `rgb` has; the camera's model has the size of an image
/// @param[out] info  the description, or NULL  @param info_size  sizeof *info
/// @return TETHER_OK, TETHER_NOTHING_YET or an @ref interaction error; TETHER_INVALID, before
///   anything is read, if the image does not fit or the camera measures no colours
tether_status tether_read_camera_into(tether_vehicle* vehicle, const char* sensor,
                                      tether_read_mode mode, uint8_t* rgb, size_t capacity,
                                      tether_image_info* info, size_t info_size) TETHER_NOEXCEPT;

/// One measurement of an inertial measurement unit. May grow.
typedef struct tether_imu_sample {
  int64_t sampled_at_ns;               ///< ST [ns]
  uint64_t index;                      ///< number of the measurement of this sensor
  tether_vec3 angular_velocity_rad_s;  ///< w_WS in S
  tether_vec3 specific_force_m_s2;     ///< a - g in S: +9.81 along "up" at rest
  tether_quat q_WS;                    ///< attitude from the IMU's own filter; NaN if it has none
} tether_imu_sample;

/// Reads an IMU.
/// @param vehicle  the UAV  @param sensor  its name  @param mode  which measurement
/// @param[out] out  the measurement  @param size  sizeof *out
/// @return TETHER_OK, TETHER_NOTHING_YET or an @ref interaction error
tether_status tether_read_imu(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                              tether_imu_sample* out, size_t size) TETHER_NOEXCEPT;

/// One measurement of a rangefinder. May grow.
typedef struct tether_range_sample {
  int64_t sampled_at_ns;  ///< ST [ns]
  uint64_t index;         ///< number of the measurement of this sensor
  double range_m;         ///< along S's x [m]; +inf: nothing in reach; -inf: too close (REP-117)
} tether_range_sample;

/// Reads a rangefinder. @copydetails tether_read_imu
tether_status tether_read_range(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                                tether_range_sample* out, size_t size) TETHER_NOEXCEPT;

/// @}
/// @defgroup c_flying Flying, waiting, reporting
/// @{

/// Flies with this velocity until the next command. An @ref interaction.
/// @param vehicle  the UAV  @param ahead_m_s,left_m_s,up_m_s  velocity in H [m/s]
/// @param yaw_rate_rad_s  counter-clockwise seen from above [rad/s]
/// @return TETHER_OK or an @ref interaction error; TETHER_INVALID if a value is not finite or > 100
tether_status tether_command_velocity(tether_vehicle* vehicle, double ahead_m_s, double left_m_s,
                                      double up_m_s, double yaw_rate_rad_s) TETHER_NOEXCEPT;

/// Reads the SUT's clock. Between two calls it grows by what the SUT computed. Never blocks.
/// @param vehicle  the UAV  @return ET [ns]; 0 if `vehicle` is NULL
int64_t tether_now(const tether_vehicle* vehicle) TETHER_NOEXCEPT;

/// Waits in simulation: ET and ST advance by the duration. An @ref interaction. Use it instead of
/// the operating system's sleeps, which count as computing, or with a CPU clock not at all.
/// @param vehicle  the UAV  @param duration_ns  [ns]; not above 0: returns at once
/// @return TETHER_OK or an @ref interaction error
tether_status tether_sleep_for(tether_vehicle* vehicle, int64_t duration_ns) TETHER_NOEXCEPT;
/// Waits in simulation as tether_sleep_for() does, until a point in time.
/// @param vehicle  the UAV  @param et_ns  ET [ns]; if it has passed, returns at once
/// @return TETHER_OK or an @ref interaction error
tether_status tether_sleep_until(tether_vehicle* vehicle, int64_t et_ns) TETHER_NOEXCEPT;

/// Writes a message into the run's record, without waiting for the coordinator. Takes ET only under
/// tether-exec.
/// @param vehicle  the UAV
/// @param topic  name; metrics read "roi", "estimate" and "displacement" (docs/guide/tasks.md)
/// @param json  one JSON object
/// @return TETHER_OK or an @ref interaction error; TETHER_INVALID if `json` is no JSON object
tether_status tether_annotate(tether_vehicle* vehicle, const char* topic,
                              const char* json) TETHER_NOEXCEPT;

/// Begins a stage: the record has what is computed until tether_stage_end(). Of nested stages the
/// innermost one counts; under tether-exec each thread has its own. Takes no ET, never blocks.
/// @param vehicle  the UAV  @param stage  its name, 1 to 256 bytes without control characters
/// @return TETHER_OK or an @ref interaction error; TETHER_INVALID for a bad name or too many stages
tether_status tether_stage_begin(tether_vehicle* vehicle, const char* stage) TETHER_NOEXCEPT;
/// Ends the stage begun last. @param vehicle  the UAV  @return as above, or TETHER_INVALID if none
tether_status tether_stage_end(tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// Ends the mission. Every later @ref interaction fails. A run whose SUT does not call this fails,
/// because the SUT counts as lost.
/// @param vehicle  the UAV  @param reached_goal  0 for no, else yes
/// @param outcome  one line for a person
/// @param details_json  a JSON object with the program's own results, or ""
/// @return TETHER_OK or an @ref interaction error
tether_status tether_finish(tether_vehicle* vehicle, int32_t reached_goal, const char* outcome,
                            const char* details_json) TETHER_NOEXCEPT;

/// @}
#ifdef __cplusplus
}
#endif
/// @}
#include <tether/client_battery.h>
#include <tether/client_commands.h>
#include <tether/client_navigation.h>
#include <tether/client_radio.h>
#include <tether/client_subscribing.h>
