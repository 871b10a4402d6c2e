#pragma once

#include <stddef.h>
#include <stdint.h>

/// The client library of Tether in C: what a UAV's own program, the software under test (SUT),
/// links to. In C++, <tether/client.hpp> is more convenient. C99; the guide is
/// docs/guide/your-own-sut.md, the rules of time are in docs/design.md, section 2.
///
/// Time is int64_t nanoseconds. ET is the SUT's execution time: it runs while the SUT computes and
/// stands still while a call is held. ST is simulated time; a measurement's instant is ST. Under
/// the barrier, a call that returns at ET t has met the world of ST t. Lengths are metres, angles
/// radians, yaw counter-clockwise seen from above.
///
/// Frames: W world (east, north, up), B body (ahead, left, up), H heading (W turned by the UAV's
/// yaw), S a sensor (ahead, left, up; so also a camera's mounting), C a camera's optical frame
/// (right, down, ahead). `q_WS` turns a vector's coordinates from S to W; X_BS is S's pose in B.
///
/// Errors: functions that can fail return a status, and tether_last_error() says more. What a
/// failed call would have put out is then NULL or zero. No pointer may be NULL where nothing else
/// is said; one that is gives TETHER_INVALID. Text is UTF-8 and ends with a zero byte. The library
/// never ends the program, prints nothing, and handles no signal.
///
/// Threads: every function may be called from any thread, and several at once, of one vehicle
/// too, except that nothing may still use what a function frees. Where time is measured per
/// process (tether_is_concurrent() is 0), calls of one vehicle that talk to the coordinator wait
/// for each other; under tether-exec each thread waits for its own reply only. A vehicle is of the
/// process that connected: after fork() the child connects for itself.
///
/// Stability: within TETHER_CLIENT_ABI_VERSION functions and constants are only added. A struct
/// that may grow at its end is handed over with its size (`sizeof *out`), the library fills what
/// the caller knows of it, and fills up with zeros where the caller knows more.
#ifdef __cplusplus
#define TETHER_NOEXCEPT noexcept
extern "C" {
#else
#define TETHER_NOEXCEPT
#endif

// ---- Versions and statuses ----------------------------------------------------------------------

/// Goes up when something that was there changes or goes; it is the number behind ".so." in the
/// library's name.
#define TETHER_CLIENT_ABI_VERSION 1

/// TETHER_CLIENT_ABI_VERSION of the library that is loaded.
int32_t tether_client_abi_version(void) TETHER_NOEXCEPT;
/// Version of the library that is loaded, "0.1.0" or "0.1.0+COMMIT". Never NULL; lives for ever.
const char* tether_client_version(void) TETHER_NOEXCEPT;

typedef int32_t tether_status;
enum {
  TETHER_OK = 0,
  TETHER_INVALID = 1,       ///< an argument cannot be used; the next call may succeed
  TETHER_NOTHING_YET = 2,   ///< a read that was not to wait found nothing; not an error
  TETHER_REFUSED = 3,       ///< the coordinator said no: wrong name, token or version
  TETHER_DISCONNECTED = 4,  ///< the connection ended, or there is no coordinator there
  TETHER_PROTOCOL = 5,      ///< the coordinator sent what the protocol does not allow
  TETHER_TIMEOUT = 6,       ///< no answer within the limit
  TETHER_RUN_ENDED = 7,     ///< the coordinator ended the run, or another thread finished it
  TETHER_NO_MEMORY = 8,     ///< memory ran out
  TETHER_INTERNAL = 9       ///< a fault of the library
};

/// "ok", "invalid", ...; "unknown" for a number that is no status. Never NULL; lives for ever.
const char* tether_status_name(tether_status status) TETHER_NOEXCEPT;

/// What the calling thread's last failed call said: one line for a person, at most 511 bytes
/// (cut where it would be longer); "" if none has failed. Never NULL; its text changes with the
/// thread's next failed call.
const char* tether_last_error(void) TETHER_NOEXCEPT;

// ---- Small values; none of them ever grows ------------------------------------------------------

typedef struct tether_vec3 {
  double x, y, z;
} tether_vec3;

/// Unit quaternion, Hamilton convention.
typedef struct tether_quat {
  double w, x, y, z;
} tether_quat;

/// X_PF of a frame F in its parent P.
typedef struct tether_pose {
  tether_vec3 position_m;  ///< of F's origin, in P
  tether_quat attitude;    ///< q_PF
} tether_pose;

// ---- Connecting ---------------------------------------------------------------------------------

/// The UAV as its own program sees it.
typedef struct tether_vehicle tether_vehicle;
/// How to reach the coordinator.
typedef struct tether_options tether_options;

/// Options without address and token: the only UAV, the wall clock, this program's file name.
tether_status tether_options_new(tether_options** out) TETHER_NOEXCEPT;
/// What `tether run` and tether-exec tell the SUT that they start: TETHER_ADDRESS, TETHER_TOKEN,
/// TETHER_UAV, TETHER_CLOCK, TETHER_EXEC (the manual page tether-client(3) describes them). What is
/// set besides goes over it. Fails with TETHER_INVALID, naming the variable. The environment is
/// read here and by tether_connect(): no other thread may change it meanwhile.
tether_status tether_options_from_environment(tether_options** out) TETHER_NOEXCEPT;
/// NULL is allowed.
void tether_options_free(tether_options* options) TETHER_NOEXCEPT;

/// "HOST:PORT" or "[IPV6]:PORT" of the coordinator; not looked up before tether_connect().
tether_status tether_options_set_address(tether_options* options,
                                         const char* address) TETHER_NOEXCEPT;
/// The word that lets this program into the run.
tether_status tether_options_set_token(tether_options* options, const char* token) TETHER_NOEXCEPT;
/// Which UAV of the scenario to fly; "": the only one.
tether_status tether_options_set_uav(tether_options* options, const char* uav) TETHER_NOEXCEPT;
/// The program's name and version, for the record.
tether_status tether_options_set_sut_name(tether_options* options,
                                          const char* name) TETHER_NOEXCEPT;
/// What ET is measured by, written as in TETHER_CLOCK: "wall", "cpu", "cpu*FACTOR",
/// "scripted*MILLISECONDS", ... The coordinator refuses a clock that the scenario does not ask for.
tether_status tether_options_set_clock(tether_options* options, const char* clock) TETHER_NOEXCEPT;
/// How long to try to connect (10 s if not set), and then to wait for the coordinator's Welcome
/// (60 s: it may load a world, or wait for other SUTs) [ns of wall time]; both above 0.
tether_status tether_options_set_timeouts(tether_options* options, int64_t connect_ns,
                                          int64_t welcome_ns) TETHER_NOEXCEPT;

/// Connects and shakes hands; ET starts with the coordinator's Welcome. `options` may be NULL:
/// those of the environment; they stay the caller's, and may be used again. Blocks.
///
/// Fails with TETHER_INVALID (options that cannot be used, or that lack address or token),
/// TETHER_DISCONNECTED or TETHER_TIMEOUT (no coordinator there, or no answer), TETHER_REFUSED (the
/// text has the coordinator's own words).
tether_status tether_connect(const tether_options* options, tether_vehicle** out) TETHER_NOEXCEPT;
/// Closes the connection and frees the vehicle with all that it owns: sensors, anchors. A run that
/// was not finished fails for that. Images that were read stay. NULL is allowed.
void tether_disconnect(tether_vehicle* vehicle) TETHER_NOEXCEPT;

/// 1 where the SUT runs under tether-exec, which times all of its threads and processes together;
/// 0 where it has one time line.
int32_t tether_is_concurrent(const tether_vehicle* vehicle) TETHER_NOEXCEPT;

// ---- What the SUT knows beforehand --------------------------------------------------------------

/// A sensor or an anchor of the vehicle's catalogue: owned by the vehicle, never changes.
typedef struct tether_sensor tether_sensor;
typedef struct tether_anchor tether_anchor;

typedef int32_t tether_sensor_kind;
enum { TETHER_CAMERA = 0, TETHER_IMU = 1, TETHER_RANGE = 2 };

typedef int32_t tether_anchor_shape;
enum { TETHER_BOX = 0, TETHER_CYLINDER = 1, TETHER_SPHERE = 2 };

/// A pinhole camera with Brown-Conrady distortion, as in SDF and OpenCV. A point (x, y, z) of C
/// appears at u = fx * x/z + cx, v = fy * y/z + cy where nothing is distorted; (0, 0) is the centre
/// of the top left pixel. May grow.
typedef struct tether_camera_model {
  int32_t width_px;
  int32_t height_px;
  double fx_px, fy_px;
  double cx_px, cy_px;    ///< principal point
  double k1, k2, p1, p2;  ///< radial and tangential, in OpenCV's order;
  double k3;              ///< all 0: no distortion
} tether_camera_model;

/// The name of the UAV. Owned by the vehicle; "" only if `vehicle` is NULL.
const char* tether_uav_name(const tether_vehicle* vehicle) TETHER_NOEXCEPT;

size_t tether_sensor_count(const tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// NULL if `index` is not below the count.
const tether_sensor* tether_sensor_at(const tether_vehicle* vehicle, size_t index) TETHER_NOEXCEPT;
/// NULL if the UAV has no sensor of that name.
const tether_sensor* tether_find_sensor(const tether_vehicle* vehicle,
                                        const char* name) TETHER_NOEXCEPT;
/// Unique within the UAV.
const char* tether_sensor_name(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// TETHER_CAMERA, TETHER_IMU or TETHER_RANGE; a later library may know more kinds.
tether_sensor_kind tether_sensor_get_kind(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// Of a sensor that measures periodically [Hz]; 0: it measures when it is asked.
double tether_sensor_rate_hz(const tether_sensor* sensor) TETHER_NOEXCEPT;
/// X_BS: where it is mounted. Of a camera, S looks along x; its optical frame C is S turned.
tether_status tether_sensor_mounting(const tether_sensor* sensor, tether_pose* out) TETHER_NOEXCEPT;
/// TETHER_INVALID if it is no camera. `size` is sizeof *out.
tether_status tether_sensor_camera_model(const tether_sensor* sensor, tether_camera_model* out,
                                         size_t size) TETHER_NOEXCEPT;
/// What a rangefinder can tell apart [m]. TETHER_INVALID if it is none.
tether_status tether_sensor_range_limits(const tether_sensor* sensor, double* min_m,
                                         double* max_m) TETHER_NOEXCEPT;

/// Anchors: things of the world that the SUT may know by name, shape, size and colour. Where they
/// are is for the SUT to find out.
size_t tether_anchor_count(const tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// NULL if `index` is not below the count.
const tether_anchor* tether_anchor_at(const tether_vehicle* vehicle, size_t index) TETHER_NOEXCEPT;
/// NULL if there is no anchor of that name.
const tether_anchor* tether_find_anchor(const tether_vehicle* vehicle,
                                        const char* name) TETHER_NOEXCEPT;
const char* tether_anchor_name(const tether_anchor* anchor) TETHER_NOEXCEPT;
tether_anchor_shape tether_anchor_get_shape(const tether_anchor* anchor) TETHER_NOEXCEPT;
/// Box: edge lengths along its own axes; cylinder: diameter, diameter, length; sphere: diameter
/// three times [m].
tether_status tether_anchor_size(const tether_anchor* anchor, tether_vec3* out_m) TETHER_NOEXCEPT;
/// Red, green and blue as x, y and z, each 0 to 1, sRGB. Light and shade change what a camera sees.
tether_status tether_anchor_color(const tether_anchor* anchor, tether_vec3* out) TETHER_NOEXCEPT;

// ---- Reading sensors ----------------------------------------------------------------------------
//
// Reads are interactions: they may block, ET stands still meanwhile, and goes on from the moment
// at which the measurement is available. Besides the statuses named below they fail with
// TETHER_INVALID if the UAV has no sensor of that name and kind (the text lists those it has), and
// with TETHER_REFUSED, TETHER_DISCONNECTED, TETHER_PROTOCOL or TETHER_RUN_ENDED, after which every
// later call of the vehicle fails with the same.

typedef int32_t tether_read_mode;
enum {
  /// The newest measurement that this SUT has not read; waits for the next if there is none. A
  /// sensor that measures on demand measures now.
  TETHER_READ_NEXT = 0,
  /// The newest measurement, again if need be.
  TETHER_READ_LATEST = 1,
  /// The newest measurement that was not read, at once; TETHER_NOTHING_YET if there is none.
  /// TETHER_INVALID of a sensor that measures on demand.
  TETHER_READ_IF_AVAILABLE = 2
};

/// What is known of an image besides its pixels. May grow.
typedef struct tether_image_info {
  int64_t sampled_at_ns;  ///< ST at which the light was seen
  uint64_t index;         ///< which measurement of this sensor
  int32_t width_px;
  int32_t height_px;
  uint64_t size_bytes;  ///< height x width x 3
} tether_image_info;

/// An image that the library keeps: of no vehicle, may outlive it, never changes.
typedef struct tether_image tether_image;

/// Reads a camera into memory of the library, without copying pixels. Free *out with
/// tether_image_free().
tether_status tether_read_camera(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                                 tether_image** out) TETHER_NOEXCEPT;
/// The same image once more, pixels copied: to keep one that a subscription shows. Free *out with
/// tether_image_free().
tether_status tether_image_copy(const tether_image* image, tether_image** out) TETHER_NOEXCEPT;
/// NULL is allowed.
void tether_image_free(tether_image* image) TETHER_NOEXCEPT;
/// `size` is sizeof *out.
tether_status tether_image_get_info(const tether_image* image, tether_image_info* out,
                                    size_t size) TETHER_NOEXCEPT;
/// height x width x 3 sRGB bytes R, G, B, row by row from the top left without gaps; valid until
/// tether_image_free(). NULL only if `image` is.
const uint8_t* tether_image_rgb(const tether_image* image) TETHER_NOEXCEPT;

/// Reads a camera into the caller's `rgb` of `capacity` bytes, laid out as above; copies the pixels
/// once. `info` may be NULL, `info_size` is sizeof *info. TETHER_INVALID, before anything is read,
/// if the image does not fit: its size is that of the camera's model.
tether_status tether_read_camera_into(tether_vehicle* vehicle, const char* sensor,
                                      tether_read_mode mode, uint8_t* rgb, size_t capacity,
                                      tether_image_info* info, size_t info_size) TETHER_NOEXCEPT;

/// One measurement of an inertial measurement unit. May grow.
typedef struct tether_imu_sample {
  int64_t sampled_at_ns;               ///< ST
  uint64_t index;                      ///< which measurement of this sensor
  tether_vec3 angular_velocity_rad_s;  ///< w_WS in S
  tether_vec3 specific_force_m_s2;     ///< a - g in S: +9.81 along "up" when at rest
  tether_quat q_WS;  ///< attitude as the IMU's own filter tells it; NaN: it has none
} tether_imu_sample;

/// `size` is sizeof *out.
tether_status tether_read_imu(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                              tether_imu_sample* out, size_t size) TETHER_NOEXCEPT;

/// One measurement of a rangefinder. May grow.
typedef struct tether_range_sample {
  int64_t sampled_at_ns;  ///< ST
  uint64_t index;         ///< which measurement of this sensor
  double range_m;         ///< along S's x; +inf: nothing in reach; -inf: too close (REP-117)
} tether_range_sample;

/// `size` is sizeof *out.
tether_status tether_read_range(tether_vehicle* vehicle, const char* sensor, tether_read_mode mode,
                                tether_range_sample* out, size_t size) TETHER_NOEXCEPT;

// ---- Data that comes by itself ------------------------------------------------------------------
//
// A thread of the library's reads a periodic sensor again and again, as TETHER_READ_NEXT does, and
// calls `on_...` with each measurement at the ET at which it is available; `user` is handed
// through. The callback runs in that thread with every signal blocked, may call the vehicle, and
// may not throw; what it is given is valid until it returns. A measurement that comes meanwhile is
// delivered after it; of several only the newest. What other threads read of the same sensor does
// not come here.
//
// Only under tether-exec: TETHER_INVALID where tether_is_concurrent() is 0, where the UAV has no
// such sensor, or where it measures on demand.

typedef struct tether_subscription tether_subscription;
typedef void (*tether_on_image)(const tether_image* image, void* user);
typedef void (*tether_on_imu)(const tether_imu_sample* sample, void* user);
typedef void (*tether_on_range)(const tether_range_sample* sample, void* user);

tether_status tether_subscribe_camera(tether_vehicle* vehicle, const char* sensor,
                                      tether_on_image on_image, void* user,
                                      tether_subscription** out) TETHER_NOEXCEPT;
tether_status tether_subscribe_imu(tether_vehicle* vehicle, const char* sensor,
                                   tether_on_imu on_sample, void* user,
                                   tether_subscription** out) TETHER_NOEXCEPT;
tether_status tether_subscribe_range(tether_vehicle* vehicle, const char* sensor,
                                     tether_on_range on_sample, void* user,
                                     tether_subscription** out) TETHER_NOEXCEPT;
/// TETHER_OK as long as measurements come; else why none will any more, e.g. TETHER_RUN_ENDED.
tether_status tether_subscription_status(const tether_subscription* subscription) TETHER_NOEXCEPT;
/// Ends it: after the return no callback runs, except one that calls this itself. To be called
/// before tether_disconnect(). NULL is allowed.
void tether_unsubscribe(tether_subscription* subscription) TETHER_NOEXCEPT;

// ---- Flying, waiting, telling -------------------------------------------------------------------

/// Flies with this velocity until told otherwise: metres per second in the heading frame H,
/// whatever roll and pitch are, and radians per second of yaw. An interaction; fails as reads do,
/// with TETHER_INVALID for what no multirotor does (not finite, above 100).
tether_status tether_command_velocity(tether_vehicle* vehicle, double ahead_m_s, double left_m_s,
                                      double up_m_s, double yaw_rate_rad_s) TETHER_NOEXCEPT;

/// ET now [ns]; between two calls it grows by what the SUT computed. 0 if `vehicle` is NULL. Never
/// blocks.
int64_t tether_now(const tether_vehicle* vehicle) TETHER_NOEXCEPT;

/// Waits in simulation: ET and ST move by this much, wall time by what the simulator needs.
/// Interactions that fail as reads do. What lies in the past returns at once (and is an
/// interaction still). Sleeps of the operating system instead would be charged as computing.
tether_status tether_sleep_for(tether_vehicle* vehicle, int64_t duration_ns) TETHER_NOEXCEPT;
tether_status tether_sleep_until(tether_vehicle* vehicle, int64_t et_ns) TETHER_NOEXCEPT;

/// Something for the record: `json` is one JSON object. Never waits for the coordinator, and costs
/// no ET but under tether-exec.
/// TETHER_INVALID if it is no JSON object. Topics "roi", "estimate" and "displacement" are read by
/// metrics (docs/guide/tasks.md has their fields).
tether_status tether_annotate(tether_vehicle* vehicle, const char* topic,
                              const char* json) TETHER_NOEXCEPT;

/// The mission is over; 0 for `reached_goal` is "no". `outcome` is one line for a person,
/// `details_json` a JSON object with the program's own results, or "". Every later call fails.
/// Without it a run fails: its SUT was lost.
tether_status tether_finish(tether_vehicle* vehicle, int32_t reached_goal, const char* outcome,
                            const char* details_json) TETHER_NOEXCEPT;

#ifdef __cplusplus
}
#endif
